#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds Vicinity and runs it on the embedded hot cell. What follows goes to `vicinity demo`:
#   scripts/demo.sh -o some-folder
# With --serve first, the live page is built too and served at the end, until Ctrl-C:
#   scripts/demo.sh --serve
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

serve=no
packages=()
if [[ ${1:-} == --serve ]]; then
  serve=yes
  packages=(--viewer)
  shift
fi
folder=vicinity-demo
for ((n = 1; n < $#; ++n)); do
  next=$((n + 1))
  case ${!n} in -o | --output) folder=${!next} ;; esac
done

"$repository/scripts/install_packages.sh" "${packages[@]}"
# The study of operators is not part of it.
cmake -S "$repository" --preset release -DVICINITY_SIMULATION=OFF >/dev/null
cmake --build "$repository/build/release" --target vicinity_cli
vicinity=$repository/build/release/apps/cli/vicinity
"$vicinity" demo "$@"

live=("$vicinity" serve "$folder/hot_cell.vicinity" --scene "$folder/scene.yaml"
      --recording "$folder/arm_felt.csv" --start=-0.8,-0.33,0,2.416,0,-0.515,0)
if [[ $serve == yes ]]; then
  exec "${live[@]}"
fi
cat <<END

  See it live, and drive the arm through it, at http://127.0.0.1:8080/ with
    scripts/demo.sh --serve${*:+ $*}
END

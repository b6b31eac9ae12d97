#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Measures Vicinity beside what one would use instead, on this machine and in one run, and prints a
# table: what was measured, its target, met or missed. Leaves bench.json and CSVs.
#
#   scripts/bench.sh [-o FOLDER] [--only GROUP,GROUP...] [--scale]
#
# Groups: ranks voxels stl lookup nearest rebuild cores scale. --scale builds the plant room and the
# ARIAC cell down to 1 mm, which takes long; without it those rows say so. Real meshes are looked
# for in VICINITY_DATA (default: ../shared/data); where they are absent, our own stand in for them.
# FOLDER is benchmarks/results/<cpu>_<compiler> unless given. docs/performance.md says what each
# number means.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

cpu=$(sed -n 's/^model name[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
family=$(sed -n 's/^cpu family[[:space:]]*: //p' /proc/cpuinfo | head -n 1)
compiler=g++$(g++ -dumpversion 2>/dev/null || true)
folder=$repository/benchmarks/results/$(tr -cs 'A-Za-z0-9\n' '_' <<<"${cpu:-cpu} family ${family:-0}")_$compiler
for ((a = 1; a <= $#; ++a)); do
  if [[ ${!a} == -o ]]; then
    next=$((a + 1))
    folder=$(realpath -m "${!next:?-o needs a folder}")
    set -- "${@:1:a-1}" "${@:a+2}"
    break
  fi
done
data=${VICINITY_DATA:-$repository/../shared/data}
if [[ -d $data ]]; then
  VICINITY_DATA=$(realpath "$data")
  export VICINITY_DATA
fi

"$repository/scripts/install_packages.sh" --peers
cd "$repository"
cmake --preset release -DVICINITY_BENCHMARKS=ON -DVICINITY_PEERS=ON >/dev/null
cmake --build --preset release --target vicinity_peers vicinity_cli >/dev/null

mkdir -p "$folder"
{
  echo "scripts/bench.sh $*"
  echo "on $(date -u +%Y-%m-%d), ${cpu:-unknown processor}, $(nproc) cores, Linux $(uname -r), $compiler -O3"
} >"$folder/command.txt"
exec build/release/benchmarks/peers/vicinity_peers -o "$folder" "$@"

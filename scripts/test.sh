#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds Vicinity and runs all its tests: optimised, then under the address and undefined behaviour
# sanitizers. Tests on real meshes look for them in VICINITY_DATA (default: ../shared/data) and say
# so where they are absent.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
jobs=$(nproc)

"$repository/scripts/install_packages.sh" --bridge --python --readers --viewer
cd "$repository"

for preset in release asan_ubsan; do
  echo "== $preset"
  # Python and DDS themselves are not built for the sanitizers; OpenVDB takes them minutes to compile.
  plain=$([[ $preset == release ]] && echo ON || echo OFF)
  cmake --preset "$preset" -DVICINITY_PYTHON="$plain" -DVICINITY_BRIDGE="$plain" -DVICINITY_OPENVDB="$plain"
  cmake --build --preset "$preset"
  ctest --preset "$preset" -j "$jobs"
done

#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# The one place that says what Vicinity needs from Debian 12, and installs what is missing.
set -euo pipefail

packages=(
  g++ cmake ninja-build pkg-config   # build
  libeigen3-dev                      # vectors and poses
  libtbb-dev                         # parallel stages
  libfmt-dev                         # text
  libassimp-dev                      # OBJ, PLY, glTF, DAE, 3MF, FBX
  libyaml-cpp-dev                    # scene files
  libpugixml-dev                     # robots
  nlohmann-json3-dev libxxhash-dev   # what a field file says of itself, and its checksums
  libcli11-dev                       # command line
  libzstd-dev                        # recordings in MCAP
  libcairo2-dev fonts-dejavu-core    # pictures
  libembree-dev                      # the report's measured peer: nearest surface by a tree
  # vicinity simulate, and drag in MuJoCo: the first is not found without the others
  libmujoco-dev libqhull-dev libgl-dev libopengl-dev
  libopenvdb-dev libboost-iostreams-dev # export to .vdb
  libgtest-dev libgmock-dev          # tests
  liburdfdom-dev liborocos-kdl-dev   # tests: robots and kinematics by another route
)
# What only some need:
#   --benchmarks     the benchmarks
#   --peers          the benchmarks, and what scripts/bench.sh measures us beside (150 MB)
#   --bridge         what VICINITY_BRIDGE needs, and its tests: a second DDS, network namespaces
#   --python         what VICINITY_PYTHON and its tests need, and the tests of Debian packages
#   --readers        programs that our exports are for, which open them in tests: numpy and OpenVDB;
#                    VTK's reader, and that of recordings, come from npm
#   --viewer         npm: it builds the viewer's page; without it vicinity serve has no page
#   --viewer-tests   a browser (700 MB) for the tests that look at the page, and for serve --shot
# Node, npm and a browser that came from elsewhere will do.
for flag in "$@"; do
  case $flag in
    --benchmarks) packages+=(libbenchmark-dev) ;;
    --peers) packages+=(libbenchmark-dev libnanovdb-dev libfcl-dev libcgal-dev liboctomap-dev
                        libdynamicedt3d-dev python3-scipy) ;;
    --bridge) packages+=(cyclonedds-dev libfastrtps-dev libfastcdr-dev openssl iproute2) ;;
    --python) packages+=(pybind11-dev python3-dev python3-numpy python3-pip python3-venv python3-setuptools
                         python3-wheel mypy dpkg-dev file) ;;
    --readers) packages+=(python3-numpy python3-openvdb) ;;
    --viewer) command -v npm >/dev/null || packages+=(nodejs npm) ;;
    --viewer-tests) command -v chromium >/dev/null || packages+=(chromium) ;;
    *) echo "install_packages.sh: there is no $flag; --benchmarks, --peers, --bridge, --python, --readers, --viewer, --viewer-tests" >&2; exit 2 ;;
  esac
done

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)
  [[ $status == 'install ok installed' ]] || missing+=("$package")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "install_packages.sh: these Debian packages are missing and there is no sudo to install them with;" \
         "as root, run: apt-get install ${missing[*]}" >&2
    exit 2
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null

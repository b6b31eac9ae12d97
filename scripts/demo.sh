#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Builds Vicinity and runs it on the embedded hot cell. What follows goes to `vicinity demo`:
#   scripts/demo.sh -o some-folder
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

"$repository/scripts/install_packages.sh"
cmake -S "$repository" --preset release >/dev/null
cmake --build "$repository/build/release" --target vicinity_cli
exec "$repository/build/release/apps/cli/vicinity" demo "$@"

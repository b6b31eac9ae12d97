#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Tries the Debian packages and the wheel of a build on a clean Debian 12: apt installs each with what
# it says it needs and nothing else, it is used, and removed without a trace. As root:
#
#   scripts/try_packages.sh ROOT [BUILD]
#
# ROOT is a folder for that Debian, made by debootstrap where there is none yet (160 MB; some hundred
# more while packages are tried). BUILD is build/release, built with VICINITY_PYTHON on; the bridge is
# tried where VICINITY_BRIDGE was on too.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
root=$(realpath -m "${1:?usage: try_packages.sh ROOT [BUILD]}")
build=$(realpath "${2:-$repository/build/release}")

[[ -x $root/usr/bin/apt-get ]] || debootstrap --variant=minbase bookworm "$root" >/dev/null
try=$root/try
rm -rf "$try"
mkdir -p "$try"
cpack -G DEB --config "$build/CPackConfig.cmake" -B "$try/made" >"$try/cpack.log" 2>&1 || { cat "$try/cpack.log" >&2; exit 1; }
mv "$try"/made/*.deb "$try"
mkdir -p "$try/repository/bindings"  # setuptools writes beside what it builds
cp -r "$repository/bindings/python" "$try/repository/bindings"
cp "$repository/CMakeLists.txt" "$try/repository"
VICINITY_BUILD=$build /usr/bin/python3 -m pip wheel --no-index --no-build-isolation --no-deps -q \
  -w "$try" "$try/repository/bindings/python"
cp -r "$repository/examples" "$repository/tests/package/c_example.c" "$try"
(cd "$try" && du -h --apparent-size -- *.deb *.whl)

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive bash -euc "$*"; }
install() { inside "apt-get install -y -qq --no-install-recommends $* >/dev/null 2>&1" || {
  echo "try_packages.sh: apt cannot install $*" >&2
  inside "apt-get install -y --no-install-recommends $*" >&2
  exit 1
}; }
installed() { inside "dpkg-query --show --showformat='\${Package}\n' | sort"; }
begin() { echo "== $*"; }
end() {  # purges all that came since the system was clean
  local came left
  came=$(comm -13 "$root/clean_packages" <(installed))
  [[ -z $came ]] && return
  echo "   $(wc -w <<<"$came") packages came and go again"
  inside "apt-get purge -y -qq $(tr '\n' ' ' <<<"$came") >/dev/null 2>&1"
  left=$(inside "find / -xdev \( -path /proc -o -path /try -o -path /sys \) -prune -o -iname '*vicinity*' -print")
  [[ -z $left ]] || { echo "try_packages.sh: left behind: $left" >&2; exit 1; }
}
[[ -f $root/clean_packages ]] || installed >"$root/clean_packages"
end >/dev/null  # of a run that failed
inside "apt-get update -qq"

begin "vicinity: the command, its manual and its completions"
install /try/vicinity_*.deb
inside "cd /try && vicinity demo -o demo >/dev/null 2>&1 && ls demo/index.html"
inside "cd /try && vicinity build examples/02_arm_tick/cell.yaml -o cell.vicinity >/dev/null 2>&1 &&
        vicinity info cell.vicinity | head -n 3"
inside "cd /try && vicinity export cell.vicinity -o cell.vdb && vicinity simulate --help >/dev/null"
inside "ls /usr/share/man/man1/vicinity.1* /usr/share/bash-completion/completions/vicinity"
inside "! vicinity bridge --help 2>&1"  # says where it is
end

if compgen -G "$try/vicinity-bridge_*.deb" >/dev/null; then
  begin "vicinity-bridge: vicinity bridge, over DDS"
  install /try/vicinity_*.deb /try/vicinity-bridge_*.deb
  inside "cd /try && vicinity bridge examples/02_arm_tick/cell.yaml --robot examples/02_arm_tick/arm.urdf --seconds 2"
  end
fi

begin "libvicinity0 and libvicinity-dev: C by pkg-config, C++ by find_package"
install g++ make cmake pkg-config
install /try/libvicinity0_*.deb /try/libvicinity-dev_*.deb
inside "cd /try && cc c_example.c -o c_example \$(pkg-config --cflags --libs vicinity-c) &&
        ./c_example cell.vicinity examples/02_arm_tick/arm.urdf"
inside "cd /try && cmake -S examples/01_first_touch -B first >/dev/null && make -s -C first >/dev/null &&
        first/first_touch | tail -n 1"
if [[ -f $root/usr/include/vicinity/mujoco/drag.h ]]; then
  install libmujoco-dev libqhull-dev libgl-dev libopengl-dev
  inside "cd /try && cmake -S examples/03_mujoco -B third >/dev/null && make -s -C third >/dev/null &&
          third/swing examples/03_mujoco/arm.xml"
fi
end

for kind in deb wheel; do
  begin "Python, by the $kind"
  python=python3
  if [[ $kind == deb ]]; then
    install /try/python3-vicinity_*.deb
  else
    needs=$(dpkg-deb --field "$try"/python3-vicinity_*.deb Depends)
    inside "apt-get satisfy -y -qq --no-install-recommends '$needs' >/dev/null 2>&1"
    install python3-venv
    inside "python3 -m venv --system-site-packages /try/venv &&
            /try/venv/bin/pip install -q --no-index /try/vicinity-*.whl"
    python=/try/venv/bin/python3
  fi
  inside "cd /try && $python -B -c 'import vicinity; print(vicinity.__version__, vicinity.__file__)'"
  inside "cd /try && for example in examples/python/0*.py; do $python -B \$example | tail -n 1; done"
  [[ $kind == deb ]] || inside "/try/venv/bin/pip uninstall -q -y vicinity && rm -r /try/venv"
  end
done
rm -rf "$try"
echo "all of them installed, ran and left nothing"

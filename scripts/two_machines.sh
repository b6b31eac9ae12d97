#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# Two machines, as far as one can be two: a master and a slave in network namespaces of their own,
# a bad way between them, and now one now the other killed in the midst of it. As root:
#
#   scripts/two_machines.sh [MINUTES [SEED]]
#
# The slave has the scene, which changes now and then, and shares its field; the master follows it. A
# program at the master's side publishes joint states at 1 kHz to both and holds every torque that
# comes back against an oracle. Prints what it saw, and fails where a torque was wrong, the energy
# audit went below zero, or the two fields differ at the end. docs/bridge.md says what came of it.
set -euo pipefail
repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
minutes=${1:-10}
RANDOM=${2:-1}  # bash's own generator, seeded

if [[ $(id -u) -ne 0 || ! -c /dev/net/tun ]] || ! command -v ip >/dev/null; then
  echo "two_machines.sh: network namespaces and /dev/net/tun need root and the package iproute2" >&2
  exit 2
fi
"$repository/scripts/install_packages.sh" --bridge
cd "$repository"
if [[ ! -f build/release/build.ninja ]] || ! grep -q '^VICINITY_BRIDGE:BOOL=ON' build/release/CMakeCache.txt; then
  cmake --preset release -DVICINITY_BRIDGE=ON >/dev/null
fi
cmake --build build/release --target vicinity_cli vicinity_bridge_cli two_machines_relay two_machines_arm >/dev/null
vicinity=$PWD/build/release/apps/cli/vicinity
tests=$PWD/build/release/tests

folder=$(mktemp -d)
master=vicinity_master_$$ slave=vicinity_slave_$$
declare -A pids=()
end() {
  for pid in "${pids[@]}"; do
    kill -KILL "$pid" && wait "$pid"
  done 2>/dev/null || true
  ip netns delete $master 2>/dev/null || true
  ip netns delete $slave 2>/dev/null || true
  rm -rf "$folder"
}
trap end EXIT
alive() {
  kill -0 "${pids[$1]}" 2>/dev/null && return
  echo "two_machines.sh: the $1 ended before its time" >&2
  exit 1
}

# The hot cell, a little coarser; in the second and third, the risers stand elsewhere.
sed 's/^voxel_size: .*/voxel_size: 0.008/' scenes/hot_cell.yaml >"$folder/0.yaml"
cp scenes/hot_cell_arm.urdf "$folder"
sed -i 's/points_per_m2: .*/points_per_m2: 500/' "$folder/0.yaml"
sed 's/\[1\.36, 1\.0, /[1.38, 1.02, /g' "$folder/0.yaml" >"$folder/1.yaml"
sed 's/\[1\.36, 1\.3, /[1.34, 1.27, /g' "$folder/0.yaml" >"$folder/2.yaml"
cp "$folder/0.yaml" "$folder/scene.yaml"

for side in $master $slave; do
  ip netns add $side
  ip -n $side link set lo up
done
mkfifo "$folder/way" "$folder/events"
"$tests/two_machines_relay" $master $slave "$RANDOM" <"$folder/way" >"$folder/relay.txt" &
pids[relay]=$!
exec 3<>"$folder/way"  # both ways: waits for no reader
until grep -q ready "$folder/relay.txt"; do
  alive relay
  sleep 0.1
done
ip -n $master address add 10.77.0.1/24 dev link
ip -n $slave address add 10.77.0.2/24 dev link
for side in $master $slave; do ip -n $side link set dev link up; done

# No multicast, each other's address, packets that need not be cut on the way, and whoever is gone
# is given up after 3 s.
cat >"$folder/dds.xml" <<'END'
<CycloneDDS><Domain>
  <General>
    <Interfaces><NetworkInterface name="link" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
    <MaxMessageSize>1400B</MaxMessageSize>
    <FragmentSize>1200B</FragmentSize>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>4</MaxAutoParticipantIndex>
    <Peers><Peer address="10.77.0.1"/><Peer address="10.77.0.2"/></Peers>
    <SPDPInterval>1s</SPDPInterval>
    <LeaseDuration>3s</LeaseDuration>
  </Discovery>
</Domain></CycloneDDS>
END

say() { echo "$*" >&4; }
# `sampled`: as the oracle looks, at the place of each point and not on its way there. At the slave one
# state in a row may be lost: on a way that loses every tenth there would be little to check.
start() {
  local side=$1
  say "start $side"
  if [[ $side == master ]]; then
    ip netns exec $master "$vicinity" bridge "$folder/copy.vicinity" --follow-field /cell \
      --scene "$folder/0.yaml" --namespace /master --traversal sampled --dds "$folder/dds.xml" 2>>"$folder/master.txt" 3>&- 4>&- &
  else
    ip netns exec $slave "$vicinity" bridge "$folder/scene.yaml" --share-field /cell \
      --namespace /slave --traversal sampled --rate 500 --dds "$folder/dds.xml" 2>>"$folder/slave.txt" 3>&- 4>&- &
  fi
  pids[$side]=$!
}
pause() { sleep "$(printf '%d.%03d' $(($1 / 1000)) $(($1 % 1000)))"; }  # [ms]

seconds=$(awk "BEGIN { print int(60 * $minutes) }")
(
  exec 3>&-
  exec ip netns exec $master "$tests/two_machines_arm" "$folder/dds.xml" "$folder"/[012].yaml \
    <"$folder/events" >"$folder/arm.txt"
) &
pids[arm]=$!
exec 4<>"$folder/events"
sleep 3  # it builds its own fields
start slave
start master

begin=$SECONDS
next_way=0 next_scene=15 changes=0 scene=0
while ((SECONDS - begin < seconds)); do
  alive relay
  alive arm
  if ((SECONDS - begin >= next_way)); then
    delays=(0 20 50 100 200) losses=(0 1 2 5 10)
    delay=${delays[RANDOM % 5]} loss=${losses[RANDOM % 5]}
    echo "$delay $((delay / 4)) $loss" >&3
    next_way=$((SECONDS - begin + 15))
  fi
  if ((SECONDS - begin >= next_scene)); then
    scene=$(((scene + 1 + RANDOM % 2) % 3))
    cp "$folder/$scene.yaml" "$folder/new.yaml" && mv "$folder/new.yaml" "$folder/scene.yaml"
    say "scene $scene"
    changes=$((changes + 1))
    next_scene=$((SECONDS - begin + 15 + RANDOM % 10))
  fi
  pause $((2000 + RANDOM % 6000))
  sides=(master slave)
  victim=${sides[RANDOM % 2]}
  kill -KILL "${pids[$victim]}"
  wait "${pids[$victim]}" 2>/dev/null || true
  say "kill $victim"
  pause $((100 + RANDOM % 2000))
  start $victim
done
# Over the worst of ways, to the end, and nothing more happens: the two are to agree, and to be felt.
echo "200 50 10" >&3
"$vicinity" build "$folder/scene.yaml" -o "$folder/reference.vicinity" >/dev/null 2>&1
for ((waited = 0; waited < 120; ++waited)); do
  cmp -s "$folder/copy.vicinity" "$folder/reference.vicinity" && break
  sleep 1
done
sleep 10
exec 4>&-  # ends the arm
code=0
wait "${pids[arm]}" || code=$?
unset 'pids[arm]'
exec 3>&-  # ends the relay
wait "${pids[relay]}" || true
unset 'pids[relay]'

same=no
cmp -s "$folder/copy.vicinity" "$folder/reference.vicinity" && same=yes
echo "$minutes minutes, 0 to 200 ms and 0 to 10 % loss each way; $(tail -n 1 "$folder/relay.txt")"
echo "the scene changed $changes times; the copy is $([[ $same == yes ]] && echo "byte for byte the scene's field" || echo "ANOTHER FIELD")"
echo "transfers begun $(grep -c 'fetching' "$folder/master.txt" || true), ended $(grep -c ' is field ' "$folder/master.txt" || true)"
cat "$folder/arm.txt"
[[ $code == 0 && $same == yes ]] || { echo "two_machines.sh: FAILED" >&2; exit 1; }

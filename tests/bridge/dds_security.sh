#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# dds_security.sh VICINITY REPOSITORY: of three that want a field on one machine, the two with a
# certificate have it, and the one without hears nothing.
set -euo pipefail
vicinity=$1 repository=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$repository/scripts/dds_certificates.sh" "$folder" master slave
cp "$repository"/scenes/hot_cell_arm.urdf "$folder"
cat >"$folder/scene.yaml" <<'END'
voxel_size: 0.02
objects:
  - name: block
    primitive: {box: {size: [0.2, 0.1, 0.1]}}
robot: {urdf: hot_cell_arm.urdf, points_per_m2: 100}
END
domain=$((20 + $$ % 50))
"$vicinity" bridge "$folder/scene.yaml" --share-field /cell --domain $domain --dds "$folder/slave.xml" \
  --seconds 5 >"$folder/slave.txt" 2>&1 &
for follower in master outsider; do
  dds=()
  [[ $follower == outsider ]] || dds=(--dds "$folder/$follower.xml")
  "$vicinity" bridge "$folder/$follower.vicinity" --follow-field /cell --scene "$folder/scene.yaml" \
    --domain $domain "${dds[@]}" --seconds 4 >"$folder/$follower.txt" 2>&1 &
done
wait
cat "$folder"/{slave,master,outsider}.txt
"$vicinity" build "$folder/scene.yaml" -o "$folder/reference.vicinity" >/dev/null 2>&1
cmp "$folder/master.vicinity" "$folder/reference.vicinity"
[[ ! -e $folder/outsider.vicinity ]] || { echo "the outsider has the field"; exit 1; }

#!/usr/bin/env bash
# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
#
# What DDS Security asks for, for programs on this machine:
#
#   scripts/dds_certificates.sh FOLDER NAME...
#
# Leaves in FOLDER an authority (ca.key signs: keep it apart), a key and a certificate for each NAME,
# rules and permissions that the authority has signed, and NAME.xml, which `vicinity bridge --dds`
# takes. Nobody without a certificate takes part, and all that is said is encrypted. For two machines
# put their interface and addresses into NAME.xml, and copy there only what it names.
set -euo pipefail
[[ $# -ge 2 ]] || { sed -n '5,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
folder=$(realpath -m "$1")
names=("${@:2}")
plugins=$(dirname "$(find /usr/lib -name libdds_security_auth.so -print -quit)")
command -v openssl >/dev/null && [[ -n $plugins ]] || {
  echo "dds_certificates.sh: needs openssl and cyclonedds-dev: scripts/install_packages.sh --bridge" >&2
  exit 2
}
umask 077
mkdir -p "$folder"
cd "$folder"

key=(-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes)
openssl req -x509 "${key[@]}" -days 3650 -subj "/CN=authority" -keyout ca.key -out ca.pem 2>/dev/null
for name in "${names[@]}"; do
  openssl req "${key[@]}" -subj "/CN=$name" -keyout "$name.key" -out "$name.request" 2>/dev/null
  openssl x509 -req -in "$name.request" -CA ca.pem -CAkey ca.key -CAcreateserial -days 3650 \
    -out "$name.pem" 2>/dev/null
  rm "$name.request"
done

# Cyclone DDS reads no domain above 230.
domains='<domains><id_range><min>0</min><max>230</max></id_range></domains>'
cat >governance.xml <<END
<?xml version="1.0" encoding="UTF-8"?>
<dds><domain_access_rules><domain_rule>
  $domains
  <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
  <enable_join_access_control>true</enable_join_access_control>
  <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
  <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
  <rtps_protection_kind>SIGN</rtps_protection_kind>
  <topic_access_rules><topic_rule>
    <topic_expression>*</topic_expression>
    <enable_discovery_protection>true</enable_discovery_protection>
    <enable_liveliness_protection>true</enable_liveliness_protection>
    <enable_read_access_control>true</enable_read_access_control>
    <enable_write_access_control>true</enable_write_access_control>
    <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
    <data_protection_kind>ENCRYPT</data_protection_kind>
  </topic_rule></topic_access_rules>
</domain_rule></domain_access_rules></dds>
END
{
  echo '<?xml version="1.0" encoding="UTF-8"?>'
  echo '<dds><permissions>'
  for name in "${names[@]}"; do
    cat <<END
<grant name="$name"><subject_name>CN=$name</subject_name>
  <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2099-01-01T00:00:00</not_after></validity>
  <allow_rule>$domains
    <publish><topics><topic>rt/*</topic></topics></publish>
    <subscribe><topics><topic>rt/*</topic></topics></subscribe>
  </allow_rule>
  <default>DENY</default></grant>
END
  done
  echo '</permissions></dds>'
} >permissions.xml
for what in governance permissions; do
  openssl smime -sign -text -in $what.xml -out $what.p7s -signer ca.pem -inkey ca.key
  rm $what.xml
done

for name in "${names[@]}"; do
  cat >"$name.xml" <<END
<CycloneDDS><Domain>
  <General>
    <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers>
  </Discovery>
  <Security>
    <Authentication>
      <Library path="$plugins/libdds_security_auth.so" initFunction="init_authentication" finalizeFunction="finalize_authentication"/>
      <IdentityCA>file:$folder/ca.pem</IdentityCA>
      <IdentityCertificate>file:$folder/$name.pem</IdentityCertificate>
      <PrivateKey>file:$folder/$name.key</PrivateKey>
    </Authentication>
    <AccessControl>
      <Library path="$plugins/libdds_security_ac.so" initFunction="init_access_control" finalizeFunction="finalize_access_control"/>
      <PermissionsCA>file:$folder/ca.pem</PermissionsCA>
      <Governance>file:$folder/governance.p7s</Governance>
      <Permissions>file:$folder/permissions.p7s</Permissions>
    </AccessControl>
    <Cryptographic>
      <Library path="$plugins/libdds_security_crypto.so" initFunction="init_crypto" finalizeFunction="finalize_crypto"/>
    </Cryptographic>
  </Security>
</Domain></CycloneDDS>
END
done

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "dds/participant.h"

#include <fmt/format.h>

#include <memory>

#include "ros2/topics.h"
#include "vicinity/geometry/error.h"

namespace vicinity::dds {
namespace {

// This machine alone: no multicast, and whoever is asked stands at the loopback address.
constexpr const char* loopback = R"(<CycloneDDS><Domain>
  <General>
    <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers>
  </Discovery>
</Domain></CycloneDDS>)";

dds_entity_t checked(dds_entity_t entity, const std::string& what) {
  if (entity >= 0) return entity;
  throw Error({.where = "DDS", .what = what, .found = dds_strretcode(entity)});
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos qos_of(const Quality& quality, const std::string& type_hash) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  // As long as ROS 2 waits.
  dds_qset_reliability(qos.get(),
                       quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  dds_qset_durability(qos.get(),
                      quality.latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &xcdr1);
  // Where ROS 2 from Iron on looks for the hash of the type (REP 2016).
  const std::string said = "typehash=" + type_hash + ";";
  dds_qset_userdata(qos.get(), said.data(), said.size());
  return qos;
}

}  // namespace

Participant::Participant(const ParticipantOptions& options) : name_space_(options.name_space) {
  const std::string configuration =
      options.configuration.empty() ? loopback : options.configuration;
  domain_ = checked(dds_create_domain(options.domain, configuration.c_str()),
                    fmt::format("domain {} cannot be joined", options.domain));
  participant_ = dds_create_participant(options.domain, nullptr, nullptr);
  if (participant_ < 0) dds_delete(domain_);
  checked(participant_, fmt::format("domain {} cannot be joined", options.domain));
}

Participant::~Participant() {
  dds_delete(participant_);
  dds_delete(domain_);
}

dds_entity_t Participant::endpoint(std::string_view topic, const ros2::Description& description,
                                   const Quality& quality, bool writes) {
  const std::string ros_name = (quality.named_alone ? "" : name_space_) + std::string(topic);
  const std::string name = ros2::topic::on_the_wire(ros_name);
  const Qos qos = qos_of(quality, ros2::type_hash(description));
  ddsi_sertype* type = new_cdr_type(ros2::dds_type_name(description.front().type));
  const dds_entity_t made =
      dds_create_topic_sertype(participant_, name.c_str(), &type, nullptr, nullptr, nullptr);
  checked(made, "the topic '" + ros_name + "' cannot be had");
  const dds_entity_t end = writes ? dds_create_writer(participant_, made, qos.get(), nullptr)
                                  : dds_create_reader(participant_, made, qos.get(), nullptr);
  return checked(end, "the topic '" + ros_name + "' cannot be joined");
}

Participant::Waiter::Waiter(const Participant& participant,
                            const std::vector<dds_entity_t>& readers)
    : waitset_(checked(dds_create_waitset(participant.entity()), "nothing can be waited for")) {
  for (const dds_entity_t reader : readers) {
    checked(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS),
            "a reader cannot be waited for");
    checked(dds_waitset_attach(waitset_, reader, reader), "a reader cannot be waited for");
  }
}

void Participant::Waiter::wait(double seconds) const {
  dds_waitset_wait(waitset_, nullptr, 0, static_cast<dds_duration_t>(1e9 * seconds));
}

bool is_heard(dds_entity_t writer) { return dds_get_matched_subscriptions(writer, nullptr, 0) > 0; }

bool take(dds_entity_t reader, Sample& bytes) {
  void* samples[1] = {&bytes};
  dds_sample_info_t info;
  // What is no data (a sender that went, say) is passed over.
  while (dds_take(reader, samples, &info, 1, 1) == 1) {
    if (info.valid_data) return true;
  }
  return false;
}

}  // namespace vicinity::dds

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One program among others on ROS 2's data space, without ROS 2: topics by their ROS names, with
/// the types, qualities of service and type hashes that ROS 2 expects.
#pragma once

#include <dds/dds.h>

#include <string>
#include <string_view>
#include <vector>

#include "dds/cdr_type.h"
#include "ros2/cdr.h"
#include "ros2/schema.h"

namespace vicinity::dds {

struct ParticipantOptions {
  std::uint32_t domain = 0;  ///< ROS_DOMAIN_ID, 0..232
  /// Cyclone's configuration: XML, or file://. Empty: this machine alone (the loopback address, no
  /// multicast).
  std::string configuration;
  std::string name_space;  ///< in front of topics: "/left"
};

/// What a sender or receiver wants of the way between them. The newest are kept in all cases.
struct Quality {
  /// A receiver that is not takes from senders of both kinds, and waits for nothing that was lost.
  bool reliable = true;
  int depth = 10;            ///< as many of the newest are kept
  bool latched = false;      ///< transient local: who comes later gets the newest too
  bool named_alone = false;  ///< the namespace is not put in front of it
};

/// Errors: every function throws Error where DDS refuses.
class Participant {
 public:
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// @param topic  a ROS name: "/joint_states"
  template <class Message>
  dds_entity_t writer(std::string_view topic, const Quality& quality = {}) {
    return endpoint(topic, ros2::Describer::of<Message>(), quality, true);
  }
  template <class Message>
  dds_entity_t reader(std::string_view topic, const Quality& quality = {}) {
    return endpoint(topic, ros2::Describer::of<Message>(), quality, false);
  }

  /// Wakes when one of them has data, or after a time. For one thread.
  class Waiter {
   public:
    Waiter(const Participant& participant, const std::vector<dds_entity_t>& readers);
    void wait(double seconds) const;

   private:
    dds_entity_t waitset_;
  };

  dds_entity_t entity() const noexcept { return participant_; }

 private:
  dds_entity_t endpoint(std::string_view topic, const ros2::Description& description,
                        const Quality& quality, bool writes);

  std::string name_space_;
  dds_entity_t domain_ = 0, participant_ = 0;
};

/// Sends one message. @param bytes  room for it, used again
/// False where DDS refused: a reader too slow for a reliable writer, say.
template <class Message>
bool send(dds_entity_t writer, const Message& message, Sample& bytes) {
  ros2::write_cdr(message, bytes);
  return dds_write(writer, &bytes) == DDS_RETCODE_OK;
}

/// Whether anybody listens to a writer.
bool is_heard(dds_entity_t writer);

/// Takes the oldest sample that has not been taken; false where there is none.
bool take(dds_entity_t reader, Sample& bytes);

}  // namespace vicinity::dds

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Somebody else's program on ROS 2's data space: Fast DDS, and not a line of ours.
//
//   fast_dds_peer DOMAIN SECONDS
//
// Publishes joint states at 1 kHz of an arm with the joints turn, bend and slide, once the first
// has been answered; counts the wrenches that come back, and says what it saw in one line of JSON.

#include <fastcdr/Cdr.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::int64_t start_ns = 1'700'000'000'000'000'000;

struct JointState {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame;
  std::vector<std::string> name;
  std::vector<double> position, velocity, effort;
};

struct Wrench {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame;
  double force[3] = {}, torque[3] = {};
};

void put(Cdr& cdr, const JointState& m) {
  cdr << m.sec << m.nanosec << m.frame << m.name << m.position << m.velocity << m.effort;
}
void put(Cdr& cdr, const Wrench& m) { cdr << m.sec << m.nanosec << m.frame; }
void take(Cdr& cdr, JointState& m) {
  cdr >> m.sec >> m.nanosec >> m.frame >> m.name >> m.position >> m.velocity >> m.effort;
}
void take(Cdr& cdr, Wrench& m) {
  cdr >> m.sec >> m.nanosec >> m.frame;
  for (double& x : m.force) cdr >> x;
  for (double& x : m.torque) cdr >> x;
}

template <class Message>
class Type : public fast::TopicDataType {
 public:
  explicit Type(const char* name) {
    setName(name);
    m_typeSize = 1024;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->max_size);
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    payload->encapsulation = CDR_LE;
    cdr.serialize_encapsulation();
    put(cdr, *static_cast<Message*>(data));
    payload->length = static_cast<std::uint32_t>(cdr.getSerializedDataLength());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    try {
      FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      cdr.read_encapsulation();
      take(cdr, *static_cast<Message*>(data));
      return true;
    } catch (const eprosima::fastcdr::exception::Exception&) {
      return false;
    }
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override {
    return [this] { return m_typeSize; };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

struct Listener : fast::DataReaderListener {
  void on_data_available(fast::DataReader* reader) override {
    Wrench wrench;
    fast::SampleInfo info;
    while (reader->take_next_sample(&wrench, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      ++wrenches;
      const std::int64_t stamp = wrench.sec * 1'000'000'000LL + wrench.nanosec;
      if (stamp == last) ++doubled;
      if (stamp < last) ++backwards;
      last = stamp;
      stamps.insert(stamp);
      const double force = std::hypot(wrench.force[0], wrench.force[1], wrench.force[2]);
      if (force > strongest) strongest = force;
      frame = wrench.frame;
    }
  }
  std::uint64_t wrenches = 0, doubled = 0, backwards = 0;
  std::atomic<std::int64_t> last = 0;
  double strongest = 0;
  std::string frame;
  std::set<std::int64_t> stamps;
};

fast::DomainParticipantQos loopback() {
  fast::DomainParticipantQos qos = fast::PARTICIPANT_QOS_DEFAULT;
  const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back("127.0.0.1");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, 127, 0, 0, 1);
  qos.wire_protocol().builtin.initialPeersList.push_back(here);
  rtps::Locator_t listens = here;
  listens.port = 0;
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(listens);
  return qos;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const double seconds = std::atof(argv[2]);
  auto* participant = fast::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<std::uint32_t>(std::atoi(argv[1])), loopback());
  if (participant == nullptr) return 1;
  fast::TypeSupport states(new Type<JointState>("sensor_msgs::msg::dds_::JointState_"));
  fast::TypeSupport wrenches(new Type<Wrench>("geometry_msgs::msg::dds_::WrenchStamped_"));
  states.register_type(participant);
  wrenches.register_type(participant);
  auto* out =
      participant->create_topic("rt/joint_states", states.get_type_name(), fast::TOPIC_QOS_DEFAULT);
  auto* in = participant->create_topic("rt/vicinity/wrench", wrenches.get_type_name(),
                                       fast::TOPIC_QOS_DEFAULT);
  fast::DataWriterQos writer_qos = fast::DATAWRITER_QOS_DEFAULT;
  writer_qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  writer_qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  writer_qos.history().depth = 100;
  fast::DataReaderQos reader_qos = fast::DATAREADER_QOS_DEFAULT;
  reader_qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
  reader_qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
  reader_qos.history().depth = 100;
  Listener listener;
  auto* writer = participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                     ->create_datawriter(out, writer_qos);
  auto* reader = participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
                     ->create_datareader(in, reader_qos, &listener);
  if (writer == nullptr || reader == nullptr) return 1;

  using Clock = std::chrono::steady_clock;
  const auto found_by = Clock::now() + std::chrono::seconds(20);
  for (bool found = false; !found;) {
    fast::PublicationMatchedStatus publications;
    fast::SubscriptionMatchedStatus subscriptions;
    writer->get_publication_matched_status(publications);
    reader->get_subscription_matched_status(subscriptions);
    found = publications.current_count > 0 && subscriptions.current_count > 0;
    if (Clock::now() > found_by) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }

  JointState state;
  state.name = {"slide", "turn", "bend"};
  const auto begin = Clock::now();
  // Stamped with when it was due: 1 kHz, whatever this machine makes of it.
  const auto say = [&](std::int64_t ms) {
    std::this_thread::sleep_until(begin + std::chrono::milliseconds(ms));
    const std::int64_t stamp = start_ns + 1'000'000 * ms;
    state.sec = static_cast<std::int32_t>(stamp / 1'000'000'000);
    state.nanosec = static_cast<std::uint32_t>(stamp % 1'000'000'000);
    return writer->write(&state) ? stamp : 0;
  };
  // That we have found it does not say that it has found us: ask until it answers.
  std::int64_t first = 0;
  state.position = {0, 0.7, 0};
  for (; listener.last < start_ns && Clock::now() < found_by; first += 10) say(first);
  std::set<std::int64_t> sent;
  for (int k = 0; k < seconds * 1000; ++k) {
    const double t = 0.001 * k, swing = 0.5 - 0.5 * std::cos(2 * t);
    state.position = {0.02 * swing, 0.7 + 0.3 * swing, 0.2 * swing};
    if (const std::int64_t stamp = say(first + k); stamp > 0) sent.insert(stamp);
  }
  writer->wait_for_acknowledgments({5, 0});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  reader->set_listener(nullptr);
  std::size_t unanswered = 0;
  for (const std::int64_t stamp : sent) unanswered += listener.stamps.contains(stamp) ? 0 : 1;
  std::printf(
      "{\"sent\": %zu, \"wrenches\": %llu, \"unanswered\": %zu, \"doubled\": %llu, "
      "\"backwards\": %llu, \"strongest\": %.9g, \"frame\": \"%s\"}\n",
      sent.size(), static_cast<unsigned long long>(listener.wrenches), unanswered,
      static_cast<unsigned long long>(listener.doubled),
      static_cast<unsigned long long>(listener.backwards), listener.strongest,
      listener.frame.c_str());
  std::fflush(stdout);
  std::_Exit(0);  // Fast DDS takes its time to end
}

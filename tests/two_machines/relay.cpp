// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// A bad way between two network namespaces, where the kernel has no tool to make one: IP packets
// from one TUN device to the other, late, in another order, or not at all.
//
//   two_machines_relay NAMESPACE NAMESPACE SEED
//
// Makes a device called "link" in each namespace, says "ready", and carries until standard input
// ends. A line "DELAY JITTER LOSS" there sets the way from then on, in either direction: a packet
// takes DELAY plus or minus up to JITTER [ms], which wanders, as queues on the way fill and empty;
// one in a hundred takes up to JITTER longer, and is overtaken; with a chance of LOSS [%] it is
// lost.

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <queue>
#include <random>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

struct Packet {
  Clock::time_point due;
  std::uint64_t number = 0;
  int to = -1;
  std::vector<char> bytes;
  bool operator<(const Packet& other) const {  // the queue's top is what is due first
    return due != other.due ? due > other.due : number > other.number;
  }
};

// From -1 to 1, on straight lines between values drawn for every tenth of a second.
class Wander {
 public:
  double now(std::mt19937_64& random) {
    std::uniform_real_distribution<double> value(-1, 1);
    double part = std::chrono::duration<double>(Clock::now() - begin_).count() / 0.1;
    if (part >= 1) {
      from_ = part < 2 ? to_ : value(random);
      to_ = value(random);
      begin_ = Clock::now();
      part = 0;
    }
    return from_ + part * (to_ - from_);
  }

 private:
  Clock::time_point begin_;
  double from_ = 0, to_ = 0;
};

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "two_machines_relay: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(2);
}

int device_in(const std::string& name_space) {
  const int space = open(("/run/netns/" + name_space).c_str(), O_RDONLY | O_CLOEXEC);
  if (space < 0 || setns(space, CLONE_NEWNET) != 0) fail("the network namespace " + name_space);
  close(space);
  const int device = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device < 0) fail("/dev/net/tun");
  ifreq request{};
  std::strcpy(request.ifr_name, "link");
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (ioctl(device, TUNSETIFF, &request) != 0) fail("a TUN device");
  return device;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const int devices[2] = {device_in(argv[1]), device_in(argv[2])};
  std::mt19937_64 random(std::strtoull(argv[3], nullptr, 10));
  std::uniform_real_distribution<double> from_0_to_1(0, 1);
  std::puts("ready");
  std::fflush(stdout);
  double delay_ms = 0, jitter_ms = 0, loss = 0;
  Wander wander;
  std::uint64_t carried = 0, lost = 0;
  std::priority_queue<Packet> under_way;
  std::vector<char> buffer(65536);
  for (;;) {
    pollfd waiting[3] = {
        {devices[0], POLLIN, 0}, {devices[1], POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}};
    timespec longest{1, 0};
    if (!under_way.empty()) {
      const auto left =
          std::chrono::duration_cast<std::chrono::nanoseconds>(under_way.top().due - Clock::now());
      const std::int64_t ns = std::clamp<std::int64_t>(left.count(), 0, 1'000'000'000);
      longest = {ns / 1'000'000'000, ns % 1'000'000'000};
    }
    ppoll(waiting, 3, &longest, nullptr);
    if ((waiting[2].revents & (POLLIN | POLLHUP)) != 0) {
      const ssize_t size = read(STDIN_FILENO, buffer.data(), buffer.size() - 1);
      if (size <= 0) break;
      buffer[static_cast<std::size_t>(size)] = 0;
      double percent = 0;
      if (std::sscanf(buffer.data(), "%lf %lf %lf", &delay_ms, &jitter_ms, &percent) == 3) {
        loss = percent / 100;
      }
    }
    for (int from = 0; from < 2; ++from) {
      for (ssize_t size; (size = read(devices[from], buffer.data(), buffer.size())) > 0;) {
        if (from_0_to_1(random) < loss) {
          ++lost;
          continue;
        }
        double ms = std::max(0.0, delay_ms + jitter_ms * wander.now(random));
        if (from_0_to_1(random) < 0.01) ms += jitter_ms * from_0_to_1(random);
        under_way.push({.due = Clock::now() + std::chrono::microseconds(std::lround(1000 * ms)),
                        .number = carried++,
                        .to = devices[1 - from],
                        .bytes = {buffer.data(), buffer.data() + size}});
      }
    }
    while (!under_way.empty() && under_way.top().due <= Clock::now()) {
      const Packet& packet = under_way.top();
      (void)!write(packet.to, packet.bytes.data(), packet.bytes.size());
      under_way.pop();
    }
  }
  std::printf("the way carried %llu packets and lost %llu\n",
              static_cast<unsigned long long>(carried), static_cast<unsigned long long>(lost));
}

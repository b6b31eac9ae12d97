// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// Pages that mean harm, or have hung: the server stays up, its memory stays flat, and the arm goes
// on ticking. VICINITY_STORM is the number of messages; what docs/viewer.md says was measured with
//
//   VICINITY_STORM=100000 build/release/tests/viewer_test --gtest_filter='Storm.*'

#include <gtest/gtest.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <mutex>
#include <random>
#include <thread>

#include "served.h"

namespace vicinity::viewer_test {
namespace {

constexpr std::uint64_t megabyte = 1 << 20;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
// Freed memory is kept back for a while.
constexpr std::uint64_t flat = 400 * megabyte;
#else
constexpr std::uint64_t flat = 40 * megabyte;
#endif

int messages_of_a_storm() {
  int messages = 10'000;
  const char* const said = std::getenv("VICINITY_STORM");
  if (said != nullptr) std::from_chars(said, said + std::string_view(said).size(), messages);
  return messages;
}

// Of the time before, and of the time that many pages look on.
std::chrono::milliseconds calm() { return std::chrono::milliseconds(messages_of_a_storm() / 10); }

// What snapshots say of the loop. Times are printed and not judged: the machine is shared.
struct LoopState {
  double time_s = 0;
  std::uint64_t ticks = 0, skipped = 0, missed = 0;
  std::vector<std::uint32_t> histogram;
};

// A page that looks on all the while, as a person's does, and knows the newest snapshot.
class Onlooker {
 public:
  explicit Onlooker(Served& served) : served_(served), page_(served.port()) {}
  ~Onlooker() { over_.store(true); }

  /// How the loop is doing now, or a little later; nothing where the page was cut off.
  std::optional<LoopState> look() {
    const std::uint64_t ticks = served_.site().loop().ticks();
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < until && !cut_off_.load()) {
      {
        const std::lock_guard lock(mutex_);
        if (newest_ && newest_->ticks >= ticks) return newest_;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return {};
  }

 private:
  void read() {
    while (!over_.load()) {
      const auto m = page_.next_of(3);
      if (!m) break;
      LoopState state{.time_s = m->number<double>(16),
                      .ticks = m->number<std::uint64_t>(24),
                      .skipped = m->number<std::uint64_t>(32),
                      .missed = m->number<std::uint64_t>(40),
                      .histogram = {}};
      const auto bins = m->number<std::uint16_t>(62);
      const std::size_t begin = m->payload.size() - 4u * bins;
      for (std::size_t n = 0; n < bins; ++n) {
        state.histogram.push_back(m->number<std::uint32_t>(begin + 4 * n));
      }
      const std::lock_guard lock(mutex_);
      newest_ = state;
    }
    cut_off_.store(true);
  }

  Served& served_;
  PageClient page_;
  std::mutex mutex_;
  std::optional<LoopState> newest_;
  std::atomic<bool> over_{false}, cut_off_{false};
  std::jthread reader_{[this] { read(); }};
};

void print(const char* when, const LoopState& from, const LoopState& to) {
  constexpr const char* edges[] = {"<1",   "<2",   "<5",   "<10",  "<20",  "<50",  "<100",
                                   "<200", "<500", "<1ms", "<2ms", "<5ms", "<10ms"};
  std::cout << "  " << when << ": " << to.ticks - from.ticks << " ticks in "
            << to.time_s - from.time_s << " s, " << to.skipped - from.skipped << " skipped, "
            << to.missed - from.missed << " deadlines missed; tick times [us]";
  for (std::size_t n = 0; n < to.histogram.size(); ++n) {
    const std::uint32_t count = to.histogram[n] - from.histogram[n];
    if (count > 0) std::cout << ' ' << (n < std::size(edges) ? edges[n] : "more") << ':' << count;
  }
  std::cout << '\n';
}

// The loop has begun a tick for every period that has passed, but for those it skipped because its
// own time was over: it has not stood still for anybody. Ticks and skipped ticks are counted by the
// loop, time by the clock.
void expect_ticking(const LoopState& from, const LoopState& to) {
  EXPECT_GT(to.ticks, from.ticks);
  const double periods = 1000 * (to.time_s - from.time_s);
  EXPECT_NEAR(static_cast<double>(to.ticks - from.ticks + to.skipped - from.skipped), periods,
              2 + 1e-3 * periods);
}

// One message of a random kind: noise, a command with noise behind it, a good one that is cut or
// changed, JSON that is not what it should be, or a frame that breaks the rules.
class Storm {
 public:
  explicit Storm(std::uint64_t seed) : random_(seed) {}

  std::string next() {
    switch (random_() % 8) {
      case 0:
        return client_frame(2, noise(64));
      case 1:
        return client_frame(2, command(type(), id(), noise(100)));
      case 2: {
        std::string message = good();
        message.resize(random_() % (message.size() + 1));
        return client_frame(2, message);
      }
      case 3: {
        std::string message = good();
        message[random_() % message.size()] = static_cast<char>(random_());
        return client_frame(2, message);
      }
      case 4:
        return client_frame(2, command(json_type(), id(), json()));
      case 5:
        return client_frame(1, noise(20));
      case 6:
        return client_frame(2, good());
      default:
        return random_() % 20 == 0 ? breaking() : client_frame(9, noise(20));
    }
  }

 private:
  std::uint32_t id() { return static_cast<std::uint32_t>(random_()); }
  std::uint16_t type() { return static_cast<std::uint16_t>(60 + random_() % 24); }
  std::uint16_t json_type() { return static_cast<std::uint16_t>(69 + random_() % 7); }
  double number() {
    constexpr double odd[] = {0, 1, -1, 1e300, -1e300, 1e-300, 0.05};
    if (random_() % 8 == 0) return std::numeric_limits<double>::quiet_NaN();
    if (random_() % 8 == 0) return std::numeric_limits<double>::infinity();
    return odd[random_() % std::size(odd)];
  }
  std::string noise(std::size_t most) {
    std::string bytes(random_() % (most + 1), '\0');
    for (char& c : bytes) c = static_cast<char>(random_());
    return bytes;
  }
  std::string good() {
    switch (random_() % 5) {
      case 0:
        return command(64, id(),
                       bytes_of(std::uint8_t{1}, std::uint8_t{0}, std::uint16_t{0}, 0u, number(),
                                number(), number(), 0., 0., 0., 1.));
      case 1:
        return command(64, id(),
                       bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint16_t{3}, 0u, number(),
                                number(), number()));
      case 2:
        return command(65, id(),
                       bytes_of(static_cast<std::uint8_t>(random_() % 4), std::uint8_t{0},
                                std::uint16_t{64}, 0u, number()));
      case 3:
        return command(68, id(), bytes_of(number(), number(), number()));
      default:
        return command(66, id(),
                       bytes_of(static_cast<std::uint16_t>(random_() % 6), std::uint16_t{0}, 0u));
    }
  }
  std::string json() {
    constexpr const char* pieces[] = {
        "{}",
        "[]",
        "null",
        "{",
        "{\"name\": \"../x.yaml\"}",
        "{\"name\": 5}",
        "{\"scene\": {\"objects\": []}}",
        "{\"scene\": []}",
        "{\"recording\": -1}",
        "{\"recording\": 1e300}",
        "{\"coding\": [1e400]}",
        "{\"coding\": {\"a\": []}}",
        "{\"codings\": {\"block\": {\"skin\": \"x\"}}}",
        "{\"memory\": 5}",
        "{\"scene\": {\"voxel_size\": 1e-9, \"objects\": [{\"name\": \"a\", \"primitive\": "
        "{\"box\": {\"size\": [1, 1, 1]}}}]}}",
        "{\"name\": \"\\u0000.csv\"}"};
    const std::size_t n = random_() % (std::size(pieces) + 2);
    if (n < std::size(pieces)) return pieces[n];
    if (n == std::size(pieces)) return std::string(20'000, '[');
    return "{\"scene\": " + std::string(10'000, '{');
  }
  std::string breaking() {
    switch (random_() % 5) {
      case 0:
        return noise(30);
      case 1:
        return std::string("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x01\x02\x03\x04", 14);
      case 2:
        return client_frame(2, std::string(300'000, 'x'));
      case 3:
        return client_frame(0, "more");
      default:
        return client_frame(8, "");
    }
  }

  std::mt19937_64 random_;
};

TEST(Storm, RandomAndMalformedMessagesChangeNothing) {
  viewer::WebOptions options;
  options.messages_per_s = 1e9;  // what is sent is to be read, not dropped
  options.burst = 1e9;
  Served served(options);
  Onlooker looks_on(served);
  const auto at_first = looks_on.look();
  std::this_thread::sleep_for(calm());
  const auto before = looks_on.look();
  ASSERT_TRUE(at_first && before);
  print("before", *at_first, *before);

  const int messages = messages_of_a_storm();
  constexpr std::uint64_t seed = 20240607;
  std::cout << "  seed " << seed << ", " << messages << " messages\n";
  Storm storm(seed);
  std::uint64_t memory_before = 0;
  int sent = 0, connections = 0;
  for (; sent < messages; ++connections) {
    PageClient attacker(served.port());
    // Everything has been seen once by then: what comes later must not add to it.
    for (bool open = true; open && sent < messages;) {
      open = attacker.send_raw(storm.next());
      ++sent;
      // It listens too, as a page would: else it would be closed for taking nothing.
      while (open && !attacker.connected().receive(std::chrono::milliseconds(0)).empty()) {
      }
      if (sent == messages / 5) memory_before = resident_bytes();
    }
  }
  const auto after = looks_on.look();
  ASSERT_TRUE(after) << "the page that looks on was cut off";
  print("during", *before, *after);
  expect_ticking(*before, *after);
  const std::uint64_t memory_after = resident_bytes();
  std::cout << "  " << connections << " connections; resident memory " << memory_before / megabyte
            << " MiB a fifth of the way, " << memory_after / megabyte << " MiB at the end\n";
  EXPECT_LT(memory_after, memory_before + flat);

  // And it answers as ever.
  PageClient page(served.port());
  ASSERT_TRUE(page.next_of(1));
  page.send(command(68, 9, bytes_of(0.0, 0.0, 0.065)));
  const auto pick = page.answer(9, std::chrono::seconds(60));
  ASSERT_TRUE(pick);
  EXPECT_EQ(json_of(*pick)["object"], "block");
}

TEST(Storm, FiftyPagesHungOnesAndASlowOneHoldNobody) {
  viewer::WebOptions options;
  options.waiting_bytes = 4 * megabyte;
  options.silence_s = 5;
  options.ping_s = 1;
  Served served(options);
  Onlooker looks_on(served);
  const auto at_first = looks_on.look();
  std::this_thread::sleep_for(calm());
  const auto before = looks_on.look();
  ASSERT_TRUE(at_first && before);
  print("before", *at_first, *before);

  std::vector<std::unique_ptr<PageClient>> pages;
  for (int n = 0; n < 50; ++n) pages.push_back(std::make_unique<PageClient>(served.port()));
  std::vector<std::unique_ptr<Connected>> half_open;
  for (int n = 0; n < 20; ++n) {
    half_open.push_back(std::make_unique<Connected>(served.port()));
    half_open.back()->send("GET /ws HT");
  }
  // Their lines are open, and nobody is there any more: they neither read nor answer a ping.
  std::vector<std::unique_ptr<PageClient>> gone;
  for (int n = 0; n < 10; ++n) gone.push_back(std::make_unique<PageClient>(served.port()));
  // This one asks for everything and takes nothing.
  PageClient slow(served.port());
  for (std::uint32_t n = 0; n < 200; ++n) {
    slow.send(
        command(65, n, bytes_of(std::uint8_t{2}, std::uint8_t{0}, std::uint16_t{0}, 0u, 0.0)));
    slow.send(command(66, n, bytes_of(std::uint16_t{0}, std::uint16_t{1}, 0u)));
  }
  const std::uint64_t memory_before = resident_bytes();
  // Every page gets its snapshots, the newest ones, while the slow one takes none.
  int rounds = 0;
  for (const auto end = std::chrono::steady_clock::now() + calm();
       rounds < 20 || std::chrono::steady_clock::now() < end; ++rounds) {
    for (const auto& page : pages) ASSERT_TRUE(page->next_of(3)) << "round " << rounds;
  }
  const auto after = looks_on.look();
  ASSERT_TRUE(after);
  print("during", *before, *after);
  expect_ticking(*before, *after);
  const std::uint64_t memory_after = resident_bytes();
  std::cout << "  " << rounds << " snapshots to each of " << pages.size() << " pages, of "
            << pages.size() + 12 << " that came " << served.server().open_count()
            << " are open; resident memory " << memory_before / megabyte << " and "
            << memory_after / megabyte << " MiB\n";
  EXPECT_LT(memory_after, memory_before + flat);
  EXPECT_GE(served.server().open_count(), 51u);
}

}  // namespace
}  // namespace vicinity::viewer_test

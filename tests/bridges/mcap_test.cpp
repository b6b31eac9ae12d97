// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// MCAP files: what is written is read back, and what became of a file in between never goes
// unnoticed. The public reader is asked in tests/readers/mcap.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tuple>

#include "mcap/crc32.h"
#include "mcap/reader.h"
#include "mcap/writer.h"
#include "vicinity/geometry/error.h"
#include "viscosity/seeds.h"

namespace vicinity::mcap {
namespace {

using Said = std::vector<std::tuple<std::string, std::uint64_t, std::string>>;

class Mcap : public testing::Test {
 protected:
  Mcap() {
    std::string name = (std::filesystem::temp_directory_path() / "vicinity_mcap_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Mcap() override { std::filesystem::remove_all(path_); }

  Ending read_back(const std::string& bytes, Said& said) const {
    const std::filesystem::path file = path_ / "file.mcap";
    std::ofstream(file, std::ios::binary) << bytes;
    said.clear();
    return read(file, [&](const Schema& schema, const Channel& channel, const Message& message) {
      EXPECT_EQ(schema.name, "some/msg/Text");
      said.emplace_back(
          channel.topic, message.log_time_ns,
          std::string(reinterpret_cast<const char*>(message.data.data()), message.data.size()));
    });
  }

  std::filesystem::path path_;
};

// Some channels, messages of any length and in any order of time, and chunks closed here and there.
std::string random_file(std::mt19937& random, Said& said) {
  std::string bytes;
  Writer writer([&](std::string_view next) { bytes += next; }, "", "test");
  const std::uint16_t schema = writer.add_schema("some/msg/Text", "", "");
  const int channels = test::whole(random, 1, 4);
  for (int n = 0; n < channels; ++n) writer.add_channel("/" + std::to_string(n), schema, "text");
  for (int n = test::whole(random, 0, 60); n > 0; --n) {
    const int channel = test::whole(random, 0, channels - 1);
    const auto time = static_cast<std::uint64_t>(test::whole(random, 0, 1'000'000));
    const std::string text(static_cast<std::size_t>(test::whole(random, 0, 300)),
                           static_cast<char>(test::whole(random, 'a', 'z')));
    writer.write(static_cast<std::uint16_t>(channel), time, std::as_bytes(std::span(text)));
    said.emplace_back("/" + std::to_string(channel), time, text);
    if (test::whole(random, 0, 9) == 0) writer.close_chunk();
  }
  writer.finish();
  return bytes;
}

bool begins_with(const Said& whole, const Said& part) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

TEST(Crc32, IsTheOneOfZlib) { EXPECT_EQ(crc32("123456789"), 0xCBF43926u); }

TEST_F(Mcap, GivesBackWhatWasWritten) {
  test::for_each_seed(40, [this](std::mt19937& random) {
    Said written, said;
    const std::string bytes = random_file(random, written);
    const Ending ending = read_back(bytes, said);
    EXPECT_TRUE(ending.whole);
    EXPECT_EQ(said, written);
  });
}

TEST_F(Mcap, ClosesAChunkOnceItIsFull) {
  std::size_t handed_over = 0;
  Writer writer([&](std::string_view) { ++handed_over; }, "", "test");
  const std::uint16_t channel = writer.add_channel("/a", writer.add_schema("s", "", ""), "text");
  const std::size_t before = handed_over;
  const std::string text(Writer::full_chunk / 8, 'x');
  for (int n = 0; n < 20; ++n) {
    writer.write(channel, 0, std::as_bytes(std::span(text)));
  }
  EXPECT_EQ(handed_over - before, 2u);
}

// The power fails at any byte: what was handed over before is there.
TEST_F(Mcap, IsReadUpToWhereItWasCut) {
  test::for_each_seed(12, [this](std::mt19937& random) {
    Said written, said;
    const std::string bytes = random_file(random, written);
    std::size_t most = 0;
    for (std::size_t length = magic.size(); length < bytes.size();
         length += static_cast<std::size_t>(test::whole(random, 1, 40))) {
      std::string cut = bytes.substr(0, length);
      // Some file systems leave zeros behind.
      if (test::whole(random, 0, 2) == 0) cut += std::string(500, '\0');
      const Ending ending = read_back(cut, said);
      ASSERT_FALSE(ending.whole) << length;
      ASSERT_TRUE(begins_with(written, said)) << length;
      ASSERT_GE(said.size(), most) << "a longer part held less, at " << length;
      EXPECT_LE(ending.used, cut.size());
      most = said.size();
    }
    EXPECT_EQ(most, written.size());
  });
}

TEST_F(Mcap, NoticesAnyByteThatChanged) {
  test::for_each_seed(150, [this](std::mt19937& random) {
    Said written, said;
    std::string bytes = random_file(random, written);
    const int place = test::whole(random, 0, static_cast<int>(bytes.size()) - 1);
    bytes[static_cast<std::size_t>(place)] ^= static_cast<char>(test::whole(random, 1, 255));
    SCOPED_TRACE("byte " + std::to_string(place));
    try {
      (void)read_back(bytes, said);
      // In the summary, or at the end: nothing that was read.
      EXPECT_EQ(said, written);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("file.mcap"));
    }
  });
}

TEST_F(Mcap, SurvivesAnyBytes) {
  test::for_each_seed(400, [this](std::mt19937& random) {
    Said written;
    std::string bytes = random_file(random, written);
    for (int n = test::whole(random, 1, 30); n > 0; --n) {
      const auto place = static_cast<std::size_t>(test::whole(random, 8, 400)) % bytes.size();
      bytes[place] = static_cast<char>(test::whole(random, -128, 127));
    }
    if (test::whole(random, 0, 1) == 0) bytes.resize(bytes.size() / 2);
    bytes.replace(0, std::min(magic.size(), bytes.size()), magic);
    std::ofstream(path_ / "file.mcap", std::ios::binary) << bytes;
    try {
      (void)read(path_ / "file.mcap", [](const auto&, const auto&, const auto&) {});
    } catch (const Error&) {
    }
  });
}

TEST_F(Mcap, RefusesWhatIsNone) {
  Said said;
  for (const std::string& bytes :
       {std::string(), std::string("t,q\n0,0\n"), std::string(500, 'x')}) {
    EXPECT_THROW((void)read_back(bytes, said), Error);
  }
  EXPECT_THROW((void)read(path_ / "nowhere.mcap", {}), Error);
  EXPECT_THROW((void)read(path_, {}), Error);
}

}  // namespace
}  // namespace vicinity::mcap

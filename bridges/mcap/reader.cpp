// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "mcap/reader.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>

#include "mcap/crc32.h"
#include "vicinity/geometry/error.h"

namespace vicinity::mcap {
namespace {

// No recorder makes chunks as large; a header that lies would have us fill the memory [bytes].
constexpr std::uint64_t largest_chunk = std::uint64_t{1} << 30;

// Thrown where the bytes make no sense any more: a cut, or damage.
struct Broken {
  std::string what;
};

// One way of packing we do not know is no damage.
struct UnknownCompression {
  std::string name;
};

class File {
 public:
  explicit File(const std::filesystem::path& path) : stream_(path, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(path, error);
    if (error || !stream_) {
      throw Error({.where = path.string(), .what = "the recording cannot be read"});
    }
  }

  std::uint64_t size() const noexcept { return size_; }
  std::uint64_t at() const noexcept { return at_; }
  std::uint64_t left() const noexcept { return size_ - at_; }

  // @param bytes  out; its memory is used again
  void read(std::uint64_t count, std::string& bytes) {
    if (count > left()) throw Broken{"a record goes beyond the end of the file"};
    bytes.resize(count);
    stream_.read(bytes.data(), static_cast<std::streamsize>(count));
    if (!stream_) throw Broken{"the file became shorter while it was read"};
    at_ += count;
    crc_ = crc32(bytes, crc_);
  }
  // Takes them into the checksum alone.
  void pass(std::uint64_t count) {
    if (count > left()) throw Broken{"a record goes beyond the end of the file"};
    for (std::string piece; count > 0; count -= piece.size()) {
      read(std::min<std::uint64_t>(count, 1 << 16), piece);
    }
  }
  void go_to(std::uint64_t place) {
    at_ = place;
    crc_ = 0;
    stream_.seekg(static_cast<std::streamoff>(place));
  }
  // Of all that was read since the last go_to().
  std::uint32_t crc() const noexcept { return crc_; }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0, at_ = 0;
  std::uint32_t crc_ = 0;
};

bool has_its_end(File& file) {
  constexpr std::size_t end = record_head + footer_body + magic.size();
  if (file.size() < magic.size() + end) return false;
  std::string bytes;
  file.go_to(file.size() - end);
  file.read(end, bytes);
  file.go_to(0);
  FieldReader fields(bytes);
  return fields.u8() == static_cast<std::uint8_t>(Opcode::footer) && fields.u64() == footer_body &&
         bytes.ends_with(magic);
}

std::string unpacked(std::string_view compression, std::string_view packed, std::uint64_t size) {
  if (compression.empty()) {
    if (packed.size() != size) throw Broken{"a chunk is not as long as it says"};
    return std::string(packed);
  }
  // A cut that left zeros behind leaves half a name.
  if (compression.find('\0') != std::string_view::npos) throw Broken{"a chunk is not whole"};
  if (compression != "zstd") throw UnknownCompression{std::string(compression)};
  if (size > largest_chunk) throw Broken{"a chunk says that it is larger than 1 GB"};
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  // Memory grows with what really comes out, not with what was promised. One byte more than was
  // promised shows what is too long.
  const std::uint64_t most = size + 1;
  std::string bytes(std::min<std::uint64_t>(most, 1 << 16), '\0');
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  ZSTD_outBuffer out{bytes.data(), bytes.size(), 0};
  for (std::size_t more = 1; more != 0;) {
    more = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(more) != 0) throw Broken{"a chunk cannot be decompressed"};
    if (more == 0) break;
    if (out.pos < out.size) throw Broken{"a chunk ends too soon"};
    if (bytes.size() == most) throw Broken{"a chunk is longer than it says"};
    bytes.resize(std::min<std::uint64_t>(most, 2 * bytes.size()));
    out = {bytes.data(), bytes.size(), out.pos};
  }
  if (out.pos != size || in.pos != in.size) throw Broken{"a chunk is not as long as it says"};
  bytes.resize(size);
  return bytes;
}

class Records {
 public:
  explicit Records(const MessageHandler& handler) : handler_(handler) {}

  // One record of the data section, or of a chunk.
  void take(std::uint8_t opcode, std::string_view body, bool in_chunk) {
    switch (static_cast<Opcode>(opcode)) {
      case Opcode::schema:
        return take_schema(FieldReader(body));
      case Opcode::channel:
        return take_channel(FieldReader(body));
      case Opcode::message:
        return take_message(FieldReader(body));
      case Opcode::chunk:
        if (in_chunk) throw Broken{"a chunk is in a chunk"};
        return take_chunk(FieldReader(body));
      default:
        return;  // indexes, attachments, and what later versions may bring
    }
  }

 private:
  void take_schema(FieldReader fields) {
    Schema schema;
    schema.id = fields.u16();
    schema.name = fields.text();
    schema.encoding = fields.text();
    schema.data = fields.text();
    if (!fields.ok()) throw Broken{"a schema ends too soon"};
    if (schema.id == 0) return;
    const auto [known, is_new] = schemas_.try_emplace(schema.id, schema);
    if (!is_new && known->second != schema) throw Broken{"two schemas have one number"};
  }

  void take_channel(FieldReader fields) {
    Channel channel;
    channel.id = fields.u16();
    channel.schema_id = fields.u16();
    channel.topic = fields.text();
    channel.message_encoding = fields.text();
    if (!fields.ok()) throw Broken{"a channel ends too soon"};
    if (channel.schema_id != 0 && !schemas_.contains(channel.schema_id)) {
      throw Broken{"a channel has a schema that is not there"};
    }
    const auto [known, is_new] = channels_.try_emplace(channel.id, channel);
    if (!is_new && known->second != channel) throw Broken{"two channels have one number"};
  }

  void take_message(FieldReader fields) {
    const std::uint16_t id = fields.u16();
    Message message;
    message.sequence = fields.u32();
    message.log_time_ns = fields.u64();
    message.publish_time_ns = fields.u64();
    if (!fields.ok()) throw Broken{"a message ends too soon"};
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) throw Broken{"a message has a channel that is not there"};
    message.data = std::as_bytes(std::span(fields.left()));
    const auto schema = schemas_.find(channel->second.schema_id);
    static const Schema unknown;
    handler_(schema == schemas_.end() ? unknown : schema->second, channel->second, message);
  }

  void take_chunk(FieldReader fields) {
    fields.u64();  // first and last time
    fields.u64();
    const std::uint64_t size = fields.u64();
    const std::uint32_t crc = fields.u32();
    const std::string_view compression = fields.text();
    const std::string_view packed = fields.take(fields.u64());
    if (!fields.ok()) throw Broken{"a chunk ends too soon"};
    const std::string records = unpacked(compression, packed, size);
    if (crc != 0 && crc32(records) != crc) throw Broken{"a chunk does not match its checksum"};
    for (FieldReader inside(records); !inside.left().empty();) {
      const std::uint8_t opcode = inside.u8();
      const std::string_view body = inside.take(inside.u64());
      if (!inside.ok()) throw Broken{"a record goes beyond the end of its chunk"};
      take(opcode, body, true);
    }
  }

  const MessageHandler& handler_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

// Up to the end of the data section. @param good  out: the end of the last record that was taken
void read_data(File& file, Records& records, std::uint64_t& good) {
  std::string head, body;
  for (;;) {
    const std::uint32_t crc = file.crc();
    file.read(record_head, head);
    FieldReader fields(head);
    const std::uint8_t opcode = fields.u8();
    const std::uint64_t length = fields.u64();
    if (opcode == 0) throw Broken{"a record is of no kind"};
    if (opcode == static_cast<std::uint8_t>(Opcode::data_end)) {
      file.read(length, body);
      const std::uint32_t stated = FieldReader(body).u32();
      if (stated != 0 && stated != crc) throw Broken{"its bytes do not match their checksum"};
      return;
    }
    if (opcode == static_cast<std::uint8_t>(Opcode::footer)) {
      throw Broken{"the data section has no end"};
    }
    const bool wanted = opcode >= static_cast<std::uint8_t>(Opcode::schema) &&
                        opcode <= static_cast<std::uint8_t>(Opcode::chunk);
    if (wanted) {
      file.read(length, body);
      records.take(opcode, body, false);
    } else {
      file.pass(length);
    }
    good = file.at();
  }
}

}  // namespace

Ending read(const std::filesystem::path& path, const MessageHandler& handler) {
  File file(path);
  Ending ending{.whole = true, .used = file.size(), .file_size = file.size()};
  const bool finished = has_its_end(file);
  file.go_to(0);
  std::uint64_t good = 0;
  try {
    std::string start;
    file.read(std::min<std::uint64_t>(magic.size(), file.size()), start);
    if (start != magic) {
      throw Error({.where = path.string(),
                   .what = "not an MCAP recording of version 0: it does not begin as one"});
    }
    good = file.at();
    Records records(handler);
    read_data(file, records, good);
    if (!finished) throw Broken{"the summary was not written"};
  } catch (const Broken& broken) {
    if (finished) {
      throw Error(
          {.where = path.string(),
           .what = fmt::format("the recording is damaged behind byte {}: {}", good, broken.what),
           .hint = "another copy of it"});
    }
    ending = {.whole = false, .used = good, .file_size = file.size(), .why = broken.what};
  } catch (const UnknownCompression& unknown) {
    throw Error({.where = path.string(),
                 .what = "the recording is compressed in a way that is not read here",
                 .found = "'" + unknown.name + "'",
                 .expected = "zstd, or no compression",
                 .hint = "mcap compress --compression zstd"});
  }
  return ending;
}

}  // namespace vicinity::mcap

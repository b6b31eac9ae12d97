// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "dds/cdr_type.h"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_radmin.h>

#include <cstdio>
#include <cstring>
#include <new>

namespace vicinity::dds {
namespace {

// The protocol pads to this.
constexpr std::size_t word = 4;

// Cyclone counts references to it and hands it round.
struct Data : ddsi_serdata {
  Sample bytes;          // padded with zeros to a whole word: the protocol sends those too
  std::size_t size = 0;  // without the padding

  void set(const std::byte* begin, std::size_t count) {
    bytes.reserve((count + word - 1) / word * word);
    bytes.assign(begin, begin + count);
    pad();
  }
  void pad() {
    size = bytes.size();
    bytes.resize((size + word - 1) / word * word);
  }
};

const Data& data_of(const ddsi_serdata* serdata) { return *static_cast<const Data*>(serdata); }
Sample& sample_of(void* sample) { return *static_cast<Sample*>(sample); }

// Without a key every sample is of the same instance.
Data* new_data(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto* data = new (std::nothrow) Data{};
  if (data == nullptr) return nullptr;
  ddsi_serdata_init(data, type, kind);
  data->hash = type->serdata_basehash;
  return data;
}

bool same_key(const ddsi_serdata*, const ddsi_serdata*) { return true; }

std::uint32_t size_of(const ddsi_serdata* serdata) {
  return static_cast<std::uint32_t>(data_of(serdata).size);
}

// What came over the network, in pieces that may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  Data* data = new_data(type, kind);
  if (data == nullptr || kind != SDK_DATA) return data;
  data->bytes.resize(size);
  std::uint32_t at = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= at || fragment->maxp1 > size) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(&data->bytes[at], payload + at - fragment->min, fragment->maxp1 - at);
    at = fragment->maxp1;
  }
  data->pad();
  return data;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  Data* data = new_data(type, kind);
  if (data == nullptr || kind != SDK_DATA) return data;
  data->bytes.reserve(size);
  for (ddsrt_msg_iovlen_t n = 0; n < count && data->bytes.size() < size; ++n) {
    const auto* begin = static_cast<const std::byte*>(pieces[n].iov_base);
    data->bytes.insert(data->bytes.end(), begin, begin + pieces[n].iov_len);
  }
  data->bytes.resize(size);
  data->pad();
  return data;
}

ddsi_serdata* from_keyhash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return new_data(type, SDK_KEY);
}

ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  Data* data = new_data(type, kind);
  if (data == nullptr || kind != SDK_DATA) return data;
  const Sample& bytes = *static_cast<const Sample*>(sample);
  data->set(bytes.data(), bytes.size());
  return data;
}

void to_buffer(const ddsi_serdata* serdata, std::size_t offset, std::size_t size, void* buffer) {
  std::memcpy(buffer, data_of(serdata).bytes.data() + offset, size);
}

ddsi_serdata* lend(const ddsi_serdata* serdata, std::size_t offset, std::size_t size,
                   ddsrt_iovec_t* piece) {
  auto* data = const_cast<Data*>(&data_of(serdata));
  piece->iov_base = data->bytes.data() + offset;
  piece->iov_len = size;
  return ddsi_serdata_ref(serdata);
}

void take_back(ddsi_serdata* serdata, const ddsrt_iovec_t*) { ddsi_serdata_unref(serdata); }

bool to_sample(const ddsi_serdata* serdata, void* sample, void**, void*) {
  const Data& data = data_of(serdata);
  sample_of(sample).assign(data.bytes.begin(),
                           data.bytes.begin() + static_cast<std::ptrdiff_t>(data.size));
  return true;
}

ddsi_serdata* to_untyped(const ddsi_serdata* serdata) {
  Data* key = new_data(serdata->type, SDK_KEY);
  if (key != nullptr) key->type = nullptr;
  return key;
}

bool untyped_to_sample(const ddsi_sertype*, const ddsi_serdata*, void* sample, void**, void*) {
  sample_of(sample).clear();
  return true;
}

void free_data(ddsi_serdata* serdata) { delete static_cast<Data*>(serdata); }

std::size_t print(const ddsi_sertype*, const ddsi_serdata* serdata, char* text, std::size_t size) {
  return static_cast<std::size_t>(std::snprintf(text, size, "(%u bytes)", size_of(serdata)));
}

void get_keyhash(const ddsi_serdata*, ddsi_keyhash* keyhash, bool) { *keyhash = {}; }

const ddsi_serdata_ops data_operations = [] {
  ddsi_serdata_ops ops{};
  ops.eqkey = same_key;
  ops.get_size = size_of;
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_pieces;
  ops.from_keyhash = from_keyhash;
  ops.from_sample = from_sample;
  ops.to_ser = to_buffer;
  ops.to_ser_ref = lend;
  ops.to_ser_unref = take_back;
  ops.to_sample = to_sample;
  ops.to_untyped = to_untyped;
  ops.untyped_to_sample = untyped_to_sample;
  ops.free = free_data;
  ops.print = print;
  ops.get_keyhash = get_keyhash;
  return ops;
}();

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}

void zero_samples(const ddsi_sertype*, void* samples, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) static_cast<Sample*>(samples)[n].clear();
}

// Nobody borrows samples from Cyclone: readers bring their own.
void realloc_samples(void** samples, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
  for (std::size_t n = 0; n < count; ++n) samples[n] = nullptr;
}
void free_samples(const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {}

// Types with one name and these operations are the same.
bool same_type(const ddsi_sertype*, const ddsi_sertype*) { return true; }
std::uint32_t type_hash(const ddsi_sertype*) { return 0; }

const ddsi_sertype_ops type_operations = [] {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = free_type;
  ops.zero_samples = zero_samples;
  ops.realloc_samples = realloc_samples;
  ops.free_samples = free_samples;
  ops.equal = same_type;
  ops.hash = type_hash;
  return ops;
}();

}  // namespace

ddsi_sertype* new_cdr_type(const std::string& dds_type_name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init(type, dds_type_name.c_str(), &type_operations, &data_operations, true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

}  // namespace vicinity::dds

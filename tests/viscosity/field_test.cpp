// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/field.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "dense_field.h"
#include "seeds.h"
#include "vicinity/geometry/error.h"
#include "vicinity/layers/distance_layers.h"
#include "vicinity/viscosity/field_image.h"

namespace vicinity {
namespace {

using test::DenseField;
using test::for_each_seed;
using test::real;
using test::whole;

/// The bytes of an image in memory of just their size, so that a sanitizer sees any step outside.
std::vector<std::byte> bytes_of(const ViscosityField& field) {
  return {field.image().begin(), field.image().end()};
}

ViscosityField field_of(const std::vector<std::byte>& bytes) {
  const std::shared_ptr<std::byte[]> copy(new std::byte[bytes.size()]);
  std::copy(bytes.begin(), bytes.end(), copy.get());
  return ViscosityField::from_image(copy, bytes.size(), "test");
}

bool is_refused(const std::vector<std::byte>& bytes) {
  try {
    field_of(bytes);
    return false;
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("test: "), std::string::npos) << e.what();
    return true;
  }
}

FieldHeader header_of(const std::vector<std::byte>& bytes) {
  FieldHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

/// Makes all checksums right again, as whoever forges a field would.
void sign(std::vector<std::byte>& bytes) {
  FieldHeader header = header_of(bytes);
  for (std::size_t s = 0; s < std::min<std::size_t>(header.section_count, 8); ++s) {
    FieldSection& section = header.sections[s];
    if (section.offset > bytes.size() || section.size > bytes.size() - section.offset) continue;
    section.checksum = checksum_of(std::span(bytes).subspan(section.offset, section.size));
  }
  header.checksum = 0;
  header.checksum = checksum_of(std::as_bytes(std::span(&header, 1)));
  std::memcpy(bytes.data(), &header, sizeof(header));
}

TEST(Field, EveryVoxelIsThatOfThePlainArray) {
  for_each_seed(12, [](std::mt19937& random) {
    const DenseField dense = DenseField::random(random, whole(random, 0, 1) == 1);
    const ViscosityField field = dense.sparse();
    const VoxelIndex dims = dense.workspace.dims;
    std::size_t wrong = 0;
    for (std::int32_t k = 0; k < dims.k; ++k) {
      for (std::int32_t j = 0; j < dims.j; ++j) {
        for (std::int32_t i = 0; i < dims.i; ++i) {
          const std::size_t at = dense.at({i, j, k});
          wrong += field.code_at({i, j, k}) != dense.codes[at];
          const bool kept = !dense.steps.empty() && dense.steps[at] != no_distance;
          wrong += field.distance_vox_at({i, j, k}) != (kept ? dense.steps[at] / 128.0 : -1.0);
        }
      }
    }
    EXPECT_EQ(wrong, 0u);
  });
}

TEST(Field, OutsideTheWorkspaceAndWithoutAPositionAllIsEmpty) {
  std::mt19937 random(1);
  const ViscosityField field = DenseField::random(random, true).sparse();
  const VoxelIndex dims = field.workspace().dims;
  constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  for (const std::int32_t x : {least, -1, dims.i, most}) EXPECT_EQ(field.code_at({x, 0, 0}), 0);
  for (const std::int32_t y : {least, -1, dims.j, most}) EXPECT_EQ(field.code_at({0, y, 0}), 0);
  for (const std::int32_t z : {least, -1, dims.k, most}) EXPECT_EQ(field.code_at({0, 0, z}), 0);
  for (const double x : {std::numeric_limits<double>::quiet_NaN(),
                         std::numeric_limits<double>::infinity(), -1e300, 1e300, -1e6}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p = field.workspace().centre_of({0, 0, 0});
      p[axis] = x;
      const FieldSample sample = field.at(p);
      EXPECT_EQ(sample.record.kind, VoxelKind::empty);
      EXPECT_EQ(sample.viscosity, 0);
      EXPECT_LT(sample.distance_m, 0);
    }
  }
}

TEST(Field, ManyLookupsAtOnceAreThoseOneByOne) {
  for_each_seed(4, [](std::mt19937& random) {
    const DenseField dense = DenseField::random(random, false);
    const ViscosityField field = dense.sparse();
    const VoxelIndex dims = dense.workspace.dims;
    for (const std::size_t count : {0, 1, 63, 64, 65, 1000}) {
      std::vector<VoxelIndex> voxels(count);
      std::vector<VoxelCode> codes(count + 1, 0xABCD), expected;
      for (VoxelIndex& v : voxels) {
        v = {whole(random, -2, dims.i + 1), whole(random, -2, dims.j + 1),
             whole(random, -2, dims.k + 1)};
        const bool held = dense.workspace.box().contains(v);
        expected.push_back(held ? dense.codes[dense.at(v)] : VoxelCode{0});
      }
      expected.push_back(0xABCD);  // and not one more
      field.codes_at(voxels, codes);
      EXPECT_EQ(codes, expected);
    }
  });
}

TEST(Field, RankedObjectsAreSampledAsTheVoxelThatHoldsThePoint) {
  for_each_seed(4, [](std::mt19937& random) {
    const DenseField dense = DenseField::random(random, false);
    const ViscosityField field = dense.sparse();
    for (int n = 0; n < 2000; ++n) {
      const Vec3 grid(real(random, 0, dense.workspace.dims.i),
                      real(random, 0, dense.workspace.dims.j),
                      real(random, 0, dense.workspace.dims.k));
      const Vec3 p = dense.workspace.origin + dense.workspace.voxel_size * grid;
      const VoxelIndex v = dense.workspace.index_of(p);
      if (!dense.workspace.box().contains(v)) continue;
      const FieldSample sample = field.at(p);
      const VoxelCode code = dense.codes[dense.at(v)];
      EXPECT_EQ(sample.record.kind, field.records()[code].kind);
      EXPECT_EQ(sample.record.rank, field.records()[code].rank);
      EXPECT_EQ(sample.record.object, field.records()[code].object);
      EXPECT_EQ(sample.viscosity, field.viscosities()[code]);
      EXPECT_LT(sample.distance_m, 0);
    }
  });
}

TEST(Field, RecordsFollowTheObjects) {
  std::mt19937 random(3);
  const DenseField dense = DenseField::random(random, true);
  const ViscosityField field = dense.sparse();
  std::size_t code = 1;
  for (std::size_t o = 0; o < dense.objects.size(); ++o) {
    const FieldObject& object = dense.objects[o];
    EXPECT_EQ(field.objects()[o].name, object.name);
    EXPECT_EQ(field.objects()[o].coding.mu, object.coding.mu);
    EXPECT_EQ(field.objects()[o].ranks, object.ranks);
    EXPECT_EQ(field.records()[code].kind, VoxelKind::boundary);
    EXPECT_EQ(field.viscosities()[code++], object.coding.skin);
    EXPECT_EQ(field.records()[code].kind, VoxelKind::inner);
    EXPECT_EQ(field.viscosities()[code++], object.coding.skin);
    for (int n = 1; n <= object.q; ++n, ++code) {
      EXPECT_EQ(field.records()[code].kind, VoxelKind::neighbour);
      EXPECT_EQ(field.records()[code].rank, n);
      EXPECT_EQ(field.records()[code].object, o);
      EXPECT_EQ(field.viscosities()[code], object.coding.of_rank(n));
    }
  }
  EXPECT_EQ(field.records().size(), code);
  EXPECT_EQ(field.voxel_counts().boundary, 1u);
  EXPECT_EQ(field.voxel_counts().neighbour, 3u);
}

TEST(Field, MoreCodesThan16BitsHoldAreAnError) {
  std::vector<FieldObject> objects(1928);
  for (std::size_t o = 0; o < objects.size(); ++o) {
    objects[o].name = std::to_string(o);
    objects[o].q = 32;
    objects[o].coding.mu.resize(32);
    objects[o].ranks.resize(32);
  }
  EXPECT_THROW(FieldWriter(Workspace{{}, 1, {1, 1, 1}}, objects), Error);
  objects.pop_back();
  EXPECT_NO_THROW(FieldWriter(Workspace{Vec3::Zero(), 1, {1, 1, 1}}, objects));
}

TEST(Field, OtherCodingsChangeViscositiesAndNothingElse) {
  std::mt19937 random(5);
  const ViscosityField field = DenseField::random(random, true).sparse();
  std::vector<Coding> codings;
  for (const FieldObject& object : field.objects()) {
    codings.push_back(named_coding("jnd", object.q));
    codings.back().skin = 77;
  }
  const ViscosityField other = field.with_codings(codings);
  EXPECT_EQ(other.image().data(), field.image().data());
  for (std::size_t code = 1; code < field.records().size(); ++code) {
    const VoxelRecord& record = field.records()[code];
    EXPECT_EQ(other.viscosities()[code], record.kind == VoxelKind::neighbour
                                             ? codings[record.object].of_rank(record.rank)
                                             : 77);
  }
  codings.pop_back();
  EXPECT_THROW(field.with_codings(codings), Error);
  codings.push_back({{}, -1});
  EXPECT_THROW(field.with_codings(codings), Error);
}

TEST(FieldImage, SurvivesACopy) {
  for_each_seed(6, [](std::mt19937& random) {
    const ViscosityField field = DenseField::random(random, whole(random, 0, 1) == 1).sparse();
    const ViscosityField copy = field_of(bytes_of(field));
    EXPECT_TRUE(std::ranges::equal(copy.image(), field.image()));
    EXPECT_TRUE(std::ranges::equal(copy.viscosities(), field.viscosities()));
  });
}

TEST(FieldImage, EqualBricksAndRegionsAreStoredOnce) {
  std::mt19937 random(6);
  DenseField dense = DenseField::random(random, true);
  dense.workspace.dims = {256, 128, 64};
  dense.codes.assign(256 * 128 * 64, 0);
  dense.steps.assign(256 * 128 * 64, no_distance);
  for (std::int32_t k = 0; k < 64; ++k) {
    for (std::int32_t j = 0; j < 128; ++j) {
      for (std::int32_t i = 0; i < 256; ++i) {
        if (k % 8 == 3) dense.codes[dense.at({i, j, k})] = 1;
        if (k % 8 == 5) dense.steps[dense.at({i, j, k})] = 9;
      }
    }
  }
  const FieldHeader header = header_of(bytes_of(dense.sparse()));
  EXPECT_EQ(header.sections[3].size, 2048u);
  EXPECT_EQ(header.sections[4].size, 72u);
  EXPECT_EQ(header.sections[6].size, 2048u);
  EXPECT_EQ(header.sections[7].size, 1024u);
}

TEST(FieldImage, OneWrongBitAnywhereIsRefused) {
  for_each_seed(2, [](std::mt19937& random) {
    const std::vector<std::byte> whole_image =
        bytes_of(DenseField::random(random, whole(random, 0, 1) == 1).sparse());
    const FieldHeader header = header_of(whole_image);
    std::vector<std::size_t> places;
    for (std::size_t at = 0; at < sizeof(FieldHeader); ++at) places.push_back(at);
    for (std::size_t s = 0; s < header.section_count; ++s) {
      const FieldSection& section = header.sections[s];
      if (section.size == 0) continue;
      for (int n = 0; n < 10; ++n) {
        places.push_back(section.offset + random() % section.size);
      }
      places.push_back(section.offset + section.size - 1);
      // And the padding before it.
      if (section.offset > 0) places.push_back(section.offset - 1);
    }
    for (const std::size_t at : places) {
      std::vector<std::byte> image = whole_image;
      image[at] ^= std::byte{1} << (random() % 8);
      EXPECT_TRUE(is_refused(image)) << "byte " << at;
    }
  });
}

TEST(FieldImage, CutShortOrLengthenedAnywhereIsRefused) {
  std::mt19937 random(2);
  const std::vector<std::byte> image = bytes_of(DenseField::random(random, true).sparse());
  for (std::size_t size = 0; size < 400; ++size) {
    EXPECT_TRUE(is_refused({image.begin(), image.begin() + size})) << size << " bytes";
  }
  for (int n = 0; n < 60; ++n) {
    const std::size_t size = random() % image.size();
    std::vector<std::byte> cut(image.begin(), image.begin() + size);
    EXPECT_TRUE(is_refused(cut)) << size << " bytes";
    // Filled up with zeros, as a disk may after a crash.
    if (std::all_of(image.begin() + size, image.end(),
                    [](std::byte b) { return b == std::byte{}; }))
      continue;
    cut.resize(image.size());
    EXPECT_TRUE(is_refused(cut)) << size << " bytes and zeros";
  }
  std::vector<std::byte> longer = image;
  longer.push_back({});
  EXPECT_TRUE(is_refused(longer));
}

TEST(FieldImage, AnotherVersionAndAnotherFileAreNamed) {
  std::mt19937 random(4);
  std::vector<std::byte> image = bytes_of(DenseField::random(random, false).sparse());
  FieldHeader header = header_of(image);
  header.version = 2;
  std::memcpy(image.data(), &header, sizeof(header));
  sign(image);
  try {
    field_of(image);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.parts().found, "version 2");
  }
  std::fill(image.begin(), image.begin() + 8, std::byte{'x'});
  try {
    field_of(image);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.parts().what, "not a viscosity field");
  }
}

/// Looks everywhere; a sanitizer, and the codes that come back, tell whether all stayed within.
void look_everywhere(const ViscosityField& field, std::mt19937& random) {
  const VoxelIndex dims = field.workspace().dims;
  for (int n = 0; n < 3000; ++n) {
    const VoxelIndex v = {whole(random, 0, dims.i - 1), whole(random, 0, dims.j - 1),
                          whole(random, 0, dims.k - 1)};
    ASSERT_LT(field.code_at(v), field.records().size());
    field.distance_vox_at(v);
    field.at(field.workspace().centre_of(v) +
             field.workspace().voxel_size *
                 Vec3(real(random, -1, 1), real(random, -1, 1), real(random, -1, 1)));
  }
}

TEST(FieldImage, AForgedReferenceIsRefusedOrHarmless) {
  for_each_seed(3, [](std::mt19937& random) {
    const std::vector<std::byte> image = bytes_of(DenseField::random(random, true).sparse());
    const FieldHeader header = header_of(image);
    int refused = 0;
    constexpr int forgeries = 150;
    for (int n = 0; n < forgeries; ++n) {
      std::vector<std::byte> forged = image;
      constexpr std::array<std::size_t, 4> references = {2, 3, 5, 6};  // ROOT, REGIONS, and again
      const FieldSection& section = header.sections[references[random() % 4]];
      if (section.size == 0) continue;
      const std::size_t at = section.offset + random() % (section.size / 4) * 4;
      std::uint32_t reference;
      std::memcpy(&reference, forged.data() + at, 4);
      const std::uint32_t now = reference;
      switch (random() % 5) {
        case 0:
          reference = static_cast<std::uint32_t>(random());
          break;
        case 1:
          reference += static_cast<std::uint32_t>(random() % 64);
          break;
        case 2:
          reference = 0x7FFFFFFF;
          break;
        case 3:
          reference ^= std::uint32_t{1} << (random() % 32);
          break;
        default:
          reference = FieldReference::uniform(static_cast<std::uint16_t>(random()));
      }
      std::memcpy(forged.data() + at, &reference, 4);
      sign(forged);
      try {
        look_everywhere(field_of(forged), random);
      } catch (const Error&) {
        refused += reference != now;
      }
    }
    EXPECT_GT(refused, forgeries / 4);
  });
}

TEST(FieldImage, AnyForgedByteIsRefusedOrHarmless) {
  for_each_seed(2, [](std::mt19937& random) {
    const std::vector<std::byte> image = bytes_of(DenseField::random(random, true).sparse());
    const FieldHeader header = header_of(image);
    for (int n = 0; n < 300; ++n) {
      std::vector<std::byte> forged = image;
      const std::size_t s = random() % 9;
      const std::size_t offset = s == 8 ? 0 : header.sections[s].offset;
      const std::size_t size = s == 8 ? sizeof(FieldHeader) : header.sections[s].size;
      if (size == 0) continue;
      for (std::size_t edits = 1 + random() % 3; edits > 0; --edits) {
        forged[offset + random() % size] = static_cast<std::byte>(random());
      }
      sign(forged);
      try {
        look_everywhere(field_of(forged), random);
      } catch (const Error&) {
      }
    }
  });
}

TEST(FieldImage, HugeSizesInADescriptionDoNotAllocate) {
  std::mt19937 random(9);
  const std::vector<std::byte> image = bytes_of(DenseField::random(random, false).sparse());
  const FieldHeader header = header_of(image);
  std::string meta(reinterpret_cast<const char*>(image.data()) + header.sections[0].offset,
                   header.sections[0].size);
  const std::size_t at = meta.find("\"dims\":[") + 8;
  const std::size_t end = meta.find(']', at);
  for (const std::string dims : {"1048576,1048576,1048576", "0,1,1", "-1,1,1", "1e9,1,1", "9,9"}) {
    std::string forged_meta = meta;
    forged_meta.replace(at, end - at, dims);
    std::vector<std::byte> forged(image.begin(), image.begin() + sizeof(FieldHeader));
    FieldHeader forged_header = header;
    forged_header.sections[0].size = forged_meta.size();
    for (std::size_t s = 0; s < header.section_count; ++s) {
      forged.resize((forged.size() + 63) & ~std::size_t{63});
      forged_header.sections[s].offset = forged.size();
      const auto* first = s == 0 ? reinterpret_cast<const std::byte*>(forged_meta.data())
                                 : image.data() + header.sections[s].offset;
      forged.insert(forged.end(), first, first + forged_header.sections[s].size);
    }
    forged_header.image_size = forged.size();
    std::memcpy(forged.data(), &forged_header, sizeof(forged_header));
    sign(forged);
    EXPECT_TRUE(is_refused(forged)) << dims;
  }
}

}  // namespace
}  // namespace vicinity

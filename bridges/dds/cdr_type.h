// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A type whose samples Cyclone DDS takes and gives as the bytes they are.
///
/// So one serializer (ros2/cdr.h) serves recordings and the wire, and no code is generated.
#pragma once

#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vicinity::dds {

/// What dds_write() and dds_take() get a pointer to: XCDR1 with its four bytes of byte order.
using Sample = std::vector<std::byte>;

/// A type without key. One reference, for dds_create_topic_sertype() to take over.
ddsi_sertype* new_cdr_type(const std::string& dds_type_name);

}  // namespace vicinity::dds

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The part of XML that robot descriptions use: nested elements with attributes.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vicinity {

struct XmlElement {
  std::string name;
  int line = 0;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;

  /// Value of an attribute; null where there is none.
  const std::string* attribute(std::string_view wanted) const noexcept;
  /// First child of that name; null where there is none.
  const XmlElement* child(std::string_view wanted) const noexcept;
};

/// Reads a document and returns its root, elements and attributes only. Entities of a document type
/// are never expanded.
///
/// Why not through urdfdom: it gives up at the first oddity, forgets lines and the order of joints,
/// and prints.
///
/// @param where  begins every error sentence, as "where:line"
/// Errors: throws Error for what is not well-formed, or nests deeper than 100 elements.
XmlElement parse_xml(std::string_view text, const std::string& where);

}  // namespace vicinity

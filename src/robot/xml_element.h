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

/// Reads a document and returns its root. Text between elements is skipped, comments and document
/// types too; entities of a document type are never expanded. Works without recursion.
///
/// Why not the parser that comes with urdfdom: that one recurses once for each level of nesting and
/// is brought down by a file that nests deep enough, and urdfdom itself gives up at the first
/// oddity, forgets lines and the order of joints, and prints.
///
/// @param where  begins every error sentence, as "where:line"
/// Errors: throws Error for what is not well-formed, or nests deeper than 100 elements.
XmlElement parse_xml(std::string_view text, const std::string& where);

}  // namespace vicinity

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "xml_element.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <pugixml.hpp>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr int deepest = 100;

class Converter {
 public:
  Converter(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  [[noreturn]] void refuse(std::ptrdiff_t offset, const std::string& what) const {
    throw Error({.where = fmt::format("{}:{}", where_, line_at(offset)),
                 .what = "not well-formed XML: " + what});
  }

  // Depth is bounded, so that recursion is.
  XmlElement element(const pugi::xml_node& node, int depth) {
    if (depth > deepest) {
      refuse(node.offset_debug(), fmt::format("nested deeper than {} elements", deepest));
    }
    XmlElement element;
    element.name = node.name();
    element.line = line_at(node.offset_debug());
    for (const pugi::xml_attribute& attribute : node.attributes()) {
      element.attributes.emplace_back(attribute.name(), attribute.value());
    }
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_element) {
        element.children.push_back(this->element(child, depth + 1));
      }
    }
    return element;
  }

 private:
  // Elements are met in the order of the text: lines are counted once.
  int line_at(std::ptrdiff_t offset) const {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, std::ssize(text_));
    if (end < counted_) {
      counted_ = text_.begin();
      line_ = 1;
    }
    line_ += static_cast<int>(std::count(counted_, end, '\n'));
    counted_ = end;
    return line_;
  }

  std::string_view text_;
  const std::string& where_;
  mutable std::string_view::const_iterator counted_ = text_.begin();
  mutable int line_ = 1;
};

}  // namespace

const std::string* XmlElement::attribute(std::string_view wanted) const noexcept {
  for (const auto& [attribute_name, value] : attributes) {
    if (attribute_name == wanted) return &value;
  }
  return nullptr;
}

const XmlElement* XmlElement::child(std::string_view wanted) const noexcept {
  for (const XmlElement& element : children) {
    if (element.name == wanted) return &element;
  }
  return nullptr;
}

XmlElement parse_xml(std::string_view text, const std::string& where) {
  Converter converter(text, where);
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) converter.refuse(result.offset, result.description());
  const pugi::xml_node root = document.document_element();
  if (!root) converter.refuse(0, "there is no element");
  for (pugi::xml_node next = root.next_sibling(); next; next = next.next_sibling()) {
    if (next.type() == pugi::node_element) {
      converter.refuse(next.offset_debug(),
                       fmt::format("a second root element, '{}'", next.name()));
    }
  }
  return converter.element(root, 1);
}

}  // namespace vicinity

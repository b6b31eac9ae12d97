// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "xml_element.h"

#include <fmt/core.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr std::size_t deepest = 100;
constexpr std::size_t most_attributes = 100;  // they are compared one with another

bool is_space(char c) noexcept { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Any byte that cannot mean something else, so that names in every language pass.
bool is_name(char c) noexcept {
  return !is_space(c) && static_cast<unsigned char>(c) > ' ' &&
         std::string_view("<>/=\"'&").find(c) == std::string_view::npos;
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto tail = [&](int shift) { text += static_cast<char>(0x80 | (code >> shift & 0x3f)); };
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xc0 | code >> 6);
    tail(0);
  } else if (code < 0x10000) {
    text += static_cast<char>(0xe0 | code >> 12);
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xf0 | code >> 18);
    tail(12);
    tail(6);
    tail(0);
  }
}

class XmlReader {
 public:
  XmlReader(std::string_view text, const std::string& where) : rest_(text), where_(where) {}

  XmlElement read() {
    skip("\xef\xbb\xbf");  // byte order mark
    for (;;) {
      // Text, which only matters in that there must be none outside the root.
      while (!rest_.empty() && rest_.front() != '<') {
        if (open_.empty() && !is_space(rest_.front())) refuse("text outside of any element");
        advance(1);
      }
      if (rest_.empty()) break;
      if (skip("<!--")) {
        skip_past("-->", "comment");
      } else if (skip("<![CDATA[")) {
        skip_past("]]>", "CDATA section");
      } else if (skip("<?")) {
        skip_past("?>", "processing instruction");
      } else if (skip("<!")) {
        skip_document_type();
      } else if (skip("</")) {
        read_end();
      } else {
        advance(1);
        read_start();
      }
    }
    if (!open_.empty()) refuse(fmt::format("element '{}' is not closed", open_.back().name));
    if (!root_) refuse("there is no element");
    return std::move(*root_);
  }

 private:
  [[noreturn]] void refuse(std::string what) const {
    throw Error({.where = fmt::format("{}:{}", where_, line_),
                 .what = "this is not well-formed XML: " + what});
  }

  void advance(std::size_t n) {
    for (const char c : rest_.substr(0, n)) line_ += c == '\n';
    rest_.remove_prefix(n);
  }

  bool skip(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    advance(token.size());
    return true;
  }

  void skip_past(std::string_view token, const char* what) {
    const std::size_t at = rest_.find(token);
    if (at == std::string_view::npos) refuse(fmt::format("{} without end", what));
    advance(at + token.size());
  }

  // Up to the > that matches, past the declarations in brackets.
  void skip_document_type() {
    for (int depth = 1; depth > 0; advance(1)) {
      if (rest_.empty()) refuse("document type without end");
      if (rest_.front() == '<') ++depth;
      if (rest_.front() == '>') --depth;
    }
  }

  void skip_space() {
    while (!rest_.empty() && is_space(rest_.front())) advance(1);
  }

  std::string read_name() {
    std::size_t size = 0;
    while (size < rest_.size() && is_name(rest_[size])) ++size;
    if (size == 0) refuse("a name is missing");
    std::string name(rest_.substr(0, size));
    advance(size);
    return name;
  }

  void read_start() {
    XmlElement element;
    element.line = line_;
    element.name = read_name();
    for (skip_space(); !rest_.empty() && is_name(rest_.front()); skip_space()) {
      std::string name = read_name();
      if (element.attributes.size() == most_attributes) {
        refuse(fmt::format("more than {} attributes", most_attributes));
      }
      skip_space();
      if (!skip("=")) refuse(fmt::format("attribute '{}' has no value", name));
      skip_space();
      if (element.attribute(name)) refuse(fmt::format("attribute '{}' is there twice", name));
      element.attributes.emplace_back(std::move(name), read_value());
    }
    const bool empty = skip("/");
    if (!skip(">")) refuse(fmt::format("the tag of element '{}' has no end", element.name));
    if (root_) refuse(fmt::format("a second root element, '{}'", element.name));
    if (open_.size() == deepest) refuse(fmt::format("nested deeper than {} elements", deepest));
    open_.push_back(std::move(element));
    if (empty) close();
  }

  void read_end() {
    const std::string name = read_name();
    skip_space();
    if (!skip(">")) refuse(fmt::format("the end tag of '{}' has no end", name));
    if (open_.empty()) refuse(fmt::format("'{}' ends without having begun", name));
    if (open_.back().name != name) {
      refuse(fmt::format("'{}' of line {} is closed by '{}'", open_.back().name, open_.back().line,
                         name));
    }
    close();
  }

  void close() {
    XmlElement closed = std::move(open_.back());
    open_.pop_back();
    if (open_.empty()) {
      root_ = std::move(closed);
    } else {
      open_.back().children.push_back(std::move(closed));
    }
  }

  std::string read_value() {
    const char quote = rest_.empty() ? '\0' : rest_.front();
    if (quote != '"' && quote != '\'') refuse("the value of an attribute is not in quotes");
    advance(1);
    const std::size_t size = rest_.find(quote);
    if (size == std::string_view::npos) refuse("the value of an attribute has no end");
    const std::string_view raw = rest_.substr(0, size);
    std::string value;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      if (raw[i] == '<') refuse("'<' in the value of an attribute");
      if (raw[i] != '&') {
        value += raw[i];
        continue;
      }
      const std::size_t end = raw.find(';', i);
      if (end == std::string_view::npos) refuse("'&' in the value of an attribute");
      append_entity(value, raw.substr(i + 1, end - i - 1));
      i = end;
    }
    advance(size + 1);
    return value;
  }

  void append_entity(std::string& value, std::string_view entity) const {
    constexpr std::pair<std::string_view, char> known[] = {
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
    for (const auto& [name, character] : known) {
      if (entity == name) {
        value += character;
        return;
      }
    }
    if (entity.starts_with('#')) {
      const bool hex = entity.starts_with("#x");
      const std::string_view digits = entity.substr(hex ? 2 : 1);
      std::uint32_t code = 0;
      const auto [end, error] =
          std::from_chars(digits.data(), digits.data() + digits.size(), code, hex ? 16 : 10);
      if (error == std::errc() && end == digits.data() + digits.size() && code > 0 &&
          code <= 0x10ffff) {
        append_utf8(value, code);
        return;
      }
    }
    refuse(fmt::format("unknown entity '&{};'", entity));
  }

  std::string_view rest_;
  const std::string& where_;
  int line_ = 1;
  std::vector<XmlElement> open_;  // from the root down
  std::optional<XmlElement> root_;
};

}  // namespace

const std::string* XmlElement::attribute(std::string_view wanted) const noexcept {
  for (const auto& [key, value] : attributes) {
    if (key == wanted) return &value;
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
  return XmlReader(text, where).read();
}

}  // namespace vicinity

// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "page.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string_view>

#include "fresh_file.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light; }
body { font: 17px/1.5 "DejaVu Sans", "Segoe UI", Helvetica, Arial, sans-serif; color: #1c2126;
       max-width: 62rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; background: #fff; }
h1 { font-size: 2rem; line-height: 1.2; margin: 0 0 .5rem; }
h2 { font-size: 1.3rem; margin: 3rem 0 .25rem; padding-top: .75rem; border-top: 2px solid #1c2126; }
h3 { font-size: 1rem; margin: 0 0 .5rem; }
p { margin: .25rem 0 1rem; max-width: 46rem; }
.lead { font-size: 1.1rem; color: #454d55; }
figure { margin: 2rem 0; break-inside: avoid; }
figure img { display: block; max-width: 100%; max-height: 44rem; border: 1px solid #d5dade; }
.two { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 0 1.5rem; }
.two figure { margin: 1rem 0 .5rem; }
figcaption { margin-top: .6rem; max-width: 46rem; }
pre { font: 14px/1.5 "DejaVu Sans Mono", Menlo, Consolas, monospace; background: #f3f5f6;
      padding: .6rem .8rem; margin: .6rem 0 0; white-space: pre-wrap; overflow-wrap: anywhere; }
table { border-collapse: collapse; font-size: .88rem; margin: 1rem 0; }
th, td { text-align: left; padding: .25rem 1.2rem .25rem 0; border-bottom: 1px solid #d5dade; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
td.short { white-space: nowrap; }
dl { display: grid; grid-template-columns: max-content minmax(0, 46rem); gap: .4rem 1.2rem;
     margin: 1rem 0; }
dt { color: #454d55; }
dd { margin: 0; }
dt.good, dt.bad { font-weight: bold; color: #0b6b43; }
dt.bad { color: #b03a00; }
.links { font-size: .88rem; }
@media screen { table { display: block; overflow-x: auto; } }
@media print {
  body { font-size: 10.5pt; max-width: none; padding: 0; }
  pre { font-size: 8.5pt; border: 1px solid #d5dade; }
  h2 { break-after: avoid; }
  figure img { max-height: 15cm; }
}
)";

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      group = group << 8 | (at + n < bytes.size() ? static_cast<unsigned char>(bytes[at + n]) : 0u);
    }
    for (std::size_t n = 0; n < 4; ++n) {
      text += at + n <= bytes.size() ? digits[group >> (18 - 6 * n) & 63] : '=';
    }
  }
  return text;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error({.where = path.string(), .what = "cannot be read back"});
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string figure(const PagePicture& picture) {
  return "<figure>\n<h3>" + escaped(picture.title) + "</h3>\n<img alt=\"" + escaped(picture.title) +
         "\" src=\"data:image/" + (picture.file.extension() == ".svg" ? "svg+xml" : "png") +
         ";base64," + base64(bytes_of(picture.file)) + "\">\n<figcaption>" + escaped(picture.says) +
         (picture.command.empty() ? "" : "\n<pre>" + escaped(picture.command) + "</pre>") +
         "</figcaption>\n</figure>\n";
}

std::string notes(const std::vector<PageNote>& notes) {
  std::string html = "<dl>\n";
  for (const PageNote& note : notes) {
    const char* const term = note.tone == PageNote::Tone::good  ? "<dt class=\"good\">"
                             : note.tone == PageNote::Tone::bad ? "<dt class=\"bad\">"
                                                                : "<dt>";
    html += term + escaped(note.label) + "</dt><dd>" + escaped(note.says) + "</dd>\n";
  }
  return html + "</dl>\n";
}

std::string links(const std::vector<std::string>& files) {
  std::string html = "<p class=\"links\">Data: ";
  for (const std::string& file : files) {
    if (&file != &files.front()) html += ", ";
    html += "<a href=\"" + escaped(file) + "\">" + escaped(file) + "</a>";
  }
  return html + "</p>\n";
}

bool is_number(const std::string& cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789,.") == std::string::npos;
}

// Cells of fewer bytes are not broken into lines.
constexpr std::size_t whole_below = 24;

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    html += "<tr>";
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const std::string tag = r == 0 ? "th" : "td";
      // A column of numbers is one whose first number is one.
      const bool number = rows.size() > 1 && is_number(rows[1][c]);
      const bool brief = r > 0 && rows[r][c].size() < whole_below;
      html += '<' + tag +
              (number  ? " class=\"number\">"
               : brief ? " class=\"short\">"
                       : ">") +
              escaped(rows[r][c]) + "</" + tag + '>';
    }
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

std::string section(const PageSection& section) {
  std::string html = "<h2>" + escaped(section.title) + "</h2>\n";
  if (!section.says.empty()) html += "<p>" + escaped(section.says) + "</p>\n";
  if (!section.notes.empty()) html += notes(section.notes);
  if (section.two_to_a_row) html += "<div class=\"two\">\n";
  for (const PagePicture& picture : section.pictures) html += figure(picture);
  if (section.two_to_a_row) html += "</div>\n";
  if (!section.table.empty()) html += table(section.table);
  if (!section.commands.empty()) {
    html += "<pre>";
    for (const std::string& command : section.commands) html += escaped(command) + '\n';
    html += "</pre>\n";
  }
  if (!section.links.empty()) html += links(section.links);
  return html;
}

}  // namespace

void write_page(const Page& page, const std::filesystem::path& path) {
  FreshFile file(path);
  file.write(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>");
  file.write(escaped(page.title));
  file.write("</title>\n<style>");
  file.write(style);
  file.write("</style>\n</head>\n<body>\n<h1>" + escaped(page.title) + "</h1>\n<p class=\"lead\">" +
             escaped(page.says) + "</p>\n");
  for (const PageSection& each : page.sections) file.write(section(each));
  file.write("</body>\n</html>\n");
  file.commit();
}

}  // namespace vicinity::cli

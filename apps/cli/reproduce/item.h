// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The items of the report: figures, tables and claims of the paper, each with what we measured.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reproduce/verdict.h"
#include "reproduce/workshop.h"

namespace vicinity::report {

struct Figure {
  std::filesystem::path file;  ///< .svg or .png
  std::string title, says;
};

/// What the run of an item leaves: files in the workshop, and numbers in the checks.
struct Outcome {
  std::vector<Check> checks;
  std::vector<Figure> figures;
  std::vector<std::vector<std::string>> table = {};  ///< first row: headings; empty: none
  std::vector<std::filesystem::path> data = {};      ///< CSV and JSON files
};

struct Item {
  std::string name;               ///< as --only takes it
  std::vector<std::string> also;  ///< other names --only takes: figures that it shows as well
  std::string title;
  std::string paper;   ///< what the paper shows, in our words
  std::string chosen;  ///< what we chose where the paper is silent, and why
  Outcome (*run)(Workshop& workshop);
};

/// All items, in the paper's order.
const std::vector<Item>& items();

/// The item of that name, or that shows the figure of that name. Errors: throws Error, with the
/// nearest name, for another.
const Item& item_named(const std::string& name);

}  // namespace vicinity::report

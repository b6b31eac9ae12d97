// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/reproduce.h"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "fresh_file.h"
#include "page.h"
#include "progress_bar.h"
#include "readable.h"
#include "reproduce/item.h"

namespace vicinity::cli {
namespace {

using Json = nlohmann::ordered_json;
using report::Check;
using report::Item;
using report::Outcome;
using report::Verdict;
using report::verdict_of;
using report::Workshop;

struct Result {
  const Item* item;
  Outcome outcome;
  Verdict verdict;
};

std::vector<const Item*> chosen(const std::string& only) {
  if (!only.empty()) return {&report::item_named(only)};
  std::vector<const Item*> all;
  for (const Item& item : report::items()) all.push_back(&item);
  return all;
}

PageSection section_of(const Result& result, const std::filesystem::path& folder) {
  PageSection section;
  section.title = result.item->name + ": " + result.item->title;
  section.notes = {{"The paper", result.item->paper}};
  for (const Check& check : result.outcome.checks) {
    section.notes.push_back({check.holds ? "Holds" : "Does not hold",
                             check.claim + ": " + check.measured,
                             check.holds ? PageNote::Tone::good : PageNote::Tone::bad});
  }
  section.notes.push_back({"We chose", result.item->chosen});
  for (const report::Figure& figure : result.outcome.figures) {
    section.pictures.push_back({figure.file, figure.title, figure.says});
  }
  section.two_to_a_row = result.outcome.figures.size() > 1;
  section.table = result.outcome.table;
  section.commands = {"vicinity reproduce --only " + result.item->name + " -o DIR"};
  for (const std::filesystem::path& file : result.outcome.data) {
    section.links.push_back(file.lexically_relative(folder).generic_string());
  }
  return section;
}

Page page_of(const std::vector<Result>& results, const std::filesystem::path& folder) {
  PageSection overview{
      .title = "Verdicts",
      .says =
          "Each is computed from the numbers of its item below: an item agrees where every "
          "claim that we read in the paper holds in what we measured."};
  std::size_t agree = 0;
  for (const Result& result : results) {
    agree += result.verdict.agrees ? 1 : 0;
    overview.notes.push_back(
        {result.item->name + (result.verdict.agrees ? " agrees" : " does not agree"),
         result.item->title + (result.verdict.agrees ? "" : ": " + result.verdict.why),
         result.verdict.agrees ? PageNote::Tone::good : PageNote::Tone::bad});
  }
  Page page{
      .title = "The paper, reproduced",
      .says = fmt::format(
          "Physics-based vicinity emulation for enhanced perception in tele-operation (Pramana – "
          "J. Phys. 85, 6, December 2015): its figures, tables and claims, made anew by this "
          "program from its own objects. {} of {} items agree with the paper. A voxel is {:g} mm; "
          "every object went through an STL file in meshes/ and the ordinary build. Figures 1, 3, "
          "10, 15, 25 and 31 to 33 are drawings without a result.",
          agree, results.size(), 1000 * report::voxel_m)};
  page.sections.push_back(std::move(overview));
  for (const Result& result : results) page.sections.push_back(section_of(result, folder));
  return page;
}

Json verdict_as_json(const Result& result) {
  return {
      {"item", result.item->name}, {"agrees", result.verdict.agrees}, {"why", result.verdict.why}};
}

// The verdicts that are there already, of the items that there are.
std::map<std::string, Json> verdicts_in(const std::filesystem::path& path) {
  std::map<std::string, Json> verdicts;
  std::ifstream file(path);
  const Json json = Json::parse(file, nullptr, false);
  if (!json.is_array()) return verdicts;
  for (const Json& each : json) {
    if (each.is_object() && each.contains("item") && each["item"].is_string()) {
      verdicts[each["item"].get<std::string>()] = each;
    }
  }
  return verdicts;
}

// One item made alone takes its own verdict's place, and leaves the others.
void write_verdicts(const std::vector<Result>& results, const std::filesystem::path& path) {
  std::map<std::string, Json> verdicts = verdicts_in(path);
  for (const Result& result : results) {
    verdicts[result.item->name] = verdict_as_json(result);
  }
  Json json = Json::array();
  for (const Item& item : report::items()) {
    if (const auto found = verdicts.find(item.name); found != verdicts.end()) {
      json.push_back(found->second);
    }
  }
  FreshFile file(path);
  file.write(json.dump(2) + '\n');
  file.commit();
}

}  // namespace

int reproduce(const ReproduceOptions& options, std::ostream& out, std::ostream& err) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<const Item*> items = chosen(options.only);
  Workshop workshop(options.folder);
  std::vector<Result> results;
  auto bar = std::make_unique<ProgressBar>(err);
  for (const Item* item : items) {
    bar->show(item->name, static_cast<double>(results.size()) / static_cast<double>(items.size()));
    Outcome outcome = item->run(workshop);
    Verdict verdict = verdict_of(outcome.checks);
    results.push_back({item, std::move(outcome), std::move(verdict)});
  }
  write_verdicts(results, options.folder / "verdicts.json");
  // An item made alone has a page of its own, beside its data; that of the whole report stays.
  const std::filesystem::path page_folder =
      options.only.empty() ? options.folder : options.folder / items.front()->name;
  write_page(page_of(results, page_folder), page_folder / "index.html");
  bar.reset();

  for (const Result& result : results) {
    out << fmt::format("{:<10}{:<15} {}\n", result.item->name,
                       result.verdict.agrees ? "agrees" : "DOES NOT AGREE", result.item->title);
  }
  const double took =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out << fmt::format("{}: {} {} in {}\n", (page_folder / "index.html").string(), results.size(),
                     results.size() == 1 ? "item" : "items", seconds(took));
  return 0;
}

}  // namespace vicinity::cli

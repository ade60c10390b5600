// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_outputs.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "tools/cli/sheet_page.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

std::vector<files::OutputFile> sheet_outputs(const Sheet& sheet,
                                             const Machine& machine,
                                             const StatedNoise& noise,
                                             const PlanOutputs& outputs,
                                             const std::string& expected) {
  std::vector<files::OutputFile> written = {{outputs.list,
                                             is_json_wanted(outputs.json, outputs.list)
                                                 ? sheet_json(sheet, machine, noise)
                                                 : sheet_csv(sheet)}};
  if (!outputs.page.empty())
    written.push_back({outputs.page, sheet_page(sheet, machine, outputs.list)});
  if (!outputs.gcode.empty()) written.push_back({outputs.gcode, sheet_gcode(sheet, outputs.drill)});
  add_answer(sheet.marks, sheet.visits, expected, outputs, written);
  return written;
}

void add_answer(const std::vector<MarkPoint>& places,
                const std::vector<std::size_t>& visits,
                const std::string& expected,
                const PlanOutputs& outputs,
                std::vector<files::OutputFile>& written) {
  if (!outputs.json || outputs.list == "-") return;
  std::vector<std::string> pairs;
  for (const MarkPoint& place : places)
    pairs.push_back(fmt::format("[{}, {}]", place.x_mm, place.y_mm));
  std::vector<std::size_t> order = visits;
  for (std::size_t i = 0; visits.empty() && i < places.size(); ++i) order.push_back(i);
  written.push_back({"-",
                     fmt::format("{{\"marks\": [{}],\n\"visits\": [{}],\n{}}}\n",
                                 fmt::join(pairs, ", "),
                                 fmt::join(order, ", "),
                                 expected)});
}

void say_next_of_sheet(const PlanOutputs& outputs, const std::string& machine) {
  std::vector<std::string> words = {"fit", outputs.list, "-o", "map.json"};
  if (!is_json_wanted(outputs.json, outputs.list))
    words.insert(words.begin() + 2, {"--machine", machine});
  if (outputs.list != "-") fmt::print(stderr, "Write what you read into {}.\n", outputs.list);
  say_next(words);
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/lab/inputs/tellings.hpp"

#include <map>

namespace chaintrue::inputs {

std::string then_of(const Invocation& call) {
  if (call.verb != "fit" || (call.facts & (cli::facts::grid | cli::facts::holes)) == 0) return "";
  if ((call.facts & cli::facts::direct) != 0)
    return "query map.json 0 0 700 300 350 -150 1200 600 --json; query map.json 0 0 --frame bed";
  return "query map.json 0 0 700 300 1200 600 -1180 590 --json";
}

namespace {

std::vector<Telling> tellings() {
  const std::map<std::string, Shows> shows = {{"in_numbers", Shows::in_numbers},
                                              {"in_form", Shows::in_form},
                                              {"as_file", Shows::as_file},
                                              {"in_words", Shows::in_words}};
  std::vector<Telling> all;
  for (auto row : rows_of("lab/inputs/tellings.tsv")) {
    row.resize(6);
    all.push_back({row[0], row[1], row[2], shows.at(row[3]), row[4], row[5]});
  }
  return all;
}

}  // namespace

const Telling* telling_of(const std::string& verb, const std::string& option,
                          const std::string& use) {
  static const std::vector<Telling> all = tellings();
  const Telling* general = nullptr;
  for (const Telling& one : all) {
    if (one.option != option) continue;
    const bool is_verb = one.verb == verb;
    const bool is_group = one.verb == "gcode" && verb.starts_with("gcode ");
    if (!is_verb && !is_group) continue;
    if (one.where == use) return &one;
    if (one.where.empty() && (general == nullptr || is_verb)) general = &one;
  }
  return general;
}

}  // namespace chaintrue::inputs

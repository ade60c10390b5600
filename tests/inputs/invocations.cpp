// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/invocations.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <sstream>

#include "tests/inputs/input_folder.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::inputs {

namespace facts = cli::facts;

namespace {

/// For names with "|" between.
cli::Facts facts_of(const std::string& names) {
  static const std::map<std::string, cli::Facts> all = {{"anchors", facts::anchors},
                                                        {"any", facts::any},
                                                        {"belt_holes", facts::belt_holes},
                                                        {"belts", facts::belts},
                                                        {"causes", facts::causes},
                                                        {"check", facts::check},
                                                        {"diagnosis", facts::diagnosis},
                                                        {"direct", facts::direct},
                                                        {"drawing", facts::drawing},
                                                        {"drilled", facts::drilled},
                                                        {"fade", facts::fade},
                                                        {"follow_up", facts::follow_up},
                                                        {"grid", facts::grid},
                                                        {"holes", facts::holes},
                                                        {"lattice", facts::lattice},
                                                        {"machine", facts::machine},
                                                        {"map", facts::map},
                                                        {"marks", facts::marks},
                                                        {"no_map", facts::no_map},
                                                        {"one_grid", facts::one_grid},
                                                        {"places", facts::places},
                                                        {"plotter", facts::plotter},
                                                        {"program", facts::program},
                                                        {"residual", facts::residual},
                                                        {"scattered", facts::scattered},
                                                        {"table", facts::table},
                                                        {"tape", facts::tape}};
  cli::Facts sum = 0;
  std::istringstream rest(names);
  for (std::string name; std::getline(rest, name, '|');) sum |= all.at(name);
  return sum;
}

}  // namespace

const std::vector<cli::OptionRule>& rules() {
  // Checks and places of other tables keep what they point at.
  static CLI::App app;
  static const std::vector<cli::OptionRule> all = [] {
#define CHAINTRUE_VERB(id) cli::add_##id(cli::Verb(app));
#include "tools/cli/verbs.def"
#undef CHAINTRUE_VERB
    return cli::declared().rules;
  }();
  return all;
}

const std::vector<Invocation>& invocations() {
  static const std::vector<Invocation> all = [] {
    std::vector<Invocation> read;
    for (const auto& row : rows_of("inputs/invocations.tsv"))
      read.push_back({row.at(0), row.at(1), facts_of(row.at(2)), row.at(3)});
    return read;
  }();
  return all;
}

const std::vector<std::string>& values_of(const std::string& option) {
  static const std::map<std::string, std::vector<std::string>> all = [] {
    std::map<std::string, std::vector<std::string>> read;
    for (const auto& row : rows_of("inputs/values.tsv"))
      read[row[0]] = {row.begin() + 1, row.end()};
    return read;
  }();
  static const std::vector<std::string> none;
  const auto found = all.find(option);
  return found == all.end() ? none : found->second;
}

}  // namespace chaintrue::inputs

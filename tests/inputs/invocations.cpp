// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/invocations.hpp"

#include <map>
#include <set>
#include <sstream>

#include "tests/inputs/input_folder.hpp"

namespace chaintrue::inputs {

namespace facts = cli::facts;

namespace {

/// For names with "|" between.
cli::Facts facts_of(const std::string& names) {
  static const std::map<std::string, cli::Facts> all = {
      {"anchors", facts::anchors}, {"any", facts::any}, {"belt_holes", facts::belt_holes},
      {"belts", facts::belts}, {"causes", facts::causes}, {"check", facts::check},
      {"diagnosis", facts::diagnosis}, {"direct", facts::direct}, {"drawing", facts::drawing},
      {"drilled", facts::drilled}, {"fade", facts::fade}, {"follow_up", facts::follow_up},
      {"grid", facts::grid}, {"holes", facts::holes}, {"lattice", facts::lattice},
      {"machine", facts::machine}, {"map", facts::map}, {"marks", facts::marks}, {"no_map", facts::no_map},
      {"one_grid", facts::one_grid}, {"places", facts::places}, {"plotter", facts::plotter},
      {"program", facts::program}, {"residual", facts::residual}, {"scattered", facts::scattered},
      {"table", facts::table}, {"tape", facts::tape}};
  cli::Facts sum = 0;
  std::istringstream rest(names);
  for (std::string name; std::getline(rest, name, '|');) sum |= all.at(name);
  return sum;
}

}  // namespace

const std::vector<Invocation>& invocations() {
  static const std::vector<Invocation> all = [] {
    std::vector<Invocation> read;
    for (const auto& row : rows_of("inputs/invocations.tsv"))
      read.push_back({row.at(0), row.at(1), facts_of(row.at(2)), row.at(3)});
    return read;
  }();
  return all;
}

const std::vector<std::string>& values_of(std::string_view option) {
  static const std::map<std::string_view, std::vector<std::string>> all = {
      {"--grid", {"4x3", "2x2", "7x4"}},
      {"--holes", {"6", "24"}},
      {"--tape-length-mm", {"1200"}},
      {"--machine", {"@classic.json", "@stated.json"}},
      {"--with", {"@holes2.json", "@grid.json", "@few.json"}},
      {"--pulls", {"1,1.6"}},
      {"--spacing", {"chebyshev", "regular"}},
      {"--region", {"left", "whole", "top"}},
      {"--order", {"columns", "rows", "random", "serpentine_rows"}},
      {"--assume-order", {"rows"}},
      {"--effect",
       {"chain_pitch_error:left:elongation=0.0012",
        "chain_stretch:both:axial_stiffness_n=100000",
        "belt_stretch:-:elongation=0.004"}},
      {"--offset", {"motor_left_x_mm=1.5", "tl_x_mm=12"}},
      {"--model", {"straight", "firmware", "elastic_3d"}},
      {"--name", {"a name", "<b>"}},
      {"--side", {"left", "both"}},
      {"--set", {"elongation=0.001"}},
      {"--shard", {"1/4", "4/4"}},
      {"--date", {"2026-11-22"}},
      {"--home", {"20,-30", "-10,5.5"}},
      {"--without", {"3", "7,12"}}};
  static const std::vector<std::string> none;
  const auto found = all.find(option);
  return found == all.end() ? none : found->second;
}

bool is_output(std::string_view option) {
  static const std::set<std::string_view> all = {
      "--output", "--page", "--gcode", "--svg", "--answer", "--report", "--extended-machine",
      "--corrected-grid", "--law", "--draw", "--all", "--map-after"};
  return all.contains(option);
}

}  // namespace chaintrue::inputs

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/grid_files/fixture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/optical_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/files/plotter_settings.hpp"
#include "grid/files/points_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

std::vector<std::string> messages_of(const std::vector<Warning>& warnings) {
  std::vector<std::string> messages;
  for (const Warning& warning : warnings) messages.push_back(warning.message());
  return messages;
}

std::string points_written(const std::vector<model::MarkPoint>& points) {
  std::string written = "x_mm,y_mm\n";
  for (const model::MarkPoint& point : points)
    written += fmt::format("{},{}\n", point.x_mm, point.y_mm);
  return written;
}

OpticalOptions optical_options() {
  OpticalOptions options;
  options.machine.controller.kind = model::ControllerKind::maslow_classic;
  return options;
}

Outcome outcome_of(const std::string& kind, const std::string& text, const std::string& name) {
  // What is read is written, and its warnings kept.
  const auto with_warnings = [](const auto& read, const std::string& written) {
    return Outcome{written, messages_of(read.warnings), {}};
  };
  const auto grid = [&](const auto& read) { return with_warnings(read, write_grid(read.grid)); };
  const auto machine = [&](const auto& read) {
    return with_warnings(read, write_machine(read.machine));
  };
  const auto belts = [&](const auto& read) { return with_warnings(read, write_belts(read.belts)); };
  const auto plotter = [&](const auto& read) {
    return with_warnings(read, write_plotter(read.plotter));
  };
  const auto holes = [&](const auto& read) { return with_warnings(read, write_holes(read.holes)); };
  if (kind == "grid") return grid(parse_grid(text, name));
  if (kind == "machine") return machine(parse_machine(text, name));
  if (kind == "groundcontrol") return machine(parse_groundcontrol(text, name));
  if (kind == "holes") return holes(parse_holes(text, name));
  if (kind == "belts") return belts(parse_belts(text, name));
  if (kind == "maslow4") return belts(parse_maslow4(text, name));
  if (kind == "plottersettings") return plotter(parse_plotter_settings(text, name));
  if (kind == "points") return {points_written(parse_points(text, name)), {}, {}};
  if (kind == "optical") return {write_grid(parse_optical(text, name, optical_options())), {}, {}};
  if (kind == "diagnosis") return {write_diagnosis(parse_diagnosis(text, name)), {}, {}};
  if (kind == "anchors") return {write_anchors(parse_anchors(text, name)), {}, {}};
  if (kind == "plotter") return {write_plotter(parse_plotter(text, name)), {}, {}};
  if (kind == "drawing") return {write_drawing(parse_drawing(text, name)), {}, {}};
  throw std::logic_error("no reader of " + kind);
}

std::vector<std::string> lines_after(const std::string& mark, const std::string& text) {
  std::vector<std::string> remarks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of("#; \xEF\xBB\xBF");
    if (begin == std::string::npos || line.compare(begin, mark.size(), mark) != 0) continue;
    line.erase(line.find_last_not_of("\r") + 1);
    remarks.push_back(line.substr(begin + mark.size()));
  }
  return remarks;
}

}  // namespace

void PrintTo(const FixtureFile& fixture, std::ostream* out) { *out << fixture.path.filename(); }

std::string test_name_of(const FixtureFile& fixture) {
  std::string name = fixture.path.filename().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '.' || c == '-'; }, '_');
  return name;
}

std::vector<FixtureFile> fixtures_in(const std::string& folder) {
  std::vector<FixtureFile> fixtures;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(CHAINTRUE_FIXTURES) / folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".expect" || entry.path().extension() == ".md") continue;
    fixtures.push_back({entry.path(), name.substr(0, name.find('_'))});
  }
  std::sort(fixtures.begin(), fixtures.end(),
            [](const FixtureFile& a, const FixtureFile& b) { return a.path < b.path; });
  return fixtures;
}

std::vector<std::string> remarks_in(const FixtureFile& fixture, const std::string& mark) {
  std::filesystem::path alongside = fixture.path;
  alongside += ".expect";
  if (std::filesystem::exists(alongside)) return lines_after(mark, read_whole_file(alongside));
  const std::string text = read_whole_file(fixture.path);
  if (fixture.path.extension() != ".json") return lines_after(mark, text);
  std::string comments;
  for (const auto& line : nlohmann::json::parse(text).value("comment", nlohmann::json::array())) {
    comments += line.get<std::string>() + "\n";
  }
  return lines_after(mark, comments);
}

Outcome read_text(const std::string& kind, const std::string& text, const std::string& name) {
  try {
    return outcome_of(kind, text, name);
  } catch (const InputError& error) {
    Outcome outcome;
    for (const InputProblem& problem : error.problems())
      outcome.problems.push_back(problem.message());
    return outcome;
  }
}

Outcome read_fixture(const FixtureFile& fixture) {
  return read_text(fixture.kind, read_whole_file(fixture.path), fixture.path.string());
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/grid_files/fixture_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

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

Outcome grid_outcome(const std::string& text, const std::string& name) {
  const ReadGrid read = parse_grid(text, name);
  return {write_grid(read.grid), messages_of(read.warnings), {}};
}

Outcome machine_outcome(const std::string& text, const std::string& name) {
  const ReadMachine read = parse_machine_with_warnings(text, name);
  return {write_machine(read.machine), messages_of(read.warnings), {}};
}

Outcome points_outcome(const std::string& text, const std::string& name) {
  std::string written = "x_mm,y_mm\n";
  for (const model::MarkPoint& point : parse_points(text, name)) {
    written += fmt::format("{},{}\n", point.x_mm, point.y_mm);
  }
  return {written, {}, {}};
}

Outcome optical_outcome(const std::string& text, const std::string& name) {
  OpticalOptions options;
  options.machine.controller.kind = model::ControllerKind::maslow_classic;
  return {write_grid(parse_optical(text, name, options).grid), {}, {}};
}

Outcome groundcontrol_outcome(const std::string& text, const std::string& name) {
  const ReadMachine read = parse_groundcontrol(text, name);
  return {write_machine(read.machine), messages_of(read.warnings), {}};
}

Outcome diagnosis_outcome(const std::string& text, const std::string& name) {
  return {write_diagnosis(parse_diagnosis(text, name)), {}, {}};
}

Outcome holes_outcome(const std::string& text, const std::string& name) {
  const ReadHoles read = parse_holes(text, name);
  return {write_holes(read.holes), messages_of(read.warnings), {}};
}

Outcome belts_outcome(const std::string& text, const std::string& name) {
  const ReadBelts read = parse_belts(text, name);
  return {write_belts(read.belts), messages_of(read.warnings), {}};
}

Outcome anchors_outcome(const std::string& text, const std::string& name) {
  return {write_anchors(parse_anchors(text, name)), {}, {}};
}

Outcome maslow4_outcome(const std::string& text, const std::string& name) {
  const Maslow4Import read = parse_maslow4(text, name);
  return {write_belts(read.belts), messages_of(read.warnings), {}};
}

Outcome plotter_outcome(const std::string& text, const std::string& name) {
  return {write_plotter(parse_plotter(text, name)), {}, {}};
}

Outcome drawing_outcome(const std::string& text, const std::string& name) {
  return {write_drawing(parse_drawing(text, name)), {}, {}};
}

/// For the controller of a V-plotter.
Outcome settings_outcome(const std::string& text, const std::string& name) {
  const ReadPlotter read = parse_plotter_settings(text, name);
  return {write_plotter(read.plotter), messages_of(read.warnings), {}};
}

using Reader = std::function<Outcome(const std::string& text, const std::string& name)>;

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> by_kind = {{"grid", grid_outcome},
                                                        {"machine", machine_outcome},
                                                        {"points", points_outcome},
                                                        {"optical", optical_outcome},
                                                        {"groundcontrol", groundcontrol_outcome},
                                                        {"diagnosis", diagnosis_outcome},
                                                        {"holes", holes_outcome},
                                                        {"belts", belts_outcome},
                                                        {"anchors", anchors_outcome},
                                                        {"maslow4", maslow4_outcome},
                                                        {"plotter", plotter_outcome},
                                                        {"drawing", drawing_outcome},
                                                        {"plottersettings", settings_outcome}};
  return by_kind;
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
  std::sort(fixtures.begin(), fixtures.end(), [](const FixtureFile& a, const FixtureFile& b) {
    return a.path < b.path;
  });
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
  const Reader& reader = readers().at(kind);
  try {
    return reader(text, name);
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/fluidnc_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "grid/files/number_text.hpp"
#include "grid/files/problems.hpp"
#include "grid/files/yaml_values.hpp"

namespace chaintrue::grid::files {
namespace {

/// Reads the file's numbers; a missing one is reported and reads as 0.
class YamlReader {
 public:
  YamlReader(std::map<std::string, YamlValue> values, Problems& problems)
      : values_(std::move(values)), problems_(problems) {}

  double number(const std::string& path, const Range& range) {
    const auto found = values_.find(path);
    if (found == values_.end()) {
      problems_.add(path, "", range.expected());
      return 0.0;
    }
    return checked_number(found->second.text, found->second.place, path, range, problems_)
        .value_or(0.0);
  }

 private:
  std::map<std::string, YamlValue> values_;
  Problems& problems_;
};

}  // namespace

bool is_fluidnc(const std::string& text) {
  const auto values = yaml_values(text);
  return std::any_of(values.begin(), values.end(), [](const auto& value) {
    return value.first.starts_with("kinematics/WallPlotter/");
  });
}

ReadMachine parse_fluidnc(const std::string& text, const std::string& file) {
  Problems problems(file);
  if (!is_fluidnc(text)) {
    problems.add(
        "", "no WallPlotter", "kinematics: WallPlotter: with its anchors, as FluidNC has it");
    problems.throw_if_any();
  }
  YamlReader reader(yaml_values(text), problems);
  // The same as in model::problems_of, which is applied in any case.
  constexpr Range kAnchor{"mm", -20000.0, 20000.0};
  constexpr Range kTravel{"mm", 200.0, 20000.0};
  const std::string anchors = "kinematics/WallPlotter/";
  ReadMachine read;
  model::Machine& machine = read.machine;
  machine.name = std::filesystem::path(file).filename().string();
  machine.motors.left = {reader.number(anchors + "left_anchor_x", kAnchor),
                         reader.number(anchors + "left_anchor_y", kAnchor)};
  machine.motors.right = {reader.number(anchors + "right_anchor_x", kAnchor),
                          reader.number(anchors + "right_anchor_y", kAnchor)};
  machine.bed = {reader.number("axes/x/max_travel_mm", kTravel),
                 reader.number("axes/y/max_travel_mm", kTravel)};
  machine.controller = {model::ControllerKind::fluidnc_wallplotter, {}};
  problems.throw_if_any();
  for (const model::MachineProblem& problem : model::problems_of(machine)) {
    problems.add(
        fmt::format("the machine's {}", problem.parameter), problem.value, problem.expected);
  }
  problems.throw_if_any();
  problems.warn(
      "",
      fmt::format("FluidNC does not say what hangs on the anchors; assumed are a sled of "
                  "{} kg, a ring of {} mm, sprockets of {} teeth of {} mm, a chain of {} "
                  "kg/m, a frame that leans {} degrees: put your own into the machine file",
                  machine.sled.mass_kg,
                  std::get<model::Ring>(machine.attachment).radius_mm,
                  machine.sprocket.teeth,
                  machine.sprocket.pitch_mm,
                  machine.chain.mass_kg_per_m,
                  machine.frame.tilt_from_vertical_deg));
  read.warnings = problems.warnings();
  return read;
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/sources.hpp"

#include "grid/containers.hpp"
#include "grid/files/machine_checks.hpp"
#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {

bool is_fluidnc(const std::string& text) {
  Problems problems("");
  const auto values = yaml_texts(text, problems);
  return any_of(
      values, [](const auto& value) { return value.first.starts_with("kinematics/WallPlotter/"); });
}

PerSide<model::MotorPosition> fluidnc_anchors(SettingReader& settings) {
  const std::string anchors = "kinematics/WallPlotter/";
  return {{settings.need(anchors + "left_anchor_x", kCoordinateMm),
           settings.need(anchors + "left_anchor_y", kCoordinateMm)},
          {settings.need(anchors + "right_anchor_x", kCoordinateMm),
           settings.need(anchors + "right_anchor_y", kCoordinateMm)}};
}

ReadMachine parse_fluidnc(const std::string& text, const std::string& file) {
  Problems problems(file);
  if (!is_fluidnc(text)) {
    problems.add("", "no WallPlotter", ProblemKind::missing,
                 "kinematics: WallPlotter: with its anchors, as in FluidNC");
    problems.throw_if_any();
  }
  SettingReader settings(yaml_texts(text, problems), problems);
  // The same as in model::problems_of, which is applied in any case.
  constexpr Range kTravel{"mm", 200.0, 20000.0};
  ReadMachine read;
  Machine& machine = read.machine;
  machine.name = name_without_folders(file);
  machine.motors = fluidnc_anchors(settings);
  machine.bed = {settings.need("axes/x/max_travel_mm", kTravel),
                 settings.need("axes/y/max_travel_mm", kTravel)};
  machine.controller = {ControllerKind::fluidnc_wallplotter, {}};
  problems.throw_if_any();
  check_geometry(machine, problems);
  problems.throw_if_any();
  problems.warn("",
                "FluidNC has no settings for the sled and chains. Assumed: a sled of {} kg, a "
                "ring of {} mm, sprockets of {} teeth of {} mm, a chain of {} kg/m, a frame that "
                "leans {} degrees. Enter your values in the machine file",
                machine.sled.mass_kg, std::get<Ring>(machine.attachment).radius_mm,
                machine.sprocket.teeth, machine.sprocket.pitch_mm, machine.chain.mass_kg_per_m,
                machine.frame.tilt_from_vertical_deg);
  settings.warn_of_others("describes where the sled hangs");
  read.warnings = problems.warnings();
  return read;
}

}  // namespace chaintrue::grid::files

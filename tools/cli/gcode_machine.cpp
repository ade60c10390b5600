// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/gcode_job.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/belts/belt_map.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/map/map_in_frame.hpp"
#include "model/belts/belt_controller.hpp"
#include "model/plotter/plotter_commands.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/settings_file.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

constexpr std::string_view kFourBeltsName = "maslow4";
constexpr std::string_view kMarlinName = "marlin";

std::optional<ControllerKind> controller_kind(std::string_view name) {
  return files::named(files::kControllerKinds, name);
}

}  // namespace

gcode::Dialect GcodeOptions::dialect() const {
  gcode::Dialect dialect;
  dialect.skip_deletable_blocks = skip_deletable;
  dialect.tools_have_no_diameter = tools_have_no_diameter;
  const BedPoint zero = home_mm();
  dialect.home_mm = {zero.x_mm, zero.y_mm};
  dialect.home_is_zero = home_is_zero;
  // Without a map nothing is written, so every controller's codes may be read.
  dialect.passes_plotter_codes =
      map_file ? map_file->kind == FileKind::plotter : controller.empty();
  dialect.step_budget = step_budget;
  if (map_file && map_file->kind == FileKind::plotter) {
    const grid::SetPlotter set = load_plotter(*map_file).plotter.set;
    if (set.firmware == model::PlotterFirmware::marlin && set.home) {
      dialect.plotter_home_mm = {set.home->x_mm + set.pins_middle.x_mm - zero.x_mm,
                                 set.home->y_mm + set.pins_middle.y_mm - zero.y_mm};
    }
  }
  return dialect;
}

BedPoint GcodeOptions::home_mm() const {
  const std::string_view text = home;
  const std::size_t comma = text.find(',');
  const auto x = files::number_of(text.substr(0, comma));
  const auto y =
      comma == std::string_view::npos ? std::nullopt : files::number_of(text.substr(comma + 1));
  if (x && y) return {*x, *y};
  refuse("--home", home, "two numbers in mm with a comma between, such as 120,-40");
}

const gcode::Firmware* stated_firmware(std::string_view name) {
  if (name == kFourBeltsName) return &gcode::firmware_of_four_belts();
  if (name == kMarlinName) return &gcode::firmware(model::PlotterFirmware::marlin);
  const auto kind = controller_kind(name);
  return kind ? &gcode::firmware(*kind) : nullptr;
}

namespace {

interp::Rectangle rectangle_of(const Bed& bed) {
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

/// The frame of the anchors; commands count from 0, 0.
interp::Rectangle rectangle_of(const BeltMachine& machine) {
  const auto& anchors = machine.anchors;
  const model::FramePoint centre = model::centre_of(machine);
  return {std::min(anchors.tl.x_mm, anchors.bl.x_mm) - centre.x_mm,
          std::max(anchors.tr.x_mm, anchors.br.x_mm) - centre.x_mm,
          std::min(anchors.bl.y_mm, anchors.br.y_mm) - centre.y_mm,
          std::max(anchors.tl.y_mm, anchors.tr.y_mm) - centre.y_mm};
}

/// Under a Maslow 4's names.
std::vector<files::NamedSetting> settings_of(const BeltMachine& machine) {
  std::vector<files::NamedSetting> settings;
  for (const model::Belt belt : model::kBelts) {
    const model::Anchor& anchor = machine.anchors[belt];
    for (const auto& [axis, value] : {std::pair('X', anchor.x_mm), std::pair('Y', anchor.y_mm)})
      settings.push_back(
          {fmt::format("{}{}", model::name(belt), axis), fmt::format("{:.4f}", value)});
  }
  settings.push_back({"Scale_X", fmt::format("{:.6g}", machine.scale_x)});
  settings.push_back({"Scale_Y", fmt::format("{:.6g}", machine.scale_y)});
  return settings;
}

GcodeController controller_of_belts(const GcodeOptions& options, const GcodeTarget& target) {
  if (!options.controller.empty() && options.controller != kFourBeltsName) {
    refuse("--controller",
           options.controller,
           "\"maslow4\", or to be left out, because anchors of four belts belong to a Maslow 4");
  }
  const BeltMachine believed =
      options.machine.empty() ? *target.belts_in_force : read_belt_machine_input(options.machine);
  return {std::make_unique<const model::BeltController>(believed),
          &gcode::firmware_of_four_belts(),
          std::nullopt,
          rectangle_of(believed),
          {},
          settings_of(believed)};
}

interp::Rectangle rectangle_of(const grid::SetPlotter& set) {
  const model::DrawingArea& area = set.machine.area;
  const BedPoint& by = set.pins_middle;
  return {area.left_mm + by.x_mm,
          area.right_mm + by.x_mm,
          area.bottom_mm + by.y_mm,
          area.top_mm + by.y_mm};
}

/// Under the names in a chaintrue_plotter file.
std::vector<files::NamedSetting> settings_of(const grid::SetPlotter& set) {
  const model::PlotterMachine& m = set.machine;
  return {
      {"firmware", std::string(model::name(set.firmware))},
      {"pin_spacing_mm", fmt::format("{:.4f}", m.pin_spacing_mm)},
      {"pin_rise_mm", fmt::format("{:.4f}", m.pin_rise_mm)},
      {"zero", fmt::format("{:.4f} {:.4f}", m.zero_mm.left_mm, m.zero_mm.right_mm)},
      {"scale", fmt::format("{:.6f} {:.6f}", m.scale_mm_per_m.left_mm, m.scale_mm_per_m.right_mm)}};
}

/// The present settings of a V-plotter's controller.
GcodeController controller_of_plotter(const GcodeOptions& options, const GcodeTarget& target) {
  const grid::SetPlotter set = options.machine.empty()
                                   ? target.plotter->set
                                   : load_plotter(open_input(options.machine)).plotter.set;
  if (set.firmware != target.plotter->set.firmware) {
    refuse(options.machine,
           "/set/firmware",
           std::string(model::name(set.firmware)),
           fmt::format("\"{}\", as in {}", model::name(target.plotter->set.firmware), options.map));
  }
  const auto firmware = std::make_shared<gcode::Firmware>(gcode::firmware(set.firmware));
  if (firmware->pieces_per_second > 0.0) firmware->pieces_per_second = set.segments_per_second;
  if (!options.controller.empty() && options.controller != firmware->name) {
    refuse("--controller",
           options.controller,
           fmt::format("\"{}\", or to be left out, because the plotter's file names its controller",
                       firmware->name));
  }
  return {
      std::make_unique<const model::PlotterController>(set.firmware, set.machine, set.pins_middle),
      firmware.get(),
      std::nullopt,
      rectangle_of(set),
      {},
      settings_of(set),
      firmware};
}

Machine believed_machine(const GcodeOptions& options, const CompensationMap& map) {
  if (!options.machine.empty()) return read_machine_input(options.machine);
  const auto stated = grid::stated_machine(map);
  if (!options.settings.empty()) {
    const SettingsFile now = read_settings_file(options.settings);
    const auto in_place = controller_kind(options.controller);
    return stated ? with_settings(*stated, now, in_place ? &*in_place : nullptr) : now.read.machine;
  }
  if (stated) return *stated;
  refuse(options.map,
         "",
         fmt::format(
             "a map with a machine; this one has none, so give the controller's settings with {}",
             options.machine_option));
}

/// If --controller names another than the map was measured with.
void say_other_controller(const CompensationMap& map, ControllerKind kind) {
  if (map.machine() == nullptr || map.machine()->controller.kind == kind) return;
  say("The map was measured with the controller {}; --controller {} replaces it.",
      name_of(map.machine()->controller.kind),
      name_of(kind));
}

GcodeController controller_of(const GcodeOptions& options, const GcodeTarget& target) {
  if (target.plotter) return controller_of_plotter(options, target);
  if (target.map == nullptr) return controller_of_belts(options, target);
  if (options.controller == kMarlinName) {
    refuse("--controller",
           options.controller,
           "a router's controller; Marlin is for V-plotters, which use the fit of a drawing "
           "instead of a map");
  }
  Machine machine = believed_machine(options, *target.map);
  if (const auto kind = controller_kind(options.controller)) {
    say_other_controller(*target.map, *kind);
    machine.controller.kind = *kind;
  }
  return {model::make_controller_kinematics(machine),
          &gcode::firmware(machine.controller.kind),
          gcode::clamp_box(machine),
          rectangle_of(machine.bed),
          gcode::half_play_mm(machine),
          files::settings_in_force(machine)};
}

GcodeTarget target_of_plotter(const GcodeOptions& options) {
  GcodeTarget target{.plotter = load_plotter(*options.map_file).plotter};
  target.lengths = load_plotter_map(*options.map_file, *target.plotter);
  return target;
}

GcodeTarget target_of_belts(const GcodeOptions& options) {
  const files::FittedAnchors found = load_anchors(*options.map_file);
  const grid::HolesWithBelts* holes = found.holes ? &*found.holes : nullptr;
  if (holes == nullptr && !found.fit.coordinates.front().stated_mm) {
    refuse("command line",
           "--map",
           options.map,
           "anchors fitted to a file with the anchors in force, which define the origin of "
           "commands (import maslow4 --settings maslow.yaml)",
           ProblemKind::missing);
  }
  auto map = std::make_unique<const grid::BeltMap>(found.fit, holes);
  GcodeTarget target{.belts_in_force = map->in_force()};
  if (!found.fit.scale) {
    BeltsFit taken_as_true = found.fit;
    taken_as_true.scale = grid::BeltScale{};
    target.in_belts_mm = std::make_unique<const grid::BeltMap>(taken_as_true, holes);
    say("The scale is unknown. An encoder turn is assumed to be {:g} mm of belt, and parts can be "
        "no more accurate than that. One long taped distance, or holes, determine the scale.",
        found.fit.machine.belt_turn_mm);
  }
  target.lengths = std::move(map);
  return target;
}

GcodeTarget target_of_map(const GcodeOptions& options) {
  if (options.controller == kFourBeltsName) {
    refuse(options.map,
           "/file_type",
           "",
           "\"chaintrue_anchors\", which chaintrue fit writes for belts; a Maslow 4 uses these "
           "instead of a map");
  }
  GcodeTarget target{std::make_unique<const CompensationMap>(load_map(*options.map_file))};
  target.lengths = std::make_unique<const grid::MapInFrame>(
      *target.map, options.frame == "bed" ? grid::MapFrame::bed : grid::MapFrame::marks);
  return target;
}

}  // namespace

GcodeTarget open_target(const GcodeOptions& options) {
  if (options.map_file->kind == FileKind::anchors) return target_of_belts(options);
  return options.map_file->kind == FileKind::plotter ? target_of_plotter(options)
                                                     : target_of_map(options);
}

GcodeMachine::GcodeMachine(const GcodeOptions& options)
    : target_(open_target(options)),
      controller_(controller_of(options, target_)),
      corrector_(*target_.lengths, *controller_.kinematics, *controller_.firmware) {}

interp::Rectangle sheet_of(const GcodeOptions& options) {
  if (options.machine.empty()) return rectangle_of(Bed{});
  const FileKind kind = open_input(options.machine).kind;
  if (kind == FileKind::plotter)
    return rectangle_of(load_plotter(open_input(options.machine)).plotter.set);
  const bool of_belts = kind == FileKind::belts || kind == FileKind::anchors;
  return of_belts ? rectangle_of(read_belt_machine_input(options.machine))
                  : rectangle_of(read_machine_input(options.machine).bed);
}

}  // namespace chaintrue::cli

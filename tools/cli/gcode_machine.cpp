// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/gcode_job.hpp"

#include <algorithm>

#include "grid/belts/belt_map.hpp"
#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/raster.hpp"
#include "model/belts/belt_controller.hpp"
#include "model/plotter/plotter_commands.hpp"
#include "tools/cli/input_file.hpp"
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
  gcode::Dialect dialect = words;
  const BedPoint zero = home_mm();
  dialect.home_mm = {zero.x_mm, zero.y_mm};
  // Without a map nothing is written, so every controller's codes may be read.
  dialect.passes_plotter_codes =
      map_file ? map_file->kind == FileKind::plotter : controller.empty();
  if (map_file && map_file->kind == FileKind::plotter) {
    const grid::SetPlotter set = load_plotter(*map_file).plotter.set;
    if (set.firmware == PlotterFirmware::marlin && set.home) {
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

const Firmware* stated_firmware(std::string_view name) {
  if (name == kFourBeltsName) return &gcode::firmware_of_four_belts();
  if (name == kMarlinName) return &gcode::firmware(PlotterFirmware::marlin);
  const auto kind = controller_kind(name);
  return kind ? &gcode::firmware(*kind) : nullptr;
}

namespace {

/// The frame of the anchors; commands count from 0, 0.
Rectangle rectangle_of(const BeltMachine& machine) {
  const auto& anchors = machine.anchors;
  const FramePoint centre = centre_of(machine);
  return {std::min(anchors.tl.x_mm, anchors.bl.x_mm) - centre.x_mm,
          std::max(anchors.tr.x_mm, anchors.br.x_mm) - centre.x_mm,
          std::min(anchors.bl.y_mm, anchors.br.y_mm) - centre.y_mm,
          std::max(anchors.tl.y_mm, anchors.tr.y_mm) - centre.y_mm};
}

/// Under a Maslow 4's names.
std::vector<files::NamedSetting> settings_of(const BeltMachine& machine) {
  std::vector<files::NamedSetting> settings;
  for (const Belt belt : kBelts) {
    const model::Anchor& anchor = machine.anchors[belt];
    for (const auto& [axis, value] : {std::pair('X', anchor.x_mm), std::pair('Y', anchor.y_mm)})
      settings.push_back({fmt::format("{}{}", name(belt), axis), fmt::format("{:.4f}", value)});
  }
  settings.push_back({"Scale_X", fmt::format("{:.6g}", machine.scale_x)});
  settings.push_back({"Scale_Y", fmt::format("{:.6g}", machine.scale_y)});
  return settings;
}

GcodeController controller_of(const GcodeOptions& options, const Target& target,
                              const FittedAnchors&) {
  if (!options.controller.empty() && options.controller != kFourBeltsName) {
    refuse("--controller", options.controller,
           "\"maslow4\", or to be left out, because anchors of four belts belong to a Maslow 4");
  }
  const BeltMachine believed = options.machine.empty()
                                   ? dynamic_cast<const grid::BeltMap&>(*target.lengths).in_force()
                                   : read_belt_machine_input(options.machine);
  return {std::make_unique<const model::BeltController>(believed),
          &gcode::firmware_of_four_belts(),
          std::nullopt,
          rectangle_of(believed),
          {},
          settings_of(believed)};
}

Rectangle rectangle_of(const grid::SetPlotter& set) {
  const model::DrawingArea& area = set.machine.area;
  const BedPoint& by = set.pins_middle;
  return {area.left_mm + by.x_mm, area.right_mm + by.x_mm, area.bottom_mm + by.y_mm,
          area.top_mm + by.y_mm};
}

/// Under the names in a chaintrue_plotter file.
std::vector<files::NamedSetting> settings_of(const grid::SetPlotter& set) {
  const PlotterMachine& m = set.machine;
  return {
      {"firmware", std::string(name(set.firmware))},
      {"pin_spacing_mm", fmt::format("{:.4f}", m.pin_spacing_mm)},
      {"pin_rise_mm", fmt::format("{:.4f}", m.pin_rise_mm)},
      {"zero", fmt::format("{:.4f} {:.4f}", m.zero_mm.left_mm, m.zero_mm.right_mm)},
      {"scale", fmt::format("{:.6f} {:.6f}", m.scale_mm_per_m.left_mm, m.scale_mm_per_m.right_mm)}};
}

/// The present settings of a V-plotter's controller.
GcodeController controller_of(const GcodeOptions& options, const Target&,
                              const KnownPlotter& plotter) {
  const grid::SetPlotter set =
      options.machine.empty() ? plotter.set : load_plotter(open_input(options.machine)).plotter.set;
  if (set.firmware != plotter.set.firmware) {
    refuse(options.machine, "/set/firmware", std::string(name(set.firmware)),
           fmt::format("\"{}\", as in {}", name(plotter.set.firmware), options.map));
  }
  const auto firmware = std::make_shared<Firmware>(gcode::firmware(set.firmware));
  if (firmware->pieces_per_second > 0.0) firmware->pieces_per_second = set.segments_per_second;
  if (!options.controller.empty() && options.controller != firmware->name) {
    refuse("--controller", options.controller,
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
  const auto stated = stated_machine(map);
  if (!options.settings.empty()) {
    const SettingsFile now = read_settings_file(options.settings);
    const auto in_place = controller_kind(options.controller);
    return stated ? with_settings(*stated, now, in_place ? &*in_place : nullptr) : now.read.machine;
  }
  if (stated) return *stated;
  refuse(options.map, "",
         fmt::format(
             "a map with a machine; this one has none, so give the controller's settings with {}",
             options.machine_option));
}

/// If --controller names another than the map was measured with.
void say_other_controller(const CompensationMap& map, ControllerKind kind) {
  if (map.machine() == nullptr || map.machine()->controller.kind == kind) return;
  say("The map was measured with the controller {}; --controller {} replaces it.",
      name_of(map.machine()->controller.kind), name_of(kind));
}

GcodeController controller_of(const GcodeOptions& options, const Target&,
                              const CompensationMap& map) {
  if (options.controller == kFourBeltsName) {
    refuse(options.map, "/file_type", "",
           "\"chaintrue_anchors\", which chaintrue fit writes for belts; a Maslow 4 uses these "
           "instead of a map");
  }
  if (options.controller == kMarlinName) {
    refuse("--controller", options.controller,
           "a router's controller; Marlin is for V-plotters, which use the fit of a drawing "
           "instead of a map");
  }
  Machine machine = believed_machine(options, map);
  if (const auto kind = controller_kind(options.controller)) {
    say_other_controller(map, *kind);
    machine.controller.kind = *kind;
  }
  return {make_controller_kinematics(machine), &gcode::firmware(machine.controller.kind),
          gcode::clamp_box(machine),           grid::area_of(machine.bed),
          gcode::half_play_mm(machine),        files::settings_in_force(machine)};
}

}  // namespace

Target open_target(const GcodeOptions& options) {
  Target target = open_target(*options.map_file, options.frame);
  const auto* found = target.as<FittedAnchors>();
  if (found != nullptr && !found->fit.scale) {
    say("The scale is unknown. An encoder turn is assumed to be {:g} mm of belt, and parts can be "
        "no more accurate than that. One long taped distance, or holes, determine the scale.",
        found->fit.machine.belt_turn_mm);
  }
  return target;
}

GcodeMachine::GcodeMachine(const GcodeOptions& options)
    : target(open_target(options)),
      controller(
          std::visit([&](const auto& content) { return controller_of(options, target, content); },
                     *target.content)),
      corrector(*target.lengths, *controller.kinematics, *controller.firmware) {}

Rectangle sheet_of(const GcodeOptions& options) {
  if (options.machine.empty()) return grid::area_of(Bed{});
  const InputFile file = open_input(options.machine);
  if (file.kind == FileKind::plotter) return rectangle_of(load_plotter(file).plotter.set);
  const bool of_belts = file.kind == FileKind::belts || file.kind == FileKind::anchors;
  return of_belts ? rectangle_of(load_belt_machine(file))
                  : grid::area_of(read_machine_input(options.machine).bed);
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// A map for other controllers: as a kinematics module, or as the closest settings.
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "grid/files/klipper_kinematics.hpp"
#include "grid/files/linuxcnc_kinematics.hpp"
#include "grid/map/map_in_frame.hpp"
#include "grid/map/straight_settings.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct MapCommand {
  std::string map;
  std::string output;
};

/// A map with its name in what is written.
struct NamedMap {
  const CompensationMap& map;
  std::string name;
};

/// The content and the instructions, or the reason why there is none.
struct Written {
  std::string text;
  std::string remark;
};
using WrittenOrWhy = tl::expected<Written, std::string>;

std::string table_words(const files::TableModule& module) {
  return fmt::format(
      "{} x {} lengths of both chains, {:.0f} mm apart; between them the table is within {:.4f} mm "
      "of the map",
      module.columns, module.rows, module.spacing_mm(), module.largest_error_mm);
}

std::string without_table(const grid::MapFailure& failure) {
  return failure.sentence() +
         ". A table needs lengths all over the map; fit the map with --outside continued";
}

WrittenOrWhy klipper_module(const NamedMap& named, const std::string&) {
  const auto nearest = straight_settings(named.map, grid::Anchors::free);
  if (!nearest) return tl::unexpected(nearest.error().sentence());
  auto module = files::klipper_kinematics(grid::MapInFrame(named.map),
                                          {nearest->anchors, nearest->longer_mm}, named.name);
  if (!module) return tl::unexpected(without_table(module.error()));
  return Written{
      std::move(module->source),
      fmt::format(
          "{}, and moves are split into pieces of at most {:g} mm.\nCopy it as "
          "chaintrue.py into klippy/kinematics, and set kinematics: chaintrue in printer.cfg, with "
          "a [stepper_left] and a [stepper_right]. The file's first lines explain the rest.",
          table_words(*module), module->piece_mm)};
}

/// The component is named after its file, as halcompile requires.
std::string module_name(const std::string& output) {
  return output == "-" ? "chaintrue_kins" : std::filesystem::path(output).stem().string();
}

void check_module_name(const MapCommand& command, OptionProblems& problems) {
  const std::string name = module_name(command.output);
  const std::string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  const bool is_identifier = name.find_first_of(letters) == 0 &&
                             name.find_first_not_of(letters + "0123456789") == std::string::npos;
  if (!is_identifier) {
    problems.add("--output", command.output,
                 "a file such as chaintrue_kins.c: LinuxCNC calls the module by its name, of "
                 "letters, digits and _",
                 ProblemKind::output_place);
  }
}

WrittenOrWhy linuxcnc_module(const NamedMap& named, const std::string& output) {
  const std::string name = module_name(output);
  auto module = files::linuxcnc_kinematics(grid::MapInFrame(named.map), {name, named.name});
  if (!module) return tl::unexpected(without_table(module.error()));
  return Written{
      std::move(module->source),
      fmt::format("{}{}.\nBuild and install it where LinuxCNC (2.9 or "
                  "later) runs: halcompile --install {}.c. In the machine's INI file: [KINS] "
                  "KINEMATICS = {} and JOINTS = 3, [TRAJ] LINEAR_UNITS = mm.",
                  table_words(*module),
                  module->largest_error_mm > files::kTableErrorMm
                      ? ", more than intended, because this map bends within millimetres"
                      : "",
                  name, name)};
}

std::string fluidnc_lines(const grid::StraightSettings& s) {
  return fmt::format(
      R"(kinematics:
  WallPlotter:
    left_anchor_x: {:.3f}
    left_anchor_y: {:.3f}
    right_anchor_x: {:.3f}
    right_anchor_y: {:.3f}
axes:
  x:
    steps_per_mm: <steps of a turn / mm of chain in a turn, times {:.6f}>
  y:
    steps_per_mm: <steps of a turn / mm of chain in a turn, times {:.6f}>
)",
      s.anchors.left.x_mm, s.anchors.left.y_mm, s.anchors.right.x_mm, s.anchors.right.y_mm,
      s.more_steps.left, s.more_steps.right);
}

/// Its x counts from the left anchor, its y down from the line between them.
std::string grblhal_lines(const grid::StraightSettings& s) {
  return fmt::format(
      R"($130={:.3f}
$100=<steps of a turn / mm of chain in a turn, times {:.6f}>
$101=<steps of a turn / mm of chain in a turn, times {:.6f}>
; 0, 0 of the sheet is at X{:.3f} Y{:.3f} of the controller, whose Y counts downwards
)",
      s.anchors.right.x_mm - s.anchors.left.x_mm, s.more_steps.left, s.more_steps.right,
      -s.anchors.left.x_mm, s.anchors.left.y_mm);
}

template <grid::Anchors kAnchors, auto kLines>
WrittenOrWhy straight_lines(const NamedMap& named, const std::string&) {
  const auto nearest = straight_settings(named.map, kAnchors);
  if (!nearest) return tl::unexpected(nearest.error().sentence());
  return Written{
      kLines(*nearest),
      fmt::format(
          "With these numbers the tool is still off by {:.2f} mm rms over the measured part, "
          "{:.2f} mm at worst, because this controller's straight lines do not sag. {}",
          nearest->left_over.rms_mm, nearest->left_over.maximum_mm,
          kAnchors == grid::Anchors::free ? "Switch it on with the tool at 0, 0 of the sheet."
                                          : "Its Y points down: mirror the program, and shift it "
                                            "by the offset in the last line.")};
}

struct Controller {
  const char* name;
  const char* help;
  const char* output;
  Origin kind;
  const char* output_help;
  WrittenOrWhy (*write)(const NamedMap& named, const std::string& output);
};

constexpr Controller kControllers[] = {
    {"linuxcnc",
     "Write the map as a kinematics module for LinuxCNC, which then needs no compensated files",
     "chaintrue_kins.c", Origin::table, "The module's source (C); - is standard output",
     linuxcnc_module},
    {"klipper",
     "Write the map as a kinematics module for Klipper, which then needs no compensated files",
     "chaintrue.py", Origin::table, "The module's source (Python); - is standard output",
     klipper_module},
    {"fluidnc",
     "Find the WallPlotter settings that come closest to a map, and the error they leave", "-",
     Origin::list, "Output file; - is standard output",
     straight_lines<grid::Anchors::free, fluidnc_lines>},
    {"grblhal",
     "Find grblHAL's wall plotter settings that come closest to a map, and the error they leave",
     "-", Origin::list, "Output file; - is standard output",
     straight_lines<grid::Anchors::level, grblhal_lines>},
};

int export_map(Verb verb, const MapCommand& command, const Controller& controller) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map});
  const CompensationMap map = load_map(file);
  require_fit_for_cutting(not_to_cut_with(map), verb.is_given("--force"));
  const auto written =
      controller.write({map, std::filesystem::path(file.name).filename().string()}, command.output);
  if (!written) {
    say("{}: {}", file.name, written.error());
    return kNotSupportedOrOutside;
  }
  write_output(command.output, written->text);
  say("{}", written->remark);
  return kDone;
}

}  // namespace

void add_export_map(Verb export_verb) {
  for (const Controller& controller : kControllers) {
    const bool is_module = controller.kind == Origin::table;
    auto [verb, c] = export_verb.add_verb<MapCommand>(
        controller.name, controller.help,
        fmt::format(
            R"({}Example:
  build/chaintrue fit fixtures/start/marks.csv --machine fixtures/machines/groundcontrol.json -o map.json
  build/chaintrue export {} map.json{}{})",
            is_module
                ? ""
                : "To correct the remaining error, compensate each program (gcode compensate).\n\n",
            controller.name, is_module ? " -o " : "", is_module ? controller.output : ""),
        [&controller](Verb chosen, const MapCommand& own) {
          return export_map(chosen, own, controller);
        });
    c.output = controller.output;
    verb.has({{"map", required(reads(c.map)), "A chaintrue_map file"},
              {"-o,--output", writes(c.output, {controller.kind}), controller.output_help}});

    if (controller.write == linuxcnc_module) {
      add_option_check(verb, c, check_module_name);
    }
  }
}

}  // namespace chaintrue::cli

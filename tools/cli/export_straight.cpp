// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>

#include "grid/map/straight_settings.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct ExportStraightCommand {
  std::string map;
  std::string output = "-";
};

/// What a controller of straight lines is told, and how it takes its anchors.
struct StraightController {
  grid::Anchors anchors;
  std::string (*lines)(const grid::StraightSettings&);
  const char* remark;
};

std::string fluidnc_lines(const grid::StraightSettings& s) {
  return fmt::format(
      "kinematics:\n"
      "  WallPlotter:\n"
      "    left_anchor_x: {:.3f}\n"
      "    left_anchor_y: {:.3f}\n"
      "    right_anchor_x: {:.3f}\n"
      "    right_anchor_y: {:.3f}\n"
      "axes:\n"
      "  x:\n"
      "    steps_per_mm: <steps of a turn / mm of chain in a turn, times {:.6f}>\n"
      "  y:\n"
      "    steps_per_mm: <steps of a turn / mm of chain in a turn, times {:.6f}>\n",
      s.anchors.left.x_mm,
      s.anchors.left.y_mm,
      s.anchors.right.x_mm,
      s.anchors.right.y_mm,
      s.more_steps.left,
      s.more_steps.right);
}

/// Its x counts from the left anchor, its y down from the line between them.
std::string grblhal_lines(const grid::StraightSettings& s) {
  return fmt::format(
      "$130={:.3f}\n"
      "$100=<steps of a turn / mm of chain in a turn, times {:.6f}>\n"
      "$101=<steps of a turn / mm of chain in a turn, times {:.6f}>\n"
      "; 0, 0 of the sheet is at X{:.3f} Y{:.3f} of the controller, whose Y counts downwards\n",
      s.anchors.right.x_mm - s.anchors.left.x_mm,
      s.more_steps.left,
      s.more_steps.right,
      -s.anchors.left.x_mm,
      s.anchors.left.y_mm);
}

constexpr StraightController kFluidNc{
    grid::Anchors::free, fluidnc_lines, "Switch it on with the tool at 0, 0 of the sheet."};
constexpr StraightController kGrblHal{
    grid::Anchors::level,
    grblhal_lines,
    "It draws Y downwards: mirror a program, and move it by the place in the last line."};

int export_straight(Verb verb,
                    const ExportStraightCommand& command,
                    const StraightController& controller) {
  const InputFile file = open_input(command.map);
  require_kind(file, {FileKind::map});
  const grid::CompensationMap map = load_map(file);
  if (!verb.is_given("--force") && refuses_to_cut_with(map)) return kCheckFailed;
  const auto nearest = grid::straight_settings(map, controller.anchors);
  if (!nearest) {
    fmt::print(stderr, "{}: {}\n", file.name, nearest.error().sentence());
    return kNotSupportedOrOutside;
  }
  write_output(command.output, controller.lines(*nearest));
  fmt::print(stderr,
             "With these numbers the tool is still off by {:.2f} mm rms over the measured part, "
             "{:.2f} mm at worst: straight lines do not sag. {}\n",
             nearest->left_over.rms_mm,
             nearest->left_over.maximum_mm,
             controller.remark);
  return kDone;
}

void add_controller(Verb export_verb,
                    const char* name,
                    const char* description,
                    const StraightController& controller) {
  auto command = std::make_shared<ExportStraightCommand>();
  Verb verb = export_verb.add_verb(name, description);
  add_input(verb, "map", command->map, "A chaintrue_map file").required();
  add_output(
      verb, "-o,--output", command->output, {Origin::list}, "Output file; - is standard output")
      .shows_default();
  verb.footer(
      fmt::format("For what they leave, compensate each program (gcode compensate).\n\n"
                  "Example:\n"
                  "  build/chaintrue fit fixtures/start/marks.csv --machine "
                  "fixtures/machines/groundcontrol.json "
                  "-o map.json\n"
                  "  build/chaintrue export {} map.json",
                  name));
  verb.runs(command, [&controller](Verb chosen, const auto& own) {
    return export_straight(chosen, own, controller);
  });
}

}  // namespace

void add_export_straight(Verb export_verb) {
  add_controller(export_verb,
                 "fluidnc",
                 "Find the WallPlotter settings that come closest to a map, and the error they "
                 "leave",
                 kFluidNc);
  add_controller(export_verb,
                 "grblhal",
                 "Find grblHAL's wall plotter settings that come closest to a map, and the error "
                 "they leave",
                 kGrblHal);
}

}  // namespace chaintrue::cli

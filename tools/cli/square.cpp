// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue square: predicts the test square that an owner would cut and measure, by a map or for
/// a controller with settings that differ from the machine; and the program that cuts it.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grid/plotter/test_drawing.hpp"
#include "tools/cli/gcode_job.hpp"
#include "tools/cli/svg.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

// The program that cuts, or draws, a test square: metric, absolute, clockwise from its lower left
// corner, in one pass. Same square, same bytes.

std::vector<BedPoint> corners_of(SquareTask task) {
  task.points_per_side = 2;
  return outline_of(task);
}

/// Each side's end is the next one's beginning.
std::string sides_text(const std::vector<BedPoint>& corners, double feed_mm_per_min) {
  std::string text;
  for (std::size_t i = 1; i < corners.size(); i += 2) {
    text += fmt::format("G1 X{:.3f} Y{:.3f} F{:g}\n", corners[i].x_mm, corners[i].y_mm,
                        feed_mm_per_min);
  }
  return text;
}

std::string square_program(const SquareTask& task, double depth_mm) {
  // High above the sheet between cuts, and slow enough for any hanging router.
  constexpr double kClearanceMm = 5.0;
  constexpr double kFeedMmPerMin = 600.0;
  constexpr int kPlungeMmPerMin = 150;
  const std::vector<BedPoint> corners = corners_of(task);
  const std::string text = fmt::format(
      "(chaintrue square: {:g} mm, {:g} mm deep)\n(Zero is the middle of the bed.)\nG21 G90 G17 "
      "G94\nG0 Z{:g}\nG0 X{:.3f} Y{:.3f}\nG1 Z{:g} F{}\n",
      task.size_mm, depth_mm, kClearanceMm, corners.front().x_mm, corners.front().y_mm, -depth_mm,
      kPlungeMmPerMin);
  return text + sides_text(corners, kFeedMmPerMin) +
         fmt::format("G0 Z{:g}\nG0 X0 Y0\nM2\n", kClearanceMm);
}

/// For a V-plotter, in its controller's coordinates: one code on a line, the pen by its own
/// commands.
std::string square_program(const SquareTask& task, const grid::SetPlotter& plotter) {
  const std::vector<BedPoint> corners = corners_of(task);
  return fmt::format("; chaintrue square: {:g} mm\nG21\nG90\n{}\nG0 X{:.3f} Y{:.3f}\n{}\n",
                     task.size_mm, plotter.pen.up, corners.front().x_mm, corners.front().y_mm,
                     plotter.pen.down) +
         sides_text(corners, plotter.feed_mm_per_min) + plotter.pen.up + "\n";
}

struct SquareOptions {
  std::string machine;
  std::string controller_machine;
  std::string map;
  double size_mm = 100.0;
  std::vector<double> at;
  bool below = false;
  bool json = false;
  std::string drawing;
  std::string program;
  double depth_mm = 3.0;
};

constexpr const char* kSideNames[] = {"left", "top", "right", "bottom"};

/// By default around `middle`.
SquareTask task_of(const SquareOptions& options, BedPoint middle) {
  const double half_mm = 0.5 * options.size_mm;
  const BedPoint corner =
      options.at.empty()
          ? BedPoint{middle.x_mm - half_mm, middle.y_mm + (options.below ? half_mm : -half_mm)}
          : BedPoint{options.at[0], options.at[1]};
  return {.size_mm = options.size_mm, .corner = corner, .below = options.below};
}

/// Why a square cannot be predicted: the mechanism's reason and the command.
struct SquareRefusal {
  std::string who;
  BedPoint commanded;
  std::string why;
};

tl::expected<CutSquare, SquareRefusal> by_machines(const SquareOptions& options,
                                                   const SquareTask& task) {
  const Machine machine = read_machine_input(options.machine);
  const Machine believed = read_machine_input(options.controller_machine);
  auto square = predict_square(machine, believed, task);
  if (square) return *std::move(square);
  const model::SquareFailure& failure = square.error();
  return tl::unexpected(
      SquareRefusal{failure.place.of_controller ? "the controller" : "the machine",
                    failure.place.commanded, failure.sentence()});
}

/// A map, or its substitute, with its controller: that of --controller-machine, or the one that the
/// map was measured with.
std::unique_ptr<const GcodeMachine> machine_of(const SquareOptions& options) {
  GcodeOptions gcode;
  gcode.map = options.map;
  gcode.map_file = open_target_file(options.map);
  gcode.machine = options.controller_machine;
  gcode.machine_option = "--controller-machine";
  gcode.frame = "bed";
  return std::make_unique<const GcodeMachine>(gcode);
}

BedPoint middle_of(const Rectangle& sheet) {
  return {0.5 * (sheet.x_min + sheet.x_max), 0.5 * (sheet.y_min + sheet.y_max)};
}

/// The controller pays out lengths by its settings for each command; the map gives the tool's
/// position for them.
tl::expected<CutSquare, SquareRefusal> by_map(const SquareTask& task, const GcodeMachine& machine) {
  std::vector<BedPoint> cut;
  for (const BedPoint commanded : outline_of(task)) {
    const auto lengths = machine.controller.kinematics->lengths(commanded);
    if (!lengths)
      return tl::unexpected(SquareRefusal{"the controller", commanded, lengths.error().sentence()});
    const auto tool = machine.target.lengths->tool(*lengths);
    if (!tool) return tl::unexpected(SquareRefusal{"the map", commanded, tool.error().sentence()});
    cut.push_back(*tool);
  }
  return measured_square(task, std::move(cut));
}

std::string as_table(const CutSquare& square, const SquareTask& task) {
  std::string text =
      fmt::format("{:<18}{:>12}{:>12}{:>10}\n", "", "commanded_mm", "cut_mm", "bow_mm");
  for (const model::SquareSide side : model::kSquareSides) {
    const model::CutSide& cut = square.side(side);
    text += fmt::format("{:<18}{:>12.3f}{:>12.3f}{:>+10.3f}\n", kSideNames[as_size(side)],
                        task.size_mm, cut.length_mm, cut.bow_mm);
  }
  const double diagonal = task.size_mm * std::sqrt(2.0);
  text += fmt::format("{:<18}{:>12.3f}{:>12.3f}\n{:<18}{:>12.3f}{:>12.3f}\n", "diagonal rising",
                      diagonal, square.rising_diagonal_mm, "diagonal falling", diagonal,
                      square.falling_diagonal_mm);
  text += fmt::format("shifted by ({:+.3f}, {:+.3f}) mm and rotated by {:+.3f} mrad\n",
                      square.offset.x_mm, square.offset.y_mm, 1e3 * square.rotation_rad);
  return text;
}

std::string as_json(const CutSquare& square, const SquareTask& task) {
  std::string text = fmt::format("{{\n  \"size_mm\": {},\n  \"sides\": {{\n", task.size_mm);
  for (const model::SquareSide side : model::kSquareSides) {
    const model::CutSide& cut = square.side(side);
    text += fmt::format("    \"{}\": {{\"length_mm\": {}, \"bow_mm\": {}}}{}\n",
                        kSideNames[as_size(side)], cut.length_mm, cut.bow_mm,
                        side == model::SquareSide::bottom ? "" : ",");
  }
  text += fmt::format(
      "  }},\n  \"diagonals\": {{\"rising_mm\": {}, \"falling_mm\": {}}},\n"
      "  \"offset\": {{\"x_mm\": {}, \"y_mm\": {}}},\n  \"rotation_rad\": {}\n}}\n",
      square.rising_diagonal_mm, square.falling_diagonal_mm, square.offset.x_mm, square.offset.y_mm,
      square.rotation_rad);
  return text;
}

void advise(const SquareOptions& options, const SquareTask& task) {
  if (options.program.empty()) {
    Words again = {"square"};
    add_option_words(again, "--map", options.map);
    add_option_words(again, "--machine", options.machine);
    add_option_words(again, "--controller-machine", options.controller_machine);
    again.insert(again.end(),
                 {"--size-mm", fmt::format("{}", task.size_mm), "--at",
                  fmt::format("{}", task.corner.x_mm), fmt::format("{}", task.corner.y_mm)});
    if (task.below) again.push_back("--below");
    add_option_words(again, "--gcode", "square.nc");
    return say_next(again);
  }
  say("Cut {} and measure the four sides and both diagonals, each from an edge of one groove to "
      "the same edge of the other, so that the bit's width cancels. With the machine unchanged, "
      "the lengths are those under cut_mm.{}",
      options.program == "-" ? "the program" : options.program,
      options.map.empty() ? "" : " With a compensated program, they are those under commanded_mm.");
  if (options.map.empty()) return say_next({"gcode", "check", options.program});
  say_next({"gcode", "compensate", options.program, "--map", options.map, "-o",
            options.program == "-" ? "-" : compensated_name(options.program)});
}

/// The substitute for a map; null for two machines.
const KnownPlotter* plotter_of(const std::unique_ptr<const GcodeMachine>& machine) {
  return machine == nullptr ? nullptr : machine->target.as<KnownPlotter>();
}

int square_with(const SquareOptions& options, const std::unique_ptr<const GcodeMachine>& machine) {
  const KnownPlotter* plotter = plotter_of(machine);
  const SquareTask task =
      task_of(options, plotter == nullptr ? BedPoint{} : middle_of(machine->controller.sheet));
  const auto square = machine == nullptr ? by_machines(options, task) : by_map(task, *machine);
  if (!square) {
    const SquareRefusal& refusal = square.error();
    say("chaintrue square: {} cannot bring the tool to ({:.1f}, {:.1f}) mm: {}", refusal.who,
        refusal.commanded.x_mm, refusal.commanded.y_mm, refusal.why);
    return kNotSupportedOrOutside;
  }
  write_outputs({{"-", options.json ? as_json(*square, task) : as_table(*square, task)},
                 {options.drawing, draw_square(*square, task)},
                 {options.program, plotter == nullptr ? square_program(task, options.depth_mm)
                                                      : square_program(task, plotter->set)}});
  advise(options, task);
  return kDone;
}

int run_square(Verb verb, const SquareOptions& options) {
  const auto machine = options.map.empty() ? nullptr : machine_of(options);
  const Facts kind = machine == nullptr               ? facts::machine
                     : plotter_of(machine) != nullptr ? facts::plotter
                                                      : facts::map;
  verb.refuse_idle_options(kind | (options.program.empty() ? facts::nothing : facts::program));
  return square_with(options, machine);
}

}  // namespace

void add_square(Verb app) {
  auto [verb, c] = app.add_verb<SquareOptions>(
      "square", "Predict the sides, diagonals and bows of a test square, and write its program",
      R"(Examples:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue square --map map.json --size-mm 500 --gcode square.nc
  build/chaintrue square --machine fixtures/machines/classic.json --controller-machine fixtures/machines/believed_straight.json --size-mm 100 --at -1040 535 --below -o square.svg)",
      run_square, [](const SquareOptions& own) {
        if (own.map.empty()) {
          if (own.machine.empty()) missing_option("--map, or --machine,");
          if (own.controller_machine.empty()) missing_option("--controller-machine");
        }
      });
  verb.has(
      {{"--map", reads(c.map),
        "The machine that will cut it: a chaintrue_map, chaintrue_anchors, "
        "or the chaintrue_plotter that fit wrote for a drawing"},
       {"--machine", reads(c.machine),
        "Without a map: a chaintrue_machine file that describes the true machine with its "
        "effects"},
       {"--controller-machine", reads(c.controller_machine),
        "The controller's settings: a chaintrue_machine file, or one of the map's kind; by "
        "default those stored in the map"},
       {"--size-mm", {c.size_mm, {"mm", 1.0, 5000.0}}, "Length of a side"},
       {"--at",
        {c.at, {"mm", -20000.0, 20000.0}, 2},
        "X Y of the lower left corner [mm]; by default the square is centred on the bed"},
       {"--below", c.below, "Place the square below --at, which is then its upper left corner"},
       {"--json", c.json, "Print JSON with all digits instead of a table"},
       {"-o,--output", writes(c.drawing, {Origin::drawing}), "Write it as an SVG picture"},
       {"--gcode", writes(c.program, {Origin::program}), "Write the program that cuts it"},
       {"--depth-mm",
        {c.depth_mm, {"mm", 0.1, 100.0}},
        "With --gcode: depth of the holes",
        facts::program,
        "to be left out without --gcode",
        {{facts::map | facts::machine, "to be left out, because a plotter's pen has no depth"}}}});
  verb.excludes({"--machine"}, "--map");
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue square: the square that a person would cut and measure, predicted, when the controller
/// believes one machine and the machine is another.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "model/square.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/machine_input.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/square_drawing.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct SquareOptions {
  std::string machine;
  std::string controller_machine;
  double size_mm = 100.0;
  std::vector<double> at;
  bool below = false;
  bool json = false;
  std::string drawing;
};

constexpr const char* kSideNames[] = {"left", "top", "right", "bottom"};

model::SquareTask checked_task(const SquareOptions& options) {
  OptionProblems problems;
  problems.require("--size-mm", options.size_mm, 1.0, 5000.0);
  for (const double coordinate : options.at)
    problems.require("--at", coordinate, -20000.0, 20000.0);
  problems.throw_if_any();
  return {
      .size_mm = options.size_mm, .corner = {options.at[0], options.at[1]}, .below = options.below};
}

std::string as_table(const model::CutSquare& square, const model::SquareTask& task) {
  std::string text =
      fmt::format("{:<18}{:>12}{:>12}{:>10}\n", "", "commanded_mm", "cut_mm", "bow_mm");
  for (const model::SquareSide side : model::kSquareSides) {
    const model::CutSide& cut = square.side(side);
    text += fmt::format("{:<18}{:>12.3f}{:>12.3f}{:>+10.3f}\n",
                        kSideNames[static_cast<std::size_t>(side)],
                        task.size_mm,
                        cut.length_mm,
                        cut.bow_mm);
  }
  const double diagonal = task.size_mm * std::sqrt(2.0);
  text += fmt::format(
      "{:<18}{:>12.3f}{:>12.3f}\n", "diagonal rising", diagonal, square.rising_diagonal_mm);
  text += fmt::format(
      "{:<18}{:>12.3f}{:>12.3f}\n", "diagonal falling", diagonal, square.falling_diagonal_mm);
  text += fmt::format("moved as a whole by ({:+.3f}, {:+.3f}) mm and turned by {:+.3f} mrad\n",
                      square.offset.x_mm,
                      square.offset.y_mm,
                      1e3 * square.rotation_rad);
  return text;
}

std::string as_json(const model::CutSquare& square, const model::SquareTask& task) {
  std::string text = fmt::format("{{\n  \"size_mm\": {},\n  \"sides\": {{\n", task.size_mm);
  for (const model::SquareSide side : model::kSquareSides) {
    const model::CutSide& cut = square.side(side);
    text += fmt::format("    \"{}\": {{\"length_mm\": {}, \"bow_mm\": {}}}{}\n",
                        kSideNames[static_cast<std::size_t>(side)],
                        cut.length_mm,
                        cut.bow_mm,
                        side == model::SquareSide::bottom ? "" : ",");
  }
  text += fmt::format(
      "  }},\n  \"diagonals\": {{\"rising_mm\": {}, \"falling_mm\": {}}},\n"
      "  \"offset\": {{\"x_mm\": {}, \"y_mm\": {}}},\n  \"rotation_rad\": {}\n}}\n",
      square.rising_diagonal_mm,
      square.falling_diagonal_mm,
      square.offset.x_mm,
      square.offset.y_mm,
      square.rotation_rad);
  return text;
}

int run_square(const SquareOptions& options) {
  const model::SquareTask task = checked_task(options);
  const model::Machine machine = read_machine_input(options.machine);
  const model::Machine believed = read_machine_input(options.controller_machine);
  const auto square = model::predict_square(machine, believed, task);
  if (!square) {
    const model::SquareFailure& failure = square.error();
    fmt::print(stderr,
               "chaintrue square: {} cannot bring the tool to ({:.1f}, {:.1f}) mm: {}\n",
               failure.controllers ? "the controller" : "the machine",
               failure.commanded.x_mm,
               failure.commanded.y_mm,
               model::explain(failure.reason));
    return kNotSupportedOrOutside;
  }
  std::vector<files::OutputFile> outputs = {
      {"-", options.json ? as_json(*square, task) : as_table(*square, task)}};
  if (!options.drawing.empty()) outputs.push_back({options.drawing, draw_square(*square, task)});
  write_outputs(outputs);
  return kDone;
}

}  // namespace

void add_square(CLI::App& app, Run& run) {
  auto options = std::make_shared<SquareOptions>();
  CLI::App* verb = app.add_subcommand(
      "square", "Predict a test square: sides, diagonals and bows as a ruler would show them");
  add_input(*verb,
            "--machine",
            options->machine,
            "chaintrue_machine file: what the machine is, with its effects")
      ->required();
  add_input(*verb,
            "--controller-machine",
            options->controller_machine,
            "chaintrue_machine file: what the controller believes")
      ->required();
  add_number(*verb, "--size-mm", options->size_mm, {"mm", 1.0, 5000.0}, "Length of a side");
  verb->add_option("--at", options->at, "X Y of the lower left corner, mm")
      ->required()
      ->expected(2);
  verb->add_flag(
      "--below", options->below, "The square hangs below --at, which is its upper left corner");
  verb->add_flag("--json", options->json, "JSON, all digits, instead of a table");
  add_output(
      *verb, "-o,--output", options->drawing, {Origin::drawing}, "Draw it into this SVG file");
  verb->footer(
      "Example:\n"
      "  build/chaintrue square --machine fixtures/machines/classic.json --controller-machine "
      "fixtures/machines/believed_straight.json --size-mm 100 --at -1040 535 --below -o "
      "square.svg");
  verb->callback([options, &run] { run = [options] { return run_square(*options); }; });
}

}  // namespace chaintrue::cli

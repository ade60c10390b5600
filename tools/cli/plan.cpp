// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan: where to measure, as a list for the workshop, and how good the map will be.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/holes/holes_plan.hpp"
#include "grid/map/measurement_plan.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/holes_drawing.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct PlanOptions {
  std::string machine;
  grid::PlanRequest request;
  /// 0: points are planned.
  int holes = 0;
  grid::HolesPlanRequest hole_request;
  std::optional<double> margin_mm;
  double depth_mm = 3.0;
  double clearance_mm = 5.0;
  std::string gcode;
  std::string output = "-";
  std::string drawing;
};

void check_options(const PlanOptions& options, const model::Bed& bed) {
  OptionProblems problems;
  const grid::PlanRequest& request = options.request;
  problems.require("--points", request.points, grid::kFewestPlanned, grid::kMostPlanned);
  const double half = 0.5 * std::min(bed.width_mm, bed.height_mm);
  problems.require("--margin-mm", request.margin_mm, 0.0, std::max(0.0, half - 50.0));
  problems.require("--length-noise-mm", request.noise.length_mm, 0.001, 50.0);
  problems.require("--position-noise-mm", request.noise.position_mm, 0.001, 50.0);
  problems.throw_if_any();
}

std::string as_csv(const grid::MeasurementPlan& plan) {
  std::string text = "number,x_mm,y_mm\n";
  for (std::size_t i = 0; i < plan.marks.size(); ++i) {
    fmt::format_to(std::back_inserter(text),
                   "{},{:.0f},{:.0f}\n",
                   i + 1,
                   plan.marks[i].x_mm + 0.0,
                   plan.marks[i].y_mm + 0.0);
  }
  return text;
}

std::string in_words(const grid::MeasurementPlan& plan,
                     const PlanOptions& options,
                     const ExpectedErrors& errors) {
  std::string text = fmt::format("{} points: {} columns x {} rows, denser towards the edges",
                                 plan.marks.size(),
                                 plan.columns,
                                 plan.rows);
  if (plan.extra > 0) {
    text += fmt::format(", and {} where the error would be largest", plan.extra);
  }
  text += fmt::format(
      ".\nWalk row by row from the bottom left, turning round at the end of each.\n"
      "Expected error of the tool with {:g} mm noise in a length and {:g} mm in a position (one "
      "sigma): {:.2f} mm rms over the bed, {:.2f} mm at most, at ({:.0f}, {:.0f}).\n",
      options.request.noise.length_mm,
      options.request.noise.position_mm,
      errors.rms_mm,
      errors.largest_mm,
      errors.worst_at.x_mm,
      errors.worst_at.y_mm);
  if (errors.unanswered > 0) {
    text += fmt::format("On {:.1f} % of the bed the chains cannot hold the sled.\n",
                        100.0 * static_cast<double>(errors.unanswered) /
                            static_cast<double>(errors.cells_mm.size()));
  }
  return text;
}

void check_hole_options(const PlanOptions& options, const model::Bed& bed) {
  OptionProblems problems;
  const grid::HolesPlanRequest& request = options.hole_request;
  problems.require("--holes", request.holes, grid::kFewestPlannedHoles, grid::kMostPlannedHoles);
  if (request.distances != 0) {
    problems.require("--distances",
                     request.distances,
                     static_cast<double>(grid::kFewestHoleDistances),
                     request.holes * (request.holes - 1) / 2);
  }
  problems.require("--tape-sigma-mm", request.tape_sigma_mm, 0.001, 100.0);
  problems.require("--hole-sigma-mm", request.hole_sigma_mm, 0.0, 100.0);
  problems.require("--tape-length-mm", request.longest_mm, 500.0, 100000.0);
  problems.require("--depth-mm", options.depth_mm, 0.1, 100.0);
  problems.require("--clearance-mm", options.clearance_mm, 0.1, 100.0);
  const double half = 0.5 * std::min(bed.width_mm, bed.height_mm);
  problems.require("--margin-mm", request.margin_mm, 0.0, std::max(0.0, half - 200.0));
  problems.throw_if_any();
}

int plan_the_holes(PlanOptions options, const model::Machine& machine) {
  options.hole_request.holes = options.holes;
  options.hole_request.margin_mm = options.margin_mm.value_or(options.hole_request.margin_mm);
  check_hole_options(options, machine.bed);
  const auto plan = grid::plan_holes(machine, options.hole_request);
  if (!plan) {
    fmt::print(stderr, "chaintrue plan: {}\n", plan.error().sentence);
    return kNotSupportedOrOutside;
  }
  if (!options.drawing.empty()) files::write_whole_file(options.drawing, draw_holes_plan(*plan));
  if (!options.gcode.empty()) {
    files::write_whole_file(options.gcode,
                            holes_gcode(*plan, options.depth_mm, options.clearance_mm));
  }
  files::write_whole_file(options.output, workshop_list(*plan));
  fmt::print(stderr, "{}", plan_in_words(*plan, options.hole_request));
  return kDone;
}

int run_plan(PlanOptions options) {
  const files::ReadMachine read = files::read_machine_with_warnings(options.machine);
  for (const files::Warning& warning : read.warnings) fmt::print(stderr, "{}\n", warning.message());
  if (options.holes != 0) return plan_the_holes(std::move(options), read.machine);
  options.request.margin_mm = options.margin_mm.value_or(options.request.margin_mm);
  check_options(options, read.machine.bed);
  const auto plan = grid::plan_measurement(read.machine, options.request);
  if (!plan) {
    fmt::print(stderr, "chaintrue plan: {}\n", plan.error().sentence);
    return kNotSupportedOrOutside;
  }
  const ExpectedErrors errors = expected_errors(plan->map, read.machine.bed);
  if (!options.drawing.empty()) {
    files::write_whole_file(options.drawing, draw_plan(*plan, read.machine.bed, errors));
  }
  files::write_whole_file(options.output, as_csv(*plan));
  fmt::print(stderr, "{}", in_words(*plan, options, errors));
  return kDone;
}

}  // namespace

namespace {

void add_hole_options(CLI::App& verb, PlanOptions& options, CLI::Option* points) {
  verb.add_option("--holes",
                  options.holes,
                  fmt::format("Plan holes and tape distances instead: how many holes, {} to {}",
                              grid::kFewestPlannedHoles,
                              grid::kMostPlannedHoles))
      ->excludes(points);
  verb.add_option("--distances",
                  options.hole_request.distances,
                  "Of --holes: how many to measure; twice the holes and two more where unsaid");
  verb.add_option("--tape-sigma-mm",
                  options.hole_request.tape_sigma_mm,
                  "Of --holes: one sigma of a tape reading")
      ->capture_default_str();
  verb.add_option("--hole-sigma-mm",
                  options.hole_request.hole_sigma_mm,
                  "Of --holes: one sigma of a hole beside where its chains put it, on each axis")
      ->capture_default_str();
  verb.add_option("--tape-length-mm", options.hole_request.longest_mm, "Of --holes: the tape's")
      ->capture_default_str();
  verb.add_option("--gcode", options.gcode, "Of --holes: write a program that drills them");
  verb.add_option("--depth-mm", options.depth_mm, "Of --gcode: how deep")->capture_default_str();
  verb.add_option("--clearance-mm", options.clearance_mm, "Of --gcode: how high between holes")
      ->capture_default_str();
}

}  // namespace

void add_plan(CLI::App& app, Run& run) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* verb = app.add_subcommand(
      "plan", "Where to measure: a list for the workshop, and how good the map will be");
  verb->add_option("--machine", options->machine, "chaintrue_machine file; - is standard input")
      ->required();
  auto* points =
      verb->add_option("--points",
                       options->request.points,
                       fmt::format("How many, {} to {}", grid::kFewestPlanned, grid::kMostPlanned))
          ->capture_default_str();
  verb->add_option("--margin-mm",
                   options->margin_mm,
                   "From the bed's edge to the outermost marks; 10 for points, 50 for holes");
  add_hole_options(*verb, *options, points);
  verb->add_option("--length-noise-mm",
                   options->request.noise.length_mm,
                   "Noise of a chain length, one sigma")
      ->capture_default_str();
  verb->add_option("--position-noise-mm",
                   options->request.noise.position_mm,
                   "Noise of a mark's position, one sigma")
      ->capture_default_str();
  verb->add_option("-o,--output", options->output, "The list (CSV); - is standard output")
      ->capture_default_str();
  verb->add_option("--svg",
                   options->drawing,
                   "Draw the points over the expected error of the map, or the holes and their "
                   "distances, into this SVG file");
  verb->footer(
      "The list goes row by row from the bottom left, turning round at the end of each row;\n"
      "chaintrue simulate --marks takes it. The expected error is told on standard error.\n"
      "With --holes the list is a holes file: write the tape's readings into it and hand it to\n"
      "chaintrue fit with --machine.\n\n"
      "Example:\n"
      "  build/chaintrue plan --machine fixtures/machines/classic.json --points 28 -o plan.csv "
      "--svg plan.svg\n"
      "  build/chaintrue plan --machine fixtures/machines/classic.json --holes 9 "
      "--tape-sigma-mm 0.5 -o holes.csv --gcode holes.nc --svg holes.svg");
  verb->callback([options, &run] { run = [options] { return run_plan(*options); }; });
}

}  // namespace chaintrue::cli

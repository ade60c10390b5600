// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan: where to measure, as a list for the workshop, and the expected error of the map;
/// and after a diagnosis, what to measure next.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/planning/check_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "model/chains/chain_changes.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

std::string draw(const grid::CheckPlan& plan, const CompensationMap& map) {
  std::vector<FollowUpPlace> next;
  for (const MarkPoint& mark : plan.marks)
    next.push_back({.numbers = fmt::format("{}", next.size() + 1), .mark = mark});
  return draw_follow_up(mapped(map.contents().points, &MapPoint::mark), next, map.machine()->bed);
}

/// Whether a worn chain would be distinguished from a shifted zero. Three sigmas are one chance in
/// 400, two one in 20.
std::string_view detectable_change(const PerSide<double>& sigmas) {
  const double least = std::min(sigmas.left, sigmas.right);
  if (least >= 3.0) return "will certainly show it";
  if (least >= 2.0) return "will probably show it";
  return "may miss it, so that more points or better readings are needed";
}

struct PlanOptions {
  std::string machine;
  PlanAfterOptions follow_up;
  /// 0 holes: points are planned instead.
  HolesPlanRequest holes{.holes = 0, .progress = {}};
  /// The map to check later; empty for other plans.
  std::string check;
  std::optional<int> points;
  int second_visits = 0;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::optional<double> margin_mm;
  PlanOutputs outputs;
  std::string measure;
};

std::string in_words(const grid::MeasurementPlan& plan, const grid::observation::PointNoise& noise,
                     const ExpectedErrors& errors) {
  std::string text = fmt::format("{} points: {} columns x {} rows, denser towards the edges",
                                 plan.marks.size(), plan.columns, plan.rows);
  if (plan.extra > 0) {
    text += fmt::format(", and {} where the error would be largest", plan.extra);
  }
  text += fmt::format(
      ".\nMeasure row by row from the bottom left, turning back at the end of each.\nExpected "
      "error of the tool with {:g} mm noise in a length and {:g} mm in a position (one sigma): "
      "{:.2f} mm rms over the bed, {:.2f} mm at most, at ({:.0f}, {:.0f}).\n",
      noise.length_mm, noise.position_mm, errors.rms_mm, errors.largest_mm, errors.worst_at.x_mm,
      errors.worst_at.y_mm);
  if (errors.unanswered > 0) {
    text += fmt::format("On {:.1f} % of the bed the chains cannot hold the sled.\n",
                        100.0 * as_double(errors.unanswered) / as_double(errors.cells_mm.size()));
  }
  return text;
}

/// \param is_drilled the program drills its marks or holes
Facts with_program(const PlanOptions& options, Facts facts, bool is_drilled) {
  if (options.outputs.gcode.empty()) return facts;
  return facts | facts::program | (is_drilled ? facts::drilled : facts::nothing);
}

bool drills_marks(const PlanOptions& options, const Machine* machine) {
  return sheet_of(options.measure, machine) == SheetOf::places;
}

int run_follow_up(Verb verb, PlanOptions options) {
  const InputFile file = open_input(options.follow_up.file);
  verb.refuse_idle_options(with_program(options, facts_after(file), false));
  options.follow_up.machine = options.machine;
  options.follow_up.output = options.outputs.list;
  options.follow_up.drawing = options.outputs.drawing;
  return plan_after(options.follow_up, file);
}

/// Options replace a plan's usual values.
void take(std::optional<double> said, double& value) { value = said.value_or(value); }

int run_check_plan(Verb verb, const PlanOptions& options) {
  grid::CheckPlanRequest request;
  request.points = options.points.value_or(request.points);
  take(options.length_noise_mm, request.length_mm);
  take(options.position_noise_mm, request.position_mm);
  const CompensationMap map = load_map(open_input(options.check));
  const Machine* machine = map.machine();
  request.margin_mm =
      options.margin_mm.value_or(machine == nullptr ? kReachableMm : reachable_mm(machine->bed));
  verb.refuse_idle_options(with_program(options, facts::check, drills_marks(options, machine)));
  OptionProblems problems;
  problems.require("--points", request.points, grid::kFewestCheckPoints, grid::kMostCheckPoints);
  if (machine != nullptr) require_margin(problems, request.margin_mm, machine->bed);
  problems.throw_if_any();
  const grid::CheckPlan plan =
      value_of(plan_check(map, request), "chaintrue plan", kNotSupportedOrOutside);
  const auto& [left, right] = plan.expected_sigmas;
  Outputs outputs =
      sheet_outputs({plan.marks, sheet_of(options.measure, machine)}, *machine,
                    {request.length_mm, request.position_mm, StatedNoise{}.dof}, options.outputs,
                    fmt::format("\"expected_sigmas\": [{}, {}]", left, right));
  outputs.push_back({options.outputs.drawing, draw(plan, map)});
  write_outputs(outputs);
  say("{} points for chaintrue check. If one chain's links grow by {:g} %, they {}: its effect is "
      "{:.1f} times the scatter of the readings (left chain), {:.1f} times (right).",
      plan.marks.size(), 100.0 * model::kPitchGrowthSigma, detectable_change(plan.expected_sigmas),
      left, right);
  say_next({"check", options.check, options.outputs.list});
  return kDone;
}

int run_marks_plan(const PlanOptions& options, const Machine& machine) {
  grid::PlanRequest request;
  request.points = options.points.value_or(request.points);
  request.margin_mm = options.margin_mm.value_or(reachable_mm(machine.bed));
  take(options.length_noise_mm, request.noise.length_mm);
  take(options.position_noise_mm, request.noise.position_mm);
  const grid::observation::PointNoise& noise = request.noise;
  OptionProblems problems;
  const auto require_second_visits = [&](int marks) {
    problems.require("--second-visits", options.second_visits, 0, marks / 3);
  };
  problems.require("--points", request.points, grid::kFewestPlanned, grid::kMostPlanned);
  require_second_visits(request.points);
  require_margin(problems, request.margin_mm, machine.bed);
  problems.require("--position-noise-mm", noise.position_mm, 0.001, 50.0);
  problems.throw_if_any();
  const grid::MeasurementPlan plan =
      value_of(plan_measurement(machine, request), "chaintrue plan", kNotSupportedOrOutside);
  // A small bed has room for fewer marks than were asked for.
  require_second_visits(as_int(plan.marks.size()));
  problems.throw_if_any();
  const ExpectedErrors errors = expected_errors(plan.map, machine.bed);
  Outputs outputs = sheet_outputs(
      {plan.marks, sheet_of(options.measure, &machine),
       grid::with_second_visits(plan.marks.size(), as_size(options.second_visits))},
      machine, {noise.length_mm, noise.position_mm, StatedNoise{}.dof}, options.outputs,
      fmt::format("\"expected_rms_mm\": {}, \"expected_largest_mm\": {}", errors.rms_mm,
                  errors.largest_mm));
  outputs.push_back({options.outputs.drawing, draw_plan(plan, machine.bed, errors)});
  write_outputs(outputs);
  say_lines(in_words(plan, noise, errors));
  say_next_of_sheet(options.outputs, options.machine);
  return kDone;
}

int run_plan(Verb verb, PlanOptions options) {
  if (!options.follow_up.after.empty()) return run_follow_up(verb, std::move(options));
  if (!options.check.empty()) return run_check_plan(verb, options);
  const bool of_tape = options.holes.holes != 0;
  const Machine machine = read_machine_input(options.machine);
  verb.refuse_idle_options(with_program(options, of_tape ? facts::tape : facts::lattice,
                                        of_tape || drills_marks(options, &machine)));
  if (!of_tape) return run_marks_plan(options, machine);
  options.holes.margin_mm = options.margin_mm.value_or(reachable_mm(machine.bed));
  const int code = plan_the_holes(options.holes, machine, options.outputs);
  if (code == kDone) say_next_of_sheet(options.outputs, options.machine);
  return code;
}

}  // namespace

void add_plan(Verb app) {
  using namespace facts;
  auto [verb, c] = app.add_verb<PlanOptions>(
      "plan",
      "Plan where to measure: a list for the workshop, and the expected accuracy of the map",
      R"(The list runs row by row from the bottom left, back and forth;
chaintrue simulate --marks reads it. The expected error is printed on standard error.
Fill in the list (in an editor or a spreadsheet) and hand it to chaintrue fit, diagnose or
check as it is, a CSV with --machine. Empty cells are left out, with a note.

Examples:
  build/chaintrue plan --machine fixtures/machines/classic.json --points 28 -o plan.csv --svg plan.svg
  build/chaintrue plan --machine fixtures/machines/groundcontrol.json -o marks.csv --gcode marks.nc --page marks.html
  build/chaintrue diagnose fixtures/grids/seven_by_four.json -o diagnosis.json
  build/chaintrue plan fixtures/grids/seven_by_four.json --after diagnosis.json
  build/chaintrue plan --machine fixtures/machines/classic.json --holes 9 --tape-sigma-mm 0.5 -o holes.csv --gcode holes.nc --svg holes.svg
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue plan --check map.json -o five.csv --svg five.svg)",
      run_plan, [](const PlanOptions& own) {
        if (own.follow_up.after.empty() && !own.follow_up.file.empty()) missing_option("--after");
        if (own.follow_up.after.empty() && own.check.empty() && own.machine.empty())
          missing_option("--machine");
      });
  const grid::PlanRequest usual;
  const grid::CheckPlanRequest usual_check;
  const auto noise_words = [](const char* what, double usually_mm, double in_check_mm) {
    return fmt::format("Standard deviation (1 sigma) of {}; {:g} by default, {:g} with --check",
                       what, usually_mm, in_check_mm);
  };
  verb.has(
      {{"--machine", reads(c.machine),
        "chaintrue_machine file; - is standard input. With --after only if the grid has none; "
        "not with --check",
        lattice | tape | chains,
        "to be left out, because maps to check and belts contain their machine"},
       {"grid", reads(c.follow_up.file),
        "With --after: the points, holes or belts measured so far"},
       {"--after", reads(c.follow_up.after),
        "A chaintrue_diagnosis of those points: plan what to measure "
        "next, and the lines to add to the file"},
       {"--with", reads(c.follow_up.with),
        "With --after: the other files of the same diagnosis, as given to diagnose --with", chains,
        "to be left out, because belts are diagnosed separately"},
       {"--points",
        {c.points, {"", 1.0, 1000.0}},
        fmt::format(
            "Number of marks, {} to {}, {} by default; with --check {} to {}, {} by default",
            grid::kFewestPlanned, grid::kMostPlanned, usual.points, grid::kFewestCheckPoints,
            grid::kMostCheckPoints, usual_check.points),
        planned_marks,
        "to be left out with --after, because the diagnosis determines the number"},
       {"--second-visits",
        {c.second_visits, {"", 0.0, 66.0}},
        "Number of marks measured twice, the first one at the end; they show changes during "
        "the session",
        lattice,
        "to be left out, because it applies to new marks in columns and rows only"},
       {"--check", reads(c.check),
        "Plan the few points that best show later whether this chaintrue_map still holds"},
       {"--margin-mm",
        {c.margin_mm, {"mm", 0.0, 10000.0}},
        fmt::format("Distance from the bed's edge to the outermost marks: {:g} by default, on a "
                    "small bed a fifth of its shorter side. Closer to the edge, a sled tips over",
                    kReachableMm),
        planned,
        "to be left out with --after, because the diagnosis determines the places"},
       {"--holes",
        {c.holes.holes, {"", grid::kFewestPlannedHoles, grid::kMostPlannedHoles}},
        fmt::format("Plan this number of holes, {} to {}, and tape distances between them",
                    grid::kFewestPlannedHoles, grid::kMostPlannedHoles),
        lattice | tape,
        "to be left out with --after and --check, which plan something else"}});
  add_tape_options(verb, c.holes);
  verb.has(
      {{"--tape-length-mm",
        {c.holes.longest_mm, {"mm", 500.0, 100000.0}},
        "With --holes: length of the tape",
        tape,
        "to be left out without --holes"},
       {"--length-noise-mm",
        {c.length_noise_mm, {"mm", 0.001, 50.0}},
        noise_words("a chain length", usual.noise.length_mm, usual_check.length_mm),
        planned_marks,
        "to be left out, because it applies to chain lengths read at marks only"},
       {"--position-noise-mm",
        {c.position_noise_mm, {"mm", 0.0, 50.0}},
        noise_words("a mark's position", usual.noise.position_mm, usual_check.position_mm),
        planned_marks,
        "to be left out, because it applies to positions measured at marks only"},
       {"--measure",
        {c.measure, {"places", "lengths"}},
        "What you will measure. places: you send the controller to each mark and measure "
        "the tool's position. lengths: you bring the tool to each mark and read both "
        "chains. Default: places if the machine has a controller, otherwise lengths",
        planned_marks,
        "to be left out, because it applies to readings at marks only"},
       {"-o,--output", writes(c.outputs.list, {Origin::list, Origin::measured}),
        "The list with empty cells to fill in: CSV, or JSON if the name ends in .json; - is "
        "standard output"},
       {"--json", c.outputs.json,
        "Print the list as JSON, including the machine; if the list goes to a file, the "
        "places and the expected error",
        planned, "to be left out with --after, because the lines match their file"},
       {"--page", writes(c.outputs.page, {Origin::page}),
        "Write a page to print: the bed, the instructions, and lines to fill in", planned,
        "to be left out with --after, which prints lines for a file"},
       {"--gcode", writes(c.outputs.gcode, {Origin::program}),
        "Write a program that drills the marks in order, or stops above each one if lengths "
        "are to be read",
        planned, "to be left out with --after, which prints lines for a file"},
       {"--depth-mm",
        {c.outputs.drill.depth_mm, {"mm", 0.1, 100.0}},
        "With --gcode: depth of the holes",
        program,
        "to be left out without --gcode",
        {{drilled,
          "to be left out, because a program for lengths stops above each mark without drilling"}}},
       {"--clearance-mm",
        {c.outputs.drill.clearance_mm, {"mm", 0.1, 100.0}},
        "With --gcode: height of travel between holes",
        program,
        "to be left out without --gcode"},
       {"--svg", writes(c.outputs.drawing, {Origin::drawing}),
        "Write an SVG picture of the points over the expected error of the map, or of the "
        "holes and their distances"}});
  verb.needs({"--after"}, "grid");
  verb.needs({"--with"}, "--after");
  verb.excludes({"--check"}, "--after");
  verb.excludes({"--holes"}, "--points");
}

}  // namespace chaintrue::cli

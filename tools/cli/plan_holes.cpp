// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_holes.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <vector>

#include "grid/files/holes_file.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/holes_words.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

void check(const HolesPlanRequest& request, const Bed& bed) {
  OptionProblems problems;
  require_sound(problems, request);
  require_margin(problems, request.margin_mm, bed, grid::kLeastPlannedSideMm);
  problems.throw_if_any();
}

}  // namespace

void require_sound(OptionProblems& problems, const HolesPlanRequest& request) {
  if (request.distances == 0) return;
  problems.require("--distances", request.distances, grid::fewest_distances(request.edges),
                   grid::most_distances(request.holes, request.edges));
}

void add_tape_options(Verb verb, HolesPlanRequest& request) {
  verb.has({{"--distances",
             {request.distances, {"", 1.0, 10000.0}},
             "With --holes: number of distances to measure; by default twice the number of holes "
             "plus two, and six more with --edges",
             facts::tape,
             "to be left out without --holes"},
            {"--edges", request.edges,
             "With --holes: also measure to the sheet's edges, so that jobs are placed "
             "correctly on the sheet",
             facts::tape, "to be left out without --holes"},
            {"--tape-sigma-mm",
             {request.tape_sigma_mm, files::kTapeSigmaMm},
             "With --holes: standard deviation (1 sigma) of a tape reading",
             facts::tape,
             "to be left out without --holes"},
            {"--hole-sigma-mm",
             {request.hole_sigma_mm, files::kHoleSigmaMm},
             "With --holes: standard deviation (1 sigma) of a hole's position on each axis",
             facts::tape,
             "to be left out without --holes"}});
}

int plan_the_holes(HolesPlanRequest request, const Machine& machine, const PlanOutputs& wanted) {
  check(request, machine.bed);
  request.progress = shown_progress();
  const grid::HolesPlan plan =
      value_of(grid::plan_holes(machine, request), "chaintrue plan", kNotSupportedOrOutside);
  Outputs outputs = {
      {wanted.drawing, draw_holes_plan(plan)},
      {wanted.page, holes_page(plan, wanted.list)},
      {wanted.gcode, holes_gcode(plan, wanted.drill)},
      {wanted.list, is_json_wanted(wanted.json, wanted.list) ? files::write_holes_sheet(plan.set)
                                                             : workshop_list(plan)}};
  std::vector<MarkPoint> holes;
  for (const grid::Hole& hole : plan.set.holes)
    holes.push_back(model::identity_placement(hole.commanded));
  add_answer(holes, {}, fmt::format("\"expected_rms_mm\": {}", plan.expected_rms_mm), wanted,
             outputs);
  write_outputs(outputs);
  say_lines(plan_in_words(plan, request));
  return kDone;
}

}  // namespace chaintrue::cli

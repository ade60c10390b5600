// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/plan_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "model/chains/chain_changes.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/plan_drawing.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

void check_options(const grid::CheckPlanRequest& request, const CompensationMap& map) {
  OptionProblems problems;
  problems.require("--points", request.points, grid::kFewestCheckPoints, grid::kMostCheckPoints);
  if (const Machine* machine = map.machine()) {
    const double half = 0.5 * std::min(machine->bed.width_mm, machine->bed.height_mm);
    problems.require("--margin-mm", request.margin_mm, 0.0, std::max(0.0, half - 50.0));
  }
  problems.throw_if_any();
}

std::string draw(const grid::CheckPlan& plan, const CompensationMap& map) {
  FollowUpDrawing drawing;
  for (const grid::MapPoint& point : map.contents().points) drawing.measured.push_back(point.mark);
  for (std::size_t i = 0; i < plan.marks.size(); ++i)
    drawing.next.push_back({fmt::format("{}", i + 1), plan.marks[i]});
  return draw_follow_up(drawing, map.machine()->bed);
}

/// Whether a worn chain would be distinguished from a shifted zero. Three sigmas are one chance in
/// 400, two one in 20.
std::string_view detectable_change(const model::PerSide<double>& sigmas) {
  const double least = std::min(sigmas.left, sigmas.right);
  if (least >= 3.0) return "will certainly show it";
  if (least >= 2.0) return "will probably show it";
  return "may miss it, so that more points or better readings are needed";
}

}  // namespace

int plan_the_check(const CompensationMap& map,
                   const CheckPlanOptions& options,
                   const PlanOutputs& wanted) {
  check_options(options.request, map);
  const auto plan = grid::plan_check(map, options.request);
  if (!plan) throw Failed("chaintrue plan", plan.error(), kNotSupportedOrOutside);
  const Sheet sheet{plan->marks, sheet_of(options.measure, map.machine())};
  std::vector<files::OutputFile> outputs =
      sheet_outputs(sheet,
                    *map.machine(),
                    {options.request.length_mm, options.request.position_mm, StatedNoise{}.dof},
                    wanted,
                    fmt::format("\"expected_sigmas\": [{}, {}]",
                                plan->expected_sigmas.left,
                                plan->expected_sigmas.right));
  if (!wanted.drawing.empty()) outputs.push_back({wanted.drawing, draw(*plan, map)});
  write_outputs(outputs);
  fmt::print(stderr,
             "{} points for chaintrue check. If one chain's links grow by {:g} %, they {}: its "
             "effect is {:.1f} times the scatter of the readings (left chain), {:.1f} times "
             "(right).\n",
             plan->marks.size(),
             100.0 * model::kPitchGrowthSigma,
             detectable_change(plan->expected_sigmas),
             plan->expected_sigmas.left,
             plan->expected_sigmas.right);
  say_next({"check", options.map, wanted.list});
  return kDone;
}

}  // namespace chaintrue::cli

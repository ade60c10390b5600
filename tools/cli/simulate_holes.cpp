// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/simulate_holes.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "grid/files/holes_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/plan_holes.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

int simulate_the_holes(const HolesOptions& options,
                       const model::Machine& stated,
                       const model::Machine& truth,
                       const grid::synthetic::HolesSpec& spec,
                       const std::string& output) {
  OptionProblems problems;
  require_sound(problems, options.plan);
  problems.require("--hook-offset-mm", options.hook_offset_mm, -1000.0, 1000.0);
  problems.require("--tape-rounding-mm", options.rounding_mm, 0.0, 100.0);
  for (const model::MachineProblem& problem : model::problems_of(truth)) {
    problems.add(
        "--offset", fmt::format("{} = {}", problem.parameter, problem.value), problem.expected);
  }
  problems.throw_if_any();
  auto plan = grid::plan_holes(stated, options.plan);
  if (!plan) {
    fmt::print(stderr, "chaintrue simulate: {}\n", plan.error().sentence);
    return kNotSupportedOrOutside;
  }
  grid::MeasuredHoles design = std::move(plan->set);
  design.name = fmt::format("simulated, seed {}", spec.seed);
  design.tape.hook_offset_mm = options.hook_offset_mm;
  grid::synthetic::HolesSpec with = spec;
  with.rounding_mm = options.rounding_mm;
  const auto made = grid::synthetic::simulate_holes(design, with, truth);
  if (!made) {
    fmt::print(stderr, "chaintrue simulate: {}\n", made.error().sentence);
    return kNotSupportedOrOutside;
  }
  write_output(output, grid::files::write_holes(made->set));
  return kDone;
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/simulate_options.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "grid/files/answer_file.hpp"
#include "grid/files/holes_file.hpp"
#include "model/calibration/setting.hpp"
#include "tools/cli/failed.hpp"
#include "tools/cli/plan_holes.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

void check_values(const SimulateOptions& options, const Machine& stated, OptionProblems& problems) {
  require_sound(problems, options.holes.plan);
  if (options.margin_mm)
    require_margin(problems, *options.margin_mm, stated.bed, grid::kLeastPlannedSideMm);
}

std::vector<synthetic::SettingOffset> offsets_of(const SimulateOptions& options,
                                                 OptionProblems& problems) {
  std::vector<synthetic::SettingOffset> offsets = parse_offsets(options.offsets, problems);
  for (const synthetic::SettingOffset& offset : offsets) {
    if (offset.setting < model::Setting::sheet_x_mm || options.holes.plan.edges) continue;
    problems.add(
        "--offset",
        std::string(model::name(offset.setting)),
        "a setting of the machine; without --edges the distances do not depend on the sheet",
        ProblemKind::unknown_word);
  }
  return offsets;
}

synthetic::HolesSpec spec_of(const SimulateOptions& options,
                             const Machine& stated,
                             OptionProblems& problems) {
  synthetic::HolesSpec spec;
  spec.hidden = parse_effects(options.effects, stated, problems);
  spec.draw_settings = options.draw_settings;
  spec.rounding_mm = options.holes.rounding_mm;
  spec.bad_readings = options.bad.count;
  spec.bad_size_mm = options.bad.size_mm;
  spec.seed = options.seed;
  return spec;
}

}  // namespace

int simulate_the_holes(const SimulateOptions& options, const Machine& stated) {
  OptionProblems problems;
  synthetic::HolesSpec spec = spec_of(options, stated, problems);
  const std::vector<synthetic::SettingOffset> offsets = offsets_of(options, problems);
  check_values(options, stated, problems);
  problems.throw_if_any();
  Machine truth = synthetic::hidden_truth(stated, spec);
  for (const synthetic::SettingOffset& offset : offsets)
    synthetic::offset_setting(truth, spec.sheet, offset);
  for (const model::MachineProblem& problem : model::problems_of(truth)) {
    problems.add("--offset",
                 fmt::format("{} = {}", problem.parameter, problem.value),
                 problem.expected,
                 ProblemKind::impossible);
  }
  problems.throw_if_any();
  HolesPlanRequest request = options.holes.plan;
  request.margin_mm = options.margin_mm.value_or(request.margin_mm);
  MeasuredHoles design =
      value_of(grid::plan_holes(stated, request), "chaintrue simulate", kNotSupportedOrOutside).set;
  if (spec.bad_readings > static_cast<int>(design.distances.size())) {
    problems.add("--bad-points",
                 fmt::format("{}", spec.bad_readings),
                 fmt::format("at most one for each of the {} distances", design.distances.size()),
                 ProblemKind::out_of_range);
    problems.throw_if_any();
  }
  design.name = options.name.empty() ? fmt::format("simulated, seed {}", spec.seed) : options.name;
  design.tape.tape_zero_offset_mm = options.holes.tape_zero_offset_mm;
  const auto made = synthetic::simulate_holes(design, spec, truth);
  if (!made) {
    say("chaintrue simulate: {}", made.error().sentence());
    return kNotSupportedOrOutside;
  }
  write_outputs({{options.answer, files::write_answer(*made, spec)},
                 {options.output, files::write_holes(made->set)}});
  return kDone;
}

}  // namespace chaintrue::cli

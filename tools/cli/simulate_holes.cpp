// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "tools/cli/simulate_options.hpp"

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
  require_sound(problems, options.holes);
  if (options.spec.design.margin_mm)
    require_margin(problems, *options.spec.design.margin_mm, stated.bed, grid::kLeastPlannedSideMm);
}

std::vector<synthetic::SettingOffset> offsets_of(const SimulateOptions& options,
                                                 OptionProblems& problems) {
  std::vector<synthetic::SettingOffset> offsets = parse_offsets(options.offsets, problems);
  for (const synthetic::SettingOffset& offset : offsets) {
    if (offset.setting < model::Setting::sheet_x_mm || options.holes.edges) continue;
    problems.add(
        "--offset", std::string(model::name(offset.setting)),
        "a setting of the machine; without --edges the distances do not depend on the sheet",
        ProblemKind::unknown_word);
  }
  return offsets;
}

synthetic::HolesSpec spec_of(const SimulateOptions& options, const Machine& stated,
                             OptionProblems& problems) {
  synthetic::HolesSpec spec;
  spec.hidden = parse_effects(options.effects, stated, problems);
  spec.draw_settings = options.spec.draw_settings;
  spec.rounding_mm = options.tape_rounding_mm;
  spec.bad_readings = options.spec.bad.count;
  spec.bad_size_mm = options.spec.bad.size_mm;
  spec.seed = options.spec.seed;
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
  throw_if_impossible(truth, problems);
  HolesPlanRequest request = options.holes;
  request.margin_mm = options.spec.design.margin_mm.value_or(request.margin_mm);
  MeasuredHoles design =
      value_of(grid::plan_holes(stated, request), "chaintrue simulate", kNotSupportedOrOutside).set;
  require_bad_points(options, design.distances.size(), "distances", problems);
  problems.throw_if_any();
  design.name = options.title();
  design.tape.tape_zero_offset_mm = options.tape_zero_offset_mm;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "grid/files/answer_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "model/belts/belt_effects.hpp"
#include "model/calibration/setting.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/simulate_options.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace {

/// A machine with the effects of its file.
struct StatedBelts {
  BeltMachine machine;
  std::vector<AppliedEffect> causes;  ///< fitted together with the anchors
};

StatedBelts belts_of(const std::string& path) {
  const InputFile file = open_input(path);
  require_kind(file, {FileKind::belts, FileKind::anchors});
  const bool is_fitted = file.kind == FileKind::anchors;
  StatedBelts stated;
  if (is_fitted) {
    BeltsFit fit = load_anchors(file).fit;
    stated.machine = std::move(fit.machine);
    for (grid::CauseInAnchorFit& own : fit.causes)
      stated.causes.push_back(
          {std::move(own.effect), std::move(own.side), std::move(own.parameters)});
  } else {
    stated.machine = load_belts(file, "a simulation").belts.machine;
  }
  if (!stated.machine.anchors_known) {
    refuse(file.name, is_fitted ? "/fit/machine/anchors" : "/machine/anchors", "",
           "x_mm and y_mm of all four anchors, which the simulation needs; chaintrue "
           "fit finds them");
  }
  return stated;
}

/// Adds the causes of the file; those of --effect replace them.
void add_causes(std::vector<AppliedEffect> causes, synthetic::BeltsSpec& spec) {
  for (AppliedEffect& own : causes) {
    const bool is_given = any_of(spec.hidden, [&](const auto& hidden) {
      return hidden.effect == own.effect && hidden.side == own.side;
    });
    if (!is_given) spec.hidden.push_back(std::move(own));
  }
}

/// "9x7".

/// `tl_x_mm=5`: truth less stated.
void take_offset(const std::string& text, BeltMachine& truth, OptionProblems& problems) {
  const auto offset = named_number(text);
  const std::string what = offset ? offset->name : "";
  const auto belt = model::belt_of(what.substr(0, 2));
  const bool is_x = what.size() > 2 && what.substr(2) == "_x_mm";
  const bool is_y = what.size() > 2 && what.substr(2) == "_y_mm";
  const bool is_free = belt && *belt != Belt::bl && (is_x || (is_y && is_upper(*belt)));
  if (!is_free) {
    problems.add("--offset", text,
                 "tl_x_mm, tl_y_mm, tr_x_mm, tr_y_mm or br_x_mm, true minus the file's value, as "
                 "in tl_x_mm=5",
                 ProblemKind::bad_syntax);
    return;
  }
  (is_x ? truth.anchors[*belt].x_mm : truth.anchors[*belt].y_mm) += offset->value;
}

/// "1,1.6".
void take_pulls(const std::string& text, synthetic::BeltsSpec& spec, OptionProblems& problems) {
  if (text.empty()) return;
  for (const grid::BeltPull& pull : files::pulls_of(text, "--pulls")) {
    if (pull.unit != grid::BeltPull::Unit::relative)
      return problems.add("--pulls", text, "ratios, as in 1,1.6", ProblemKind::bad_syntax);
    spec.pulls.push_back(pull.value);
  }
}

synthetic::BeltsSpec spec_of(const SimulateOptions& options, OptionProblems& problems) {
  synthetic::BeltsSpec spec;
  take_size(options.grid, 100, "columns x rows of places, 2 to 100 of each, as in 9x7", spec,
            problems);
  take_pulls(options.pulls, spec, problems);
  spec.noise_mm = options.spec.noise.length_mm;
  spec.heavy_tails = options.spec.noise.heavy_tails;
  spec.rounding_mm = options.spec.noise.length_rounding_mm;
  spec.bad_readings = options.spec.bad.count;
  spec.bad_size_mm = options.spec.bad.size_mm;
  spec.seed = options.spec.seed;
  spec.hidden = parse_effect_words(options.effects, problems);
  for (const MachineProblem& problem :
       effects::problems_in(model::belts::belt_effects(), spec.hidden)) {
    std::size_t index = 0;
    std::from_chars(problem.parameter.data() + 1,
                    problem.parameter.data() + problem.parameter.size(), index);
    // Malformed effects are already reported.
    if (spec.hidden[index].effect.empty()) continue;
    problems.add("--effect", problem.value + " in " + options.effects[index], problem.expected,
                 ProblemKind::impossible);
  }
  require_bad_points(options, as_size(spec.columns) * as_size(spec.rows), "places", problems);
  return spec;
}

}  // namespace

int simulate_the_belts(const SimulateOptions& options) {
  StatedBelts stated = belts_of(options.belts);
  OptionProblems problems;
  synthetic::BeltsSpec spec = spec_of(options, problems);
  BeltMachine truth = stated.machine;
  for (const std::string& offset : options.offsets) take_offset(offset, truth, problems);
  problems.throw_if_any();
  add_causes(std::move(stated.causes), spec);
  auto made = simulate_belts(stated.machine, truth, spec);
  if (!made) {
    say("chaintrue simulate: the command ({:.1f}, {:.1f}) mm cannot be reached: {}",
        made.error().place.x_mm, made.error().place.y_mm, made.error().sentence());
    return kNotSupportedOrOutside;
  }
  made->name = options.title();
  write_output(options.output, files::write_belts(*made));
  return kDone;
}

namespace {

void check_values(const SimulateOptions& options, const Machine& stated, OptionProblems& problems) {
  require_sound(problems, options.holes);
  if (options.spec.design.margin_mm)
    require_margin(problems, *options.spec.design.margin_mm, stated.bed, grid::kLeastPlannedSideMm);
}

std::vector<SettingOffset> offsets_of(const SimulateOptions& options, OptionProblems& problems) {
  std::vector<SettingOffset> offsets = parse_offsets(options.offsets, problems);
  for (const SettingOffset& offset : offsets) {
    if (offset.setting < Setting::sheet_x_mm || options.holes.edges) continue;
    problems.add(
        "--offset", std::string(name(offset.setting)),
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
  const std::vector<SettingOffset> offsets = offsets_of(options, problems);
  check_values(options, stated, problems);
  problems.throw_if_any();
  Machine truth = hidden_truth(stated, spec);
  for (const SettingOffset& offset : offsets) offset_setting(truth, spec.sheet, offset);
  throw_if_impossible(truth, problems);
  HolesPlanRequest request = options.holes;
  request.margin_mm = options.spec.design.margin_mm.value_or(request.margin_mm);
  MeasuredHoles design =
      value_of(plan_holes(stated, request), "chaintrue simulate", kNotSupportedOrOutside).set;
  require_bad_points(options, design.distances.size(), "distances", problems);
  problems.throw_if_any();
  design.name = options.title();
  design.tape.tape_zero_offset_mm = options.tape_zero_offset_mm;
  const auto made = simulate_holes(design, spec, truth);
  if (!made) {
    say("chaintrue simulate: {}", made.error().sentence());
    return kNotSupportedOrOutside;
  }
  write_outputs({{options.answer, files::write_answer(*made, spec)},
                 {options.output, files::write_holes(made->set)}});
  return kDone;
}

}  // namespace chaintrue::cli

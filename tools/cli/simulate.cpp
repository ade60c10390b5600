// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue simulate: a simulated grid measured on a machine with hidden effects, or the bare
/// readings at given places.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "grid/files/answer_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/names.hpp"
#include "grid/files/points_file.hpp"
#include "grid/files/ranges.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/sheet.hpp"
#include "tools/cli/simulate_options.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

/// Diagnose the hidden effects, if the noise of the points is known.
void say_next_of(const SimulateOptions& options) {
  const bool has_noise = options.holes.holes != 0 || options.spec.noise.length_mm > 0.0;
  if (options.effects.empty() || !has_noise)
    return say_next({"fit", options.output, "-o", "map.json"});
  say_next({"diagnose", options.output, "-o", "diagnosis.json"});
}

int simulate_session(const SimulateOptions& options, const Machine& machine) {
  const synthetic::SyntheticSpec spec = parse_spec(options, machine);
  auto session = generate(machine, spec, shown_progress());
  if (!session) {
    say("chaintrue simulate: the mark at ({:.1f}, {:.1f}) mm cannot be reached: {}",
        session.error().place.x_mm, session.error().place.y_mm, session.error().sentence());
    return kNotSupportedOrOutside;
  }
  session->grid.name = options.title();
  const std::string text = files::write_grid(session->grid);
  write_outputs({{options.answer, files::write_answer(session->answer)}, {options.output, text}});
  say_next_of(options);
  return kDone;
}

int simulate_places(const SimulateOptions& options, const Machine& machine) {
  OptionProblems problems;
  const std::vector<AppliedEffect> hidden = parse_effects(options.effects, machine, problems);
  problems.throw_if_any();
  std::vector<model::Visit> visits;
  for (const MarkPoint& place : files::read_points(options.points)) {
    visits.push_back({identity_placement(place), as_int(visits.size())});
  }
  synthetic::PlacesRead read =
      synthetic::read_places(machine, hidden, visits, options.spec.model, shown_progress());
  read.grid.name = options.name.empty() ? "readings at given places" : options.name;
  for (const auto& [index, reason] : read.unreachable) {
    say("chaintrue simulate: {}: point {} at ({:.1f}, {:.1f}) mm cannot be reached and is "
        "left out: {}",
        options.points, index, visits[index].position.x_mm, visits[index].position.y_mm,
        sentence_of(reason));
  }
  write_output(options.output, files::write_grid(read.grid));
  if (!read.unreachable.empty()) return kNotSupportedOrOutside;
  // Few readings are only for viewing; a map needs at least as many as a plan has.
  if (as_int(read.grid.points.size()) >= grid::kFewestPlanned) {
    say_next_of(options);
  } else {
    say_next({"simulate", "--machine", options.machine, "--grid", "7x4", "-o", "grid.json"});
  }
  return kDone;
}

Facts facts_of(const SimulateOptions& options) {
  if (!options.belts.empty()) return facts::belts;
  if (!options.grid.empty()) return facts::lattice;
  if (!options.marks.empty()) return facts::marks;
  if (!options.points.empty()) return facts::places;
  return options.holes.holes != 0 ? facts::tape : facts::scattered;
}

int run_simulate(Verb verb, const SimulateOptions& options) {
  verb.refuse_idle_options(facts_of(options));
  if (!options.belts.empty()) return simulate_the_belts(options);
  Machine machine = read_machine_input(options.machine);
  files::declare_effects(options.declared, machine);
  if (options.holes.holes != 0) {
    const int code = simulate_the_holes(options, machine);
    if (code == kDone) say_next_of(options);
    return code;
  }
  return options.points.empty() ? simulate_session(options, machine)
                                : simulate_places(options, machine);
}

std::optional<DesignKind> spacing(std::string_view word) {
  const auto kind = synthetic::design_kind(word);
  const bool is_lattice = kind == DesignKind::regular || kind == DesignKind::chebyshev;
  return is_lattice ? kind : std::nullopt;
}

std::optional<Model> model_of(std::string_view word) { return files::named(files::kModels, word); }

}  // namespace

void add_simulate(Verb app) {
  using namespace facts;
  auto [verb, c] = app.add_verb<SimulateOptions>(
      "simulate", "Simulate measurements on a machine with hidden effects",
      R"(Examples:
  build/chaintrue simulate --machine fixtures/machines/classic.json --grid 7x4 --jitter-mm 8 --length-noise-mm 0.2 --position-noise-mm 0.3 --repeats 6 --effect chain_pitch_error:left:elongation=0.0012 --seed 1 -o grid.json --answer answer.json
  printf 'x_mm,y_mm\n0,0\n' | build/chaintrue simulate --machine fixtures/machines/classic.json --points -
  build/chaintrue simulate --machine fixtures/machines/classic.json --holes 9 --distances 20 --tape-sigma-mm 0.5 --draw-settings --seed 1 -o holes.json
  build/chaintrue simulate --belts fixtures/belts/thirty_one_places.json --grid 9x9 --effect belt_stretch:-:elongation=0.004 --offset tl_x_mm=12 --seed 1 -o belts.json)",
      run_simulate, [](const SimulateOptions& own) {
        if (!own.belts.empty() && own.grid.empty()) {
          usage_error("simulate", "--belts needs --grid, columns x rows of places");
        }
      });
  auto machine = verb.add_choice("machine");
  machine.has(
      {{"--machine", reads(c.machine), "The chaintrue_machine file as its owner has it"},
       {"--belts", reads(c.belts),
        "A router on four belts instead: a chaintrue_belts or chaintrue_anchors file with its "
        "settings"}});
  auto where = verb.add_choice("where");
  where.has({{"--grid", c.grid, "Columns x rows of marks, as in 7x4"},
             {"--random", {c.random_points, {"", 1.0, 1e6}}, "Number of marks at random positions"},
             {"--marks", reads(c.marks), "CSV of marks (x_mm, y_mm), as plan writes it"},
             {"--points", reads(c.points),
              "CSV of true positions, with readings without noise or rounding"},
             {"--holes",
              {c.holes.holes, {"", grid::kFewestPlannedHoles, grid::kMostPlannedHoles}},
              "Number of holes, placed as by chaintrue plan --holes, measured with a tape"}});
  verb.has(
      {{"--pulls", c.pulls,
        "With --belts: measure all places once with each relative pull, such as 1,1.6; "
        "sizes of effects refer to the smallest",
        belts, "to be left out, because it applies to four belts only"},
       {"--spacing",
        {c.spacing, spacing, "regular", "regular or chebyshev"},
        "With --grid: regular or chebyshev (denser at the edges)",
        lattice,
        "to be left out, because it applies to the columns and rows of a grid on two chains"},
       {"--margin-mm",
        {c.spec.design.margin_mm, {"mm", 0.0, 10000.0}},
        "Distance from the bed's edge to the outermost marks; by default the marks span whole "
        "hundreds of mm",
        lattice | scattered | tape,
        "to be left out, because the places are given or follow from the belts"},
       {"--without-corners", c.spec.design.without_corners, "Leave out the four corners",
        lattice | scattered, "to be left out, because it applies to simulated marks only"},
       {"--region",
        {c.spec.design.region, synthetic::region, "whole", "whole, left, right, top or bottom"},
        "Part of the bed with marks: whole, left, right, top or bottom",
        session,
        "to be left out, because it applies to simulated marks only"},
       {"--order",
        {c.spec.order, synthetic::visiting_order, "rows",
         "rows, columns, serpentine_rows, serpentine_columns or random"},
        "Order of visits: rows, columns, serpentine_rows, serpentine_columns or random",
        session,
        "to be left out, because it applies to visits of marks only"},
       {"--repeats",
        {c.spec.repeats, {"", 0.0, 1e6}},
        "Number of second visits to measured marks, spread over the session",
        session,
        "to be left out, because it applies to visits of marks only"},
       {"--jitter-mm",
        {c.spec.jitter_mm, {"mm", 0.0, 1000.0}},
        "Largest distance of the sled from a mark",
        session,
        "to be left out, because it applies to marks only"},
       {"--length-noise-mm",
        {c.spec.noise.length_mm, files::kNoiseMm},
        "Standard deviation (1 sigma) of a chain reading",
        session | belts,
        "to be left out, because it applies to chain lengths read at marks only"},
       {"--position-noise-mm",
        {c.spec.noise.position_mm, files::kNoiseMm},
        "Standard deviation (1 sigma) of each coordinate",
        session,
        "to be left out, because it applies to measured marks only"},
       {"--heavy-tails", c.spec.noise.heavy_tails,
        "Draw noise from Student's t (4 degrees of freedom) with the same standard deviation",
        session | belts,
        "to be left out, because it applies to the noise of lengths and marks only"},
       {"--length-rounding-mm",
        {c.spec.noise.length_rounding_mm, files::kNoiseMm},
        "Round readings to whole multiples",
        session | belts,
        "to be left out, because it applies to chain lengths read at marks only"},
       {"--position-rounding-mm",
        {c.spec.noise.position_rounding_mm, files::kNoiseMm},
        "Round marks to whole multiples, such as 0.5 for a tape",
        session,
        "to be left out, because it applies to measured marks only"},
       {"--stated-length-noise-mm",
        {c.stated_length_mm, files::kNoiseMm},
        "Value in the file; by default the true one",
        session,
        "to be left out, because it applies to the noise in a grid only"},
       {"--stated-position-noise-mm",
        {c.stated_position_mm, files::kNoiseMm},
        "Value in the file; by default the true one",
        session,
        "to be left out, because it applies to the noise in a grid only"},
       {"--stated-dof",
        {c.stated_dof, files::kNoiseDof},
        "Degrees of freedom of the noise in the file",
        session,
        "to be left out, because it applies to the noise in a grid only"},
       {"--bad-points",
        {c.spec.bad.count, {"", 0.0, 1e6}},
        "Number of marks recorded wrongly",
        facts::drawn,
        "to be left out, because readings at given places have no errors"},
       {"--bad-size-mm",
        {c.spec.bad.size_mm, {"mm", 0.0, 10000.0}},
        "Error of those marks",
        facts::drawn,
        "to be left out, because readings at given places have no errors"}});
  add_tape_options(verb, c.holes);
  verb.has(
      {{"--hook-offset-mm",
        {c.tape_zero_offset_mm, files::kTapeZeroOffsetMm},
        "With --holes: zero error of the tape, added to every reading",
        tape,
        "to be left out without --holes"},
       {"--tape-rounding-mm",
        {c.tape_rounding_mm, {"mm", 0.0, 100.0}},
        "With --holes: readings are rounded to whole multiples",
        tape,
        "to be left out without --holes"},
       {"--effect", c.effects,
        "Hidden effect id:side:key=value,... (- for no side; see `chaintrue effects`, "
        "for --belts docs/maslow4.md)"},
       {"--effects", reads(c.declared),
        "chaintrue_effect files: declared effects that --effect may name; the grid's machine "
        "contains them",
        session | places | tape, "to be left out, because declared effects act on two chains"},
       {"--offset", c.offsets,
        "Hidden offset of a setting, true minus assumed, such as motor_left_x_mm=1.5", facts::drawn,
        "to be left out, because readings at given places use the machine file unchanged"},
       {"--draw-settings", c.spec.draw_settings,
        "Draw motors and zeros from the machine's uncertainty", session | tape,
        "to be left out, because nothing is drawn for belts or at given places"},
       {"--sheet-shift-mm",
        {c.sheet_shift_mm, {"mm", 0.0, 1000.0}},
        "Standard deviation (1 sigma) of the sheet's placement",
        session,
        "to be left out, because it applies to a sheet with marks only"},
       {"--sheet-rotation-mrad",
        {c.sheet_rotation_mrad, {"mrad", 0.0, 500.0}},
        "Standard deviation (1 sigma) of the sheet's placement",
        session,
        "to be left out, because it applies to a sheet with marks only"},
       {"--model",
        {c.spec.model, model_of, "elastic",
         fmt::format("one of {}", fmt::join(files::kModels, ", "))},
        "straight, wrap, firmware, one_shot, inextensible, elastic, elastic_3d",
        session | places,
        "to be left out, because it applies to chain lengths only"},
       {"--seed",
        {c.spec.seed, {"", 0.0, 9e15}},
        "Same seed, same bytes",
        facts::drawn,
        "to be left out, because nothing is drawn at given places"},
       {"--name", c.name, "Name of the grid"},
       {"-o,--output", writes(c.output, {Origin::measured}),
        "chaintrue_grid file (with --holes: chaintrue_holes, with --belts: chaintrue_belts); "
        "- is standard output"},
       {"--answer", writes(c.answer, {Origin::answer}), "Write what was hidden to this file",
        session | tape,
        "to be left out, because nothing is hidden at given places, and for belts there is "
        "no such file"}});
  add_option_check(verb, c, check_words);
}

}  // namespace chaintrue::cli

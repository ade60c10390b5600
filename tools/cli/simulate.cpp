// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue simulate: a simulated grid measured on a machine with hidden effects, or the bare
/// readings at given places.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "grid/files/answer_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/points_file.hpp"
#include "grid/files/ranges.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/plan_holes.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/simulate_options.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

/// Diagnose the hidden effects, if the noise of the points is known.
void say_next_of(const SimulateOptions& options) {
  const bool has_noise = options.holes.plan.holes != 0 || options.noise.length_mm > 0.0;
  if (options.effects.empty() || !has_noise)
    return say_next({"fit", options.output, "-o", "map.json"});
  say_next({"diagnose", options.output, "-o", "diagnosis.json"});
}

int simulate_session(const SimulateOptions& options, const Machine& machine) {
  const synthetic::SyntheticSpec spec = parse_spec(options, machine);
  auto session = synthetic::generate(machine, spec, shown_progress());
  if (!session) {
    say("chaintrue simulate: the mark at ({:.1f}, {:.1f}) mm cannot be reached: {}",
        session.error().place.x_mm,
        session.error().place.y_mm,
        session.error().sentence());
    return kNotSupportedOrOutside;
  }
  session->grid.name =
      options.name.empty() ? fmt::format("simulated, seed {}", spec.seed) : options.name;
  const std::string text = files::write_grid(session->grid);
  write_outputs({{options.answer, files::write_answer(session->answer)}, {options.output, text}});
  say_next_of(options);
  return kDone;
}

int simulate_places(const SimulateOptions& options, const Machine& machine) {
  OptionProblems problems;
  const std::vector<AppliedEffect> hidden = parse_effects(options.effects, machine, problems);
  const model::Model model = parse_model(options.model, problems);
  problems.throw_if_any();
  std::vector<model::Visit> visits;
  for (const MarkPoint& place : files::read_points(options.points)) {
    visits.push_back({model::identity_placement(place), static_cast<int>(visits.size())});
  }
  synthetic::PlacesRead read =
      synthetic::read_places(machine, hidden, visits, model, shown_progress());
  read.grid.name = options.name.empty() ? "readings at given places" : options.name;
  for (const auto& [index, reason] : read.unreachable) {
    say("chaintrue simulate: {}: point {} at ({:.1f}, {:.1f}) mm cannot be reached and is "
        "left out: {}",
        options.points,
        index,
        visits[index].position.x_mm,
        visits[index].position.y_mm,
        model::sentence_of(reason));
  }
  write_output(options.output, files::write_grid(read.grid));
  if (!read.unreachable.empty()) return kNotSupportedOrOutside;
  // Few readings are only for viewing; a map needs at least as many as a plan has.
  if (static_cast<int>(read.grid.points.size()) >= grid::kFewestPlanned) {
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
  return options.holes.plan.holes != 0 ? facts::tape : facts::scattered;
}

int run_simulate(Verb verb, const SimulateOptions& options) {
  verb.refuse_idle_options(facts_of(options));
  if (!options.belts.empty()) return simulate_the_belts(options);
  Machine machine = read_machine_input(options.machine);
  files::declare_effects(options.declared, machine);
  if (options.holes.plan.holes != 0) {
    const int code = simulate_the_holes(options, machine);
    if (code == kDone) say_next_of(options);
    return code;
  }
  return options.points.empty() ? simulate_session(options, machine)
                                : simulate_places(options, machine);
}

void add_design_options(Verb verb, SimulateOptions& o) {
  auto where = verb.add_choice("where");
  where.add_option("--grid", o.grid, "Columns x rows of marks, as in 7x4");
  add_number(
      where, "--random", o.random_points, {"", 1.0, 1e6}, "Number of marks at random positions")
      .shows_default("");
  add_input(where, "--marks", o.marks, "CSV of marks (x_mm, y_mm), as plan writes it");
  add_input(where,
            "--points",
            o.points,
            "CSV of true positions, with readings without noise or rounding");
  add_number(where,
             "--holes",
             o.holes.plan.holes,
             {"", grid::kFewestPlannedHoles, grid::kMostPlannedHoles},
             "Number of holes, placed as by chaintrue plan --holes, measured with a tape")
      .shows_default("");
  verb.add_option("--spacing", o.spacing, "With --grid: regular or chebyshev (denser at the edges)")
      .shows_default()
      .acts_on(
          facts::lattice,
          "to be left out, because it applies to the columns and rows of a grid on two chains");
  add_number(verb,
             "--margin-mm",
             o.margin_mm,
             {"mm", 0.0, 10000.0},
             "Distance from the bed's edge to the outermost marks; by default the marks span whole "
             "hundreds of mm")
      .acts_on(facts::lattice | facts::scattered | facts::tape,
               "to be left out, because the places are given or follow from the belts");
  verb.add_flag("--without-corners", o.without_corners, "Leave out the four corners")
      .acts_on(facts::lattice | facts::scattered,
               "to be left out, because it applies to simulated marks only");
  verb.add_option(
          "--region", o.region, "Part of the bed with marks: whole, left, right, top or bottom")
      .shows_default()
      .acts_on(facts::session, "to be left out, because it applies to simulated marks only");
  verb.add_option("--order",
                  o.order,
                  "Order of visits: rows, columns, serpentine_rows, serpentine_columns or random")
      .shows_default()
      .acts_on(facts::session, "to be left out, because it applies to visits of marks only");
  add_number(verb,
             "--repeats",
             o.repeats,
             {"", 0.0, 1e6},
             "Number of second visits to measured marks, spread over the session")
      .acts_on(facts::session, "to be left out, because it applies to visits of marks only");
  add_number(verb,
             "--jitter-mm",
             o.jitter_mm,
             {"mm", 0.0, 1000.0},
             "Largest distance of the sled from a mark")
      .acts_on(facts::session, "to be left out, because it applies to marks only");
}

void add_noise_options(Verb verb, SimulateOptions& o) {
  add_number(verb,
             "--length-noise-mm",
             o.noise.length_mm,
             files::kNoiseMm,
             "Standard deviation (1 sigma) of a chain reading")
      .acts_on(facts::session | facts::belts,
               "to be left out, because it applies to chain lengths read at marks only");
  add_number(verb,
             "--position-noise-mm",
             o.noise.position_mm,
             files::kNoiseMm,
             "Standard deviation (1 sigma) of each coordinate")
      .acts_on(facts::session, "to be left out, because it applies to measured marks only");
  verb.add_flag(
          "--heavy-tails",
          o.noise.heavy_tails,
          "Draw noise from Student's t (4 degrees of freedom) with the same standard deviation")
      .acts_on(facts::session | facts::belts,
               "to be left out, because it applies to the noise of lengths and marks only");
  add_number(verb,
             "--length-rounding-mm",
             o.noise.length_rounding_mm,
             files::kNoiseMm,
             "Round readings to whole multiples")
      .acts_on(facts::session | facts::belts,
               "to be left out, because it applies to chain lengths read at marks only");
  add_number(verb,
             "--position-rounding-mm",
             o.noise.position_rounding_mm,
             files::kNoiseMm,
             "Round marks to whole multiples, such as 0.5 for a tape")
      .acts_on(facts::session, "to be left out, because it applies to measured marks only");
  add_number(verb,
             "--stated-length-noise-mm",
             o.stated_length_mm,
             files::kNoiseMm,
             "Value in the file; by default the true one")
      .acts_on(facts::session, "to be left out, because it applies to the noise in a grid only");
  add_number(verb,
             "--stated-position-noise-mm",
             o.stated_position_mm,
             files::kNoiseMm,
             "Value in the file; by default the true one")
      .acts_on(facts::session, "to be left out, because it applies to the noise in a grid only");
  add_number(verb,
             "--stated-dof",
             o.stated_dof,
             files::kNoiseDof,
             "Degrees of freedom of the noise in the file")
      .acts_on(facts::session, "to be left out, because it applies to the noise in a grid only");
  add_number(verb, "--bad-points", o.bad.count, {"", 0.0, 1e6}, "Number of marks recorded wrongly")
      .acts_on(facts::drawn, "to be left out, because readings at given places have no errors");
  add_number(verb, "--bad-size-mm", o.bad.size_mm, {"mm", 0.0, 10000.0}, "Error of those marks")
      .acts_on(facts::drawn, "to be left out, because readings at given places have no errors");
}

void add_holes_options(Verb verb, HolesOptions& o) {
  add_tape_options(verb, o.plan);
  add_number(verb,
             "--hook-offset-mm",
             o.tape_zero_offset_mm,
             files::kTapeZeroOffsetMm,
             "With --holes: zero error of the tape, added to every reading")
      .acts_on(facts::tape, "to be left out without --holes");
  add_number(verb,
             "--tape-rounding-mm",
             o.rounding_mm,
             {"mm", 0.0, 100.0},
             "With --holes: readings are rounded to whole multiples")
      .acts_on(facts::tape, "to be left out without --holes");
}

void add_truth_options(Verb verb, SimulateOptions& o) {
  verb.add_option("--effect",
                  o.effects,
                  "Hidden effect id:side:key=value,... (- for no side; see `chaintrue effects`, "
                  "for --belts docs/maslow4.md)");
  add_input(verb,
            "--effects",
            o.declared,
            "chaintrue_effect files: declared effects that --effect may name; the grid's machine "
            "contains them")
      .acts_on(facts::session | facts::places | facts::tape,
               "to be left out, because declared effects act on two chains");
  verb.add_option("--offset",
                  o.offsets,
                  "Hidden offset of a setting, true minus assumed, such as motor_left_x_mm=1.5")
      .acts_on(facts::drawn,
               "to be left out, because readings at given places use the machine file unchanged");
  verb.add_flag("--draw-settings",
                o.draw_settings,
                "Draw motors and zeros from the machine's uncertainty")
      .acts_on(facts::session | facts::tape,
               "to be left out, because nothing is drawn for belts or at given places");
  add_number(verb,
             "--sheet-shift-mm",
             o.sheet_shift_mm,
             {"mm", 0.0, 1000.0},
             "Standard deviation (1 sigma) of the sheet's placement")
      .acts_on(facts::session, "to be left out, because it applies to a sheet with marks only");
  add_number(verb,
             "--sheet-rotation-mrad",
             o.sheet_rotation_mrad,
             {"mrad", 0.0, 500.0},
             "Standard deviation (1 sigma) of the sheet's placement")
      .acts_on(facts::session, "to be left out, because it applies to a sheet with marks only");
  verb.add_option("--model",
                  o.model,
                  "straight, wrap, firmware, one_shot, inextensible, elastic, elastic_3d")
      .shows_default()
      .acts_on(facts::session | facts::places,
               "to be left out, because it applies to chain lengths only");
  add_number(verb, "--seed", o.seed, {"", 0.0, 9e15}, "Same seed, same bytes")
      .acts_on(facts::drawn, "to be left out, because nothing is drawn at given places");
}

}  // namespace

void add_simulate(Verb app) {
  auto options = std::make_shared<SimulateOptions>();
  Verb verb = app.add_verb("simulate", "Simulate measurements on a machine with hidden effects");
  auto machine = verb.add_choice("machine");
  add_input(
      machine, "--machine", options->machine, "The chaintrue_machine file as its owner has it");
  add_input(machine,
            "--belts",
            options->belts,
            "A router on four belts instead: a chaintrue_belts or chaintrue_anchors file with its "
            "settings");
  verb.add_option("--pulls",
                  options->pulls,
                  "With --belts: measure all places once with each relative pull, such as 1,1.6; "
                  "sizes of effects refer to the smallest")
      .acts_on(facts::belts, "to be left out, because it applies to four belts only");
  add_design_options(verb, *options);
  add_noise_options(verb, *options);
  add_holes_options(verb, options->holes);
  add_truth_options(verb, *options);
  verb.add_option("--name", options->name, "Name of the grid");
  add_output(verb,
             "-o,--output",
             options->output,
             {Origin::measured},
             "chaintrue_grid file (with --holes: chaintrue_holes, with --belts: chaintrue_belts); "
             "- is standard output")
      .shows_default();
  add_output(
      verb, "--answer", options->answer, {Origin::answer}, "Write what was hidden to this file")
      .acts_on(facts::session | facts::tape,
               "to be left out, because nothing is hidden at given places, and for belts there is "
               "no such file");
  verb.footer(
      "Examples:\n"
      "  build/chaintrue simulate --machine fixtures/machines/classic.json --grid 7x4 --jitter-mm "
      "8 --length-noise-mm 0.2 --position-noise-mm 0.3 --repeats 6 --effect "
      "chain_pitch_error:left:elongation=0.0012 --seed 1 -o grid.json --answer answer.json\n"
      "  printf 'x_mm,y_mm\\n0,0\\n' | build/chaintrue simulate --machine "
      "fixtures/machines/classic.json --points -\n"
      "  build/chaintrue simulate --machine fixtures/machines/classic.json --holes 9 --distances "
      "20 --tape-sigma-mm 0.5 --draw-settings --seed 1 -o holes.json\n"
      "  build/chaintrue simulate --belts fixtures/belts/thirty_one_places.json --grid 9x9 "
      "--effect belt_stretch:-:elongation=0.004 --offset tl_x_mm=12 --seed 1 -o belts.json");
  add_option_check(verb, [options](OptionProblems& problems) { check_words(*options, problems); });
  verb.runs(options, run_simulate, [](const auto& own) {
    if (!own.belts.empty() && own.grid.empty()) {
      usage_error("simulate", "--belts needs --grid, columns x rows of places");
    }
  });
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// road: what the road from readings to a cut is worth, with the causes that are found in the map and
/// without. On hidden machines it holds each map's true error against what the map states; on a real
/// scan it draws marks and holds both maps against all the others. Not part of the test run; its
/// tables stand in docs/map_rates.md. Same options, same table.
///
///   road --sets 40 --points 28                  // each effect of the catalogue at its usual size
///   road --scan scan.json --draws 200           // chaintrue import optical wrote scan.json
///   road --zeros --sets 8                       // zeros that move: on the way, and between two sessions
///   road --start --sets 100                     // what the second visits of the list of start find
///   road --stated rows.txt --sets 40            // at usual sizes: stated errors against true ones
///   road --promised --sets 31                   // what owners are promised: rms, and at worst
///
/// The rows of --stated are kept: what the file has is not run again, so that a run may be stopped
/// and continued, and shards of --cause may share one file one after the other.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>

#include "generator/hidden/random.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/observation/length_points.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/promised_errors.hpp"
#include "sealed/judge/stated_errors.hpp"
#include "sealed/judge/trial.hpp"

namespace {

using namespace chaintrue;
using sealed::MapErrors;

struct Arguments {
  bool zeros = false;
  bool start = false;
  bool promised = false;
  int sets = 40;
  int points = 28;
  std::uint64_t first_seed = 1;
  std::string cause;
  std::string scan;
  std::string stated;
  int draws = 200;
  int drawn_marks = 60;
};

/// Sums over machines of squares, mm^2, and of intervals that hold what is true.
struct Tally {
  int machines = 0;
  int built = 0;
  int failed = 0;
  double plain_mm2 = 0.0;
  double own_mm2 = 0.0;
  double stated_mm2 = 0.0;
  double plain_stated_mm2 = 0.0;
  int covered = 0;
  int intervals = 0;
  std::vector<double> ratios;  ///< true error with causes over plain

  void add(const MapErrors& plain, const MapErrors& own, bool is_built) {
    ++machines;
    built += is_built ? 1 : 0;
    plain_mm2 += plain.true_rms_mm * plain.true_rms_mm;
    own_mm2 += own.true_rms_mm * own.true_rms_mm;
    stated_mm2 += own.stated_rms_mm * own.stated_rms_mm;
    plain_stated_mm2 += plain.stated_rms_mm * plain.stated_rms_mm;
    covered += own.covered;
    intervals += 2 * own.places;
    ratios.push_back(own.true_rms_mm / plain.true_rms_mm);
  }
  void add(const Tally& other) {
    machines += other.machines;
    built += other.built;
    failed += other.failed;
    plain_mm2 += other.plain_mm2;
    own_mm2 += other.own_mm2;
    stated_mm2 += other.stated_mm2;
    plain_stated_mm2 += other.plain_stated_mm2;
    covered += other.covered;
    intervals += other.intervals;
    ratios.insert(ratios.end(), other.ratios.begin(), other.ratios.end());
  }
  [[nodiscard]] std::string line(std::string_view what) const {
    const double n = std::max(machines, 1);
    return fmt::format(
        "| {:24} | {:4} | {:4} | {:6.3f} | {:6.3f} | {:5.2f} | {:6.3f} | {:6.3f} | {:5.2f} | {:5.1f} % | {:5.2f} |\n",
        what,
        machines,
        built,
        std::sqrt(plain_mm2 / n),
        std::sqrt(plain_stated_mm2 / n),
        std::sqrt(plain_mm2 / plain_stated_mm2),
        std::sqrt(own_mm2 / n),
        std::sqrt(stated_mm2 / n),
        std::sqrt(own_mm2 / stated_mm2),
        100.0 * covered / std::max(intervals, 1),
        ratios.empty() ? 0.0 : *std::max_element(ratios.begin(), ratios.end()));
  }
};

/// One machine: both maps of its readings, against the machine.
void try_machine(const generator::Recipe& recipe, std::uint64_t seed, Tally& tally) {
  const generator::SealedSet set = generator::draw_set(recipe, seed);
  const grid::Measured measured(grid::files::parse_grid(set.grid_text, "sealed.json").grid);
  const auto plain = grid::joint_fit(measured);
  grid::diagnosis::CausesFitOptions accepting;
  accepting.accept_class = true;
  const auto own = grid::diagnosis::fit_with_causes(measured, accepting);
  const auto of_plain = plain ? sealed::map_errors(set, plain->map) : std::nullopt;
  const auto of_own = own ? sealed::map_errors(set, own->fit.map) : std::nullopt;
  if (of_plain && of_own) {
    tally.add(*of_plain, *of_own, !own->built_on.empty());
  } else {
    ++tally.failed;
  }
}

void print_machines(const Arguments& arguments) {
  fmt::print(
      "| hidden | sets | built on it | plain: true mm | stated | true / stated | with causes: true mm | "
      "stated | true / stated | 95 % hold | worst ratio to plain |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  Tally all;
  generator::Recipe recipe;
  recipe.points = arguments.points;
  const auto run = [&](std::string_view name) {
    Tally tally;
    for (int k = 0; k < arguments.sets; ++k)
      try_machine(recipe, arguments.first_seed + static_cast<std::uint64_t>(k), tally);
    fmt::print("{}", tally.line(name));
    std::fflush(stdout);
    if (tally.failed > 0) fmt::print(stderr, "{}: {} of them failed\n", name, tally.failed);
    all.add(tally);
  };
  for (const generator::CauseCard& card : generator::cards()) {
    if (!arguments.cause.empty() && card.id != arguments.cause) continue;
    recipe.cause = card.cause;
    run(card.id);
  }
  if (arguments.cause.empty()) {
    recipe.cause.reset();
    recipe.kind = generator::Mix::nothing;
    run("nothing");
    recipe.kind = generator::Mix::alongside;
    run("a cause and a pattern");
  }
  fmt::print("{}", all.line("all"));
}

/// Zeros that move by so much: what the map is worth, plain and with causes.
void print_zeros(const Arguments& arguments) {
  using generator::Cause;
  using generator::Where;
  struct Moved {
    const char* what;
    std::vector<generator::Hidden> hidden;
  };
  const Moved rows[] = {
      {"left zero by 6 mm from the 15th mark on", {{Cause::zero_shift, Where::left, 6.0, 15.0}}},
      {"left zero by 10 mm from visit 17 on", {{Cause::zero_shift, Where::left, 10.0, 17.0}}},
      {"right zero by -3 mm from visit 20 on", {{Cause::zero_shift, Where::right, -3.0, 20.0}}},
      {"nothing moves", {}}};
  const auto seeds = static_cast<std::uint64_t>(arguments.sets);
  fmt::print(
      "| list of start | sets | built on it | plain: true mm | stated | true / stated | with causes: true mm | "
      "stated | true / stated | 95 % hold | worst ratio to plain |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Moved& row : rows) {
    Tally tally;
    generator::Recipe recipe = sealed::recipe_of_start();
    recipe.kind = row.hidden.empty() ? generator::Mix::nothing : generator::Mix::single;
    recipe.exactly = row.hidden;
    for (std::uint64_t k = 0; k < seeds; ++k) try_machine(recipe, arguments.first_seed + k, tally);
    fmt::print("{}", tally.line(row.what));
    std::fflush(stdout);
  }
  for (const double zero_mm : {5.0, 20.0, 0.0}) {
    Tally tally;
    generator::Recipe recipe = sealed::recipe_of_start();
    recipe.kind = generator::Mix::nothing;
    for (std::uint64_t k = 0; k < seeds; ++k) {
      const std::uint64_t seed = arguments.first_seed + k;
      const generator::SealedSet set = generator::draw_set(recipe, seed);
      const grid::MeasuredGrid first = grid::files::parse_grid(set.grid_text, "first.json").grid;
      const std::string text = sealed::another_session(set, zero_mm, seed);
      const grid::MeasuredGrid second = grid::files::parse_grid(text, "second.json").grid;
      const auto alone = grid::joint_fit(first);
      const auto both = grid::joint_fit({{"first", first}, {"second", second}});
      const auto of_first = alone ? sealed::map_errors(set, alone->map) : std::nullopt;
      const auto of_both = both ? sealed::map_errors(set, both->map) : std::nullopt;
      if (of_first && of_both) tally.add(*of_first, *of_both, true);
    }
    fmt::print("{}", tally.line(fmt::format("first alone, with a second: {:g} mm", zero_mm)));
    std::fflush(stdout);
  }
}

/// How often what happens during a session is found in the readings of the list of start.
void print_start(const Arguments& arguments) {
  using generator::Cause;
  fmt::print("| hidden | strength | sessions | named alone | among those named | nothing named |\n"
             "|---|---|---|---|---|---|\n");
  for (const Cause cause : {Cause::zero_shift, Cause::drift, Cause::direction_hysteresis}) {
    if (!arguments.cause.empty() && generator::card(cause).id != arguments.cause) continue;
    for (const double strength : {7.0, 10.0, 15.0, 22.0}) {
      sealed::TrialOptions options;
      options.recipe = sealed::recipe_of_start();
      options.recipe.cause = cause;
      options.recipe.delta = strength;
      int alone = 0, in_set = 0, silent = 0;
      for (int k = 0; k < arguments.sets; ++k) {
        const sealed::Trial trial =
            run_trial(options, arguments.first_seed + static_cast<std::uint64_t>(k));
        alone += trial.causes.size() == 1 && leads_right(trial) ? 1 : 0;
        in_set += sealed::in_set(trial) ? 1 : 0;
        silent += names_something(trial) ? 0 : 1;
      }
      fmt::print("| {} | {:g} | {} | {} | {} | {} |\n",
                 generator::card(cause).id,
                 strength,
                 arguments.sets,
                 alone,
                 in_set,
                 silent);
      std::fflush(stdout);
    }
  }
  generator::Recipe nothing = sealed::recipe_of_start();
  nothing.kind = generator::Mix::nothing;
  const generator::SealedSet set = generator::draw_set(nothing, arguments.first_seed);
  const auto yardstick =
      generator::Yardstick::make(set.machine.truth(), set.machine.visits(), set.noise, {});
  fmt::print("\n| usual size | side | strength |\n|---|---|---|\n");
  for (const generator::CauseCard& card : generator::cards()) {
    for (const generator::Where where : card.sides) {
      const generator::Hidden one[] = {
          {card.cause, where, card.usual, card.place == generator::Place::angle ? 0.8 : 16.0}};
      const auto signature = yardstick->signature(one);
      if (signature)
        fmt::print("| {} {:g} | {} | {:.1f} |\n",
                   card.id,
                   card.usual,
                   generator::word(where),
                   signature->norm());
    }
  }
}

void print_stated(const Arguments& arguments) {
  std::vector<sealed::StatedRow> rows;
  {
    std::ifstream file(arguments.stated);
    for (std::string line; std::getline(file, line);) {
      if (auto row = sealed::row_of(line)) rows.push_back(*std::move(row));
    }
  }
  std::ofstream file(arguments.stated, std::ios::app);
  for (const std::string& kind : sealed::stated_kinds()) {
    if (!arguments.cause.empty() && kind != arguments.cause) continue;
    for (int k = 0; k < arguments.sets; ++k) {
      const bool is_known = std::any_of(rows.begin(), rows.end(), [&](const auto& row) {
        return row.kind == kind && row.machine == k;
      });
      if (is_known) continue;
      rows.push_back(sealed::stated_row(kind, k));
      file << sealed::line_of(rows.back()) << std::endl;
    }
  }
  fmt::print("{}", sealed::stated_table(rows));
}

void print_promised(const Arguments& arguments) {
  std::vector<sealed::PromisedRow> rows;
  for (const sealed::PromisedSession& session : sealed::promised_sessions()) {
    for (int k = 0; k < arguments.sets; ++k) {
      const std::uint64_t seed = arguments.first_seed + static_cast<std::uint64_t>(k);
      if (auto row = sealed::promised_row(session, seed))
        rows.push_back(*std::move(row));
      else
        fmt::print(stderr, "{}, {}, {}: nothing is promised\n", session.machine, session.way, seed);
    }
  }
  fmt::print("{}", sealed::promised_table(rows));
}

/// Tool's rms at the marks that a map was not made of.
double error_at(const grid::CompensationMap& map,
                const std::vector<grid::LengthPoint>& points,
                const std::vector<bool>& drawn) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (drawn[points[k].index]) continue;
    const auto answer = map.query(points[k].mark);
    if (!answer) continue;
    const Eigen::Vector2d missing(points[k].lengths.left_mm - answer->lengths.left_mm,
                                  points[k].lengths.right_mm - answer->lengths.right_mm);
    sum += (answer->mark_jacobian.inverse() * missing).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1));
}

void print_scan(const Arguments& arguments) {
  const grid::MeasuredGrid whole = grid::files::read_grid(arguments.scan).grid;
  const auto points = grid::length_points(whole);
  if (!points) throw std::runtime_error(points.error().sentence());
  std::vector<double> ratios;
  int built = 0;
  for (int draw = 0; draw < arguments.draws; ++draw) {
    generator::Dice dice(arguments.first_seed + static_cast<std::uint64_t>(draw), "marks of a scan");
    std::vector<bool> drawn(whole.points.size(), false);
    grid::MeasuredGrid few = whole;
    few.points.clear();
    while (static_cast<int>(few.points.size()) < arguments.drawn_marks) {
      const std::size_t k = dice.below(drawn.size());
      if (drawn[k]) continue;
      drawn[k] = true;
      few.points.push_back(whole.points[k]);
    }
    const auto plain = grid::joint_fit(few);
    const auto own = grid::diagnosis::fit_with_causes(few);
    if (!plain || !own) continue;
    built += own->built_on.empty() ? 0 : 1;
    ratios.push_back(error_at(own->fit.map, *points, drawn) / error_at(plain->map, *points, drawn));
  }
  std::sort(ratios.begin(), ratios.end());
  fmt::print("{} draws of {} marks, {} built on causes; error at the other marks over the plain map's: "
             "median {:.3f}, worst {:.3f}, best {:.3f}\n",
             ratios.size(),
             arguments.drawn_marks,
             built,
             ratios.empty() ? 0.0 : ratios[ratios.size() / 2],
             ratios.empty() ? 0.0 : ratios.back(),
             ratios.empty() ? 0.0 : ratios.front());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Holds maps against the machines that they were measured on.");
  app.add_option("--sets", arguments.sets, "machines of each kind")->check(CLI::Range(1, 100000));
  app.add_option("--points", arguments.points, "28, 60, 117")->check(CLI::IsMember({28, 60, 117}));
  app.add_option("--first-seed", arguments.first_seed, "of a run of seeds");
  app.add_option("--cause", arguments.cause, "this effect alone");
  app.add_flag("--zeros", arguments.zeros, "zeros that move, in place of each effect");
  app.add_flag("--start", arguments.start, "what the list of start finds, in place of maps");
  app.add_flag("--promised", arguments.promised, "errors that owners are promised, in place of maps");
  app.add_option("--scan", arguments.scan, "a chaintrue_grid of a real scan, in place of machines");
  app.add_option("--draws", arguments.draws, "of its marks")->check(CLI::Range(1, 100000));
  app.add_option("--drawn-marks", arguments.drawn_marks, "in each draw")->check(CLI::Range(12, 400));
  app.add_option("--stated", arguments.stated, "a file of rows, which is continued");
  CLI11_PARSE(app, argc, argv);
  if (arguments.zeros) {
    print_zeros(arguments);
  } else if (arguments.start) {
    print_start(arguments);
  } else if (arguments.promised) {
    print_promised(arguments);
  } else if (!arguments.stated.empty()) {
    print_stated(arguments);
  } else if (arguments.scan.empty()) {
    print_machines(arguments);
  } else {
    print_scan(arguments);
  }
  return 0;
}

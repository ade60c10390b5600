// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// road: measures the accuracy from readings to a cut, with and without the causes found in the
/// map. On hidden machines it compares each map's true error with its stated one; on a real scan it
/// draws marks and compares both maps with all the others. Not part of the test run; its tables are
/// in docs/map_rates.md. Same options, same table.
///
///   road --scan scan.json --draws 200           // chaintrue import optical wrote scan.json
///   road --zeros --sets 8                       // zeros that move: on the way, and between two sessions
///   road --start --sets 100                     // what the second visits of the list of start find
///   road --stated rows.txt --sets 40            // at usual sizes: stated errors against true ones
///   road --promised --sets 31                   // what owners are promised: rms, and at worst
///
/// The outcomes of --stated are kept in its file: a run may be stopped and continued.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "generator/hidden/random.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/observation/length_points.hpp"
#include "sealed/command/campaign.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/promised_errors.hpp"
#include "sealed/judge/stated_errors.hpp"
#include "sealed/judge/trial.hpp"

namespace {

using namespace chaintrue;
using sealed::Outcome;
using sealed::PlannedSet;

/// Changes during a session of the list of start: kinds "drift/7" and so on.
Outcome run_start(const PlannedSet& set) {
  const auto slash = set.kind.find('/');
  sealed::TrialOptions options;
  options.recipe = sealed::recipe_of_start();
  options.recipe.cause =
      std::ranges::find(generator::cards(), set.kind.substr(0, slash), &generator::CauseCard::id)
          ->cause;
  options.recipe.delta = sealed::number_of<double>(set.kind.substr(slash + 1));
  return run_trial(set.kind, options, set.seed);
}

/// Strengths of effects of usual size in the readings of that list.
Outcome strengths(const PlannedSet& of) {
  generator::Recipe nothing = sealed::recipe_of_start();
  nothing.kind = generator::Mix::nothing;
  const generator::SealedSet set = generator::draw_set(nothing, of.seed);
  const auto yardstick =
      generator::Yardstick::make(set.machine.truth(), set.machine.visits(), set.noise, {});
  Outcome outcome{.kind = of.kind, .seed = of.seed};
  for (const generator::CauseCard& card : generator::cards()) {
    for (const generator::Where where : card.sides) {
      const generator::Hidden one[] = {
          {card.cause, where, card.usual, card.place == generator::Place::angle ? 0.8 : 16.0}};
      if (const auto signature = yardstick->signature(one))
        outcome.numbers[fmt::format("{}:{}", card.id, word(where))] = signature->norm();
    }
  }
  return outcome;
}

/// Tool's rms at the marks that a map was not made of.
double error_at(const grid::CompensationMap& map, const std::vector<grid::LengthPoint>& points,
                const std::vector<bool>& drawn) {
  double sum = 0.0;
  int count = 0;
  for (const grid::LengthPoint& point : points) {
    if (drawn[point.index]) continue;
    const auto answer = map.query(point.mark);
    if (!answer) continue;
    const Eigen::Vector2d missing(point.lengths.left_mm - answer->lengths.left_mm,
                                  point.lengths.right_mm - answer->lengths.right_mm);
    sum += (answer->mark_jacobian.inverse() * missing).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1));
}

Outcome run_scan(const PlannedSet& set, const grid::MeasuredGrid& whole, int marks) {
  Outcome outcome{.kind = set.kind, .seed = set.seed, .points = marks};
  const auto points = grid::length_points(whole);
  if (!points) throw std::runtime_error(points.error());
  generator::Dice dice(set.seed, "marks of a scan");
  std::vector<bool> drawn(whole.points.size(), false);
  grid::MeasuredGrid few = whole;
  few.points.clear();
  while (static_cast<int>(few.points.size()) < marks) {
    const std::size_t k = dice.below(drawn.size());
    if (drawn[k]) continue;
    drawn[k] = true;
    few.points.push_back(whole.points[k]);
  }
  const auto plain = grid::joint_fit(few);
  const auto own = grid::diagnosis::fit_with_causes(few);
  if (!plain || !own) {
    outcome.fail();
    return outcome;
  }
  outcome.numbers["built"] = own->built_on.empty() ? 0.0 : 1.0;
  outcome.numbers["own_over_plain"] =
      error_at(own->fit.map, *points, drawn) / error_at(plain->map, *points, drawn);
  return outcome;
}

}  // namespace

int main(int argc, char** argv) {
  sealed::Campaign campaign("Holds maps against the machines that they were measured on.", argc,
                            argv);
  campaign.sets = 40;
  bool zeros = false, start = false, promised = false;
  std::string scan;
  int draws = 200, marks = 60;
  CLI::Option_group& modes = *campaign.app.add_option_group("what is measured");
  modes.add_flag("--zeros", zeros, "zeros that move");
  modes.add_flag("--start", start, "what the list of start finds, in place of maps");
  modes.add_flag("--promised", promised, "errors that owners are promised");
  modes.add_option("--scan", scan, "a chaintrue_grid of a real scan, in place of machines");
  modes.add_option("--stated", campaign.file, "a file of outcomes, which is continued");
  modes.require_option(1);
  campaign.app.add_option("--draws", draws, "of its marks")->check(CLI::Range(1, 100000));
  campaign.app.add_option("--drawn-marks", marks, "in each draw")->check(CLI::Range(12, 400));
  std::vector<sealed::RateRow> rows;
  grid::MeasuredGrid whole;
  const auto list = [&] {
    if (!scan.empty()) whole = grid::files::read(grid::files::parse_grid, scan).grid;
    if (!scan.empty()) return campaign.sets_of({"scan"}, draws);
    if (zeros) return campaign.sets_of(sealed::zero_kinds());
    if (promised) return campaign.sets_of(sealed::promised_kinds());
    if (!start) return campaign.sets_of(sealed::stated_kinds());
    rows = sealed::rows_of("start");
    std::vector<PlannedSet> all = campaign.sets_of(kinds_of(rows));
    all.push_back({"strength", campaign.first_seed});
    return all;
  };
  const auto run = [&](const PlannedSet& set) {
    if (!scan.empty()) return run_scan(set, whole, marks);
    if (start) return set.kind == "strength" ? strengths(set) : run_start(set);
    return zeros      ? sealed::zero_outcome(set.kind, set.seed)
           : promised ? sealed::promised_outcome(set.kind, set.seed)
                      : sealed::stated_outcome(set.kind, set.seed);
  };
  return campaign.run(
      list, [&](const PlannedSet& set) { return std::vector{run(set)}; }, rows);
}

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of four belts whose fits are stored, and what of a fit is: for the test that holds them.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/belts/holes_simulation.hpp"
#include "tests/belts/simulated_belts.hpp"

namespace chaintrue::grid {

struct GoldenSet {
  std::string name;
  MeasuredBelts belts;
  std::vector<BeltHoles> holes = {};
};

/// Everything that is reported of a fit, as names and numbers.
using GoldenNumbers = std::vector<std::pair<std::string, double>>;

inline std::vector<GoldenSet> simulated_golden_sets() {
  std::vector<GoldenSet> sets;
  for (const auto lengths :
       {model::BeltLengths::belt, model::BeltLengths::belt_and_arm, model::BeltLengths::span}) {
    for (const bool known : {true, false}) {
      sets.push_back({fmt::format("{}_{}", name(lengths), known ? "known" : "unknown"),
                      simulate({.seed = 41, .anchors_known = known, .lengths = lengths}).belts});
    }
  }
  sets.push_back({"few_places", simulate({.seed = 7, .columns = 3, .rows = 2}).belts});
  GoldenSet bad{"bad_readings", simulate({.seed = 11}).belts};
  bad.belts.points[3].lengths_mm.tl += 44.0;
  bad.belts.points[30].lengths_mm.br -= 44.0;
  bad.belts.points[31].lengths_mm.br -= 12.0;
  bad.belts.points[60].lengths_mm.tr += 150.0;
  bad.belts.points[40].lengths_mm.tl += 60.0;
  bad.belts.points[40].lengths_mm.bl += 35.0;
  sets.push_back(bad);
  GoldenSet gross{"gross_point", simulate({.seed = 12, .columns = 5, .rows = 5}).belts};
  gross.belts.points[7].lengths_mm.tl += 300.0;
  gross.belts.points[7].lengths_mm.tr += 250.0;
  gross.belts.points[7].lengths_mm.bl -= 200.0;
  sets.push_back(gross);
  GoldenSet taped{"taped", simulate({.seed = 14}).belts};
  const auto tape = [](BeltEnd from, BeltEnd to, double mm, double sigma) {
    return BeltDistance{from, to, mm, sigma};
  };
  const auto places = fit_belts(taped.belts).value().places;
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::hypot(places[a].at.x_mm - places[b].at.x_mm, places[a].at.y_mm - places[b].at.y_mm);
  };
  taped.belts.distances.push_back(tape(std::size_t{0}, std::size_t{80}, 1.004 * apart(0, 80), 1.0));
  sets.push_back(taped);
  taped.name = "taped_chain";
  taped.belts.distances.push_back(
      tape(std::size_t{8}, std::size_t{80}, 1.004 * apart(8, 80) + 0.7, 0.5));
  taped.belts.distances.push_back(
      tape(std::size_t{20}, std::size_t{60}, 1.004 * apart(20, 60) - 0.6, 0.8));
  taped.belts.distances.push_back(
      tape(model::Belt::bl,
           std::size_t{60},
           1.004 * std::hypot(places[60].at.x_mm, places[60].at.y_mm) + 0.3,
           1.0));
  sets.push_back(taped);
  taped.name = "taped_anchors_and_holes";
  taped.belts.distances.clear();
  taped.belts.distances.push_back(
      tape(model::Belt::bl, model::Belt::br, 1.004 * taped.belts.machine.anchors.br.x_mm, 1.5));
  taped.belts.distances.push_back(tape(
      CutHole{{-600.0, 300.0}}, CutHole{{700.0, -250.0}}, 1.004 * std::hypot(1300.0, 550.0), 1.0));
  sets.push_back(taped);
  taped.name = "taped_and_bad";
  taped.belts.points[30].lengths_mm.br -= 44.0;
  taped.belts.points[12].lengths_mm.tl += 44.0;
  sets.push_back(taped);
  for (const bool few : {false, true}) {
    for (const double alongside : {0.0, 3.0}) {
      SimulatedHoles own =
          simulate_with_holes({.seed = 5, .unmodelled_mm = alongside, .few_holes = few});
      // The stored numbers are of a tape whose zero is known exactly.
      own.holes.set.tape.tape_zero_offset_sigma_mm = 0.0;
      sets.push_back(
          {fmt::format("holes_{}_{}", few ? "few" : "many", alongside > 0.0 ? "beside" : "straight"),
           own.belts,
           {own.holes}});
    }
  }
  GoldenSet wrong = sets.back();
  wrong.name = "holes_wrong_distance";
  const SimulatedHoles own = simulate_with_holes({.seed = 6});
  wrong.belts = own.belts;
  wrong.holes = {own.holes};
  wrong.holes.front().set.tape.tape_zero_offset_sigma_mm = 0.0;
  wrong.holes.front().set.distances[4].distance_mm += 25.0;
  sets.push_back(wrong);
  wrong.name = "holes_alone";
  wrong.belts.points.clear();
  sets.push_back(wrong);
  return sets;
}

inline std::vector<GoldenSet> file_golden_sets() {
  std::vector<GoldenSet> sets;
  sets.push_back(
      {"thirty_one",
       files::read_belts(std::string(CHAINTRUE_FIXTURES) + "/belts/lower_belts_short.json").belts});
  return sets;
}

/// Readings of real machines; none where they are not with this checkout.
inline std::vector<GoldenSet> real_golden_sets() {
  std::vector<GoldenSet> sets;
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4";
  if (!std::filesystem::exists(folder)) return sets;
  struct Named {
    const char* file;
    int run;
  };
  for (const Named& set : {Named{"concrete_anchors.txt", 1},
                           Named{"frame_rebuilt.txt", 1},
                           Named{"mini_frame.txt", 1},
                           Named{"ten_runs_1_to_5.txt", 1},
                           Named{"ten_runs_1_to_5.txt", 2},
                           Named{"ten_runs_1_to_5.txt", 3},
                           Named{"ten_runs_1_to_5.txt", 4},
                           Named{"ten_runs_1_to_5.txt", 5},
                           Named{"clbm_2026-01.txt", 1}}) {
    files::Maslow4Options options;
    options.run = set.run;
    sets.push_back(
        {fmt::format("{}_{}", set.file, set.run),
         files::parse_maslow4(files::read_whole_file(folder / set.file), set.file, options).belts});
  }
  return sets;
}

inline void add_belts(const BeltsFit& fit, GoldenNumbers& numbers) {
  for (const AnchorCoordinate& own : fit.coordinates) {
    numbers.emplace_back(own.name, own.fitted_mm);
    numbers.emplace_back("sigma of " + own.name, own.sigma_mm);
    numbers.emplace_back("share of tl in " + own.name, own.variance_share.tl);
  }
  numbers.emplace_back("spread_mm", fit.residual_sigma_mm);
  numbers.emplace_back("checks", fit.checks);
  numbers.emplace_back("rms_mm", fit.rms_mm);
  numbers.emplace_back("bad", static_cast<double>(fit.bad.size()));
  for (const BadBeltReading& bad : fit.bad) {
    numbers.emplace_back("bad reading",
                         static_cast<double>(10 * bad.point) + static_cast<double>(bad.belt));
    numbers.emplace_back("off_mm", bad.residual_mm);
  }
  for (const std::size_t point : fit.bad_points)
    numbers.emplace_back("bad point", static_cast<double>(point));
  if (fit.scale) {
    numbers.emplace_back("scale", fit.scale->factor);
    numbers.emplace_back("sigma of scale", fit.scale->sigma);
    for (const double left : fit.scale->residuals_mm)
      numbers.emplace_back("distance left_mm", left);
  }
  for (std::size_t k = 0; k < fit.places.size(); k += 20) {
    const FittedPlace& place = fit.places[k];
    numbers.emplace_back(fmt::format("x of {}", k), place.at.x_mm);
    numbers.emplace_back(fmt::format("y of {}", k), place.at.y_mm);
    numbers.emplace_back(fmt::format("covariance of {}", k), place.covariance_mm2.sum());
    numbers.emplace_back(fmt::format("left of {} br", k), place.belts.br.residual_mm);
    numbers.emplace_back(fmt::format("sigmas of {} br", k), place.belts.br.sigmas);
    numbers.emplace_back(fmt::format("deleted of {} br", k), place.belts.br.deleted_residual_mm);
  }
  numbers.emplace_back("one left out", fit.one_left_out.rms_mm);
  if (fit.half_left_out) numbers.emplace_back("half left out", fit.half_left_out->rms_mm);
}

/// Empty where there is no fit.
inline GoldenNumbers numbers_of(const GoldenSet& set) {
  GoldenNumbers numbers;
  if (set.holes.empty()) {
    const auto fit = fit_belts(set.belts);
    if (fit) add_belts(*fit, numbers);
    return numbers;
  }
  const auto fit = fit_belts_and_holes(set.belts, set.holes);
  if (!fit) return numbers;
  add_belts(fit->belts, numbers);
  numbers.emplace_back("noise factor", fit->holes.noise_factor);
  numbers.emplace_back("displacement",
                       fit->holes.displacement ? fit->holes.displacement->size_mm : 0.0);
  numbers.emplace_back("covariance", fit->holes.covariance.trace());
  numbers.emplace_back("distances left out", fit->holes.left_out_rms_mm);
  for (const BeltTapedDistance& own : fit->holes.distances) {
    numbers.emplace_back("left of " + own.words, own.residual_mm);
    numbers.emplace_back("left out of " + own.words, own.left_out_mm);
    numbers.emplace_back("rejected " + own.words, own.rejected ? 1.0 : 0.0);
  }
  return numbers;
}

}  // namespace chaintrue::grid

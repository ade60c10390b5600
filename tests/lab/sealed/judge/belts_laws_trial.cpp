// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/constants.hpp"
#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/other_laws_trials.hpp"

namespace chaintrue::sealed {
namespace {

using generator::BeltLaw;
using generator::BeltLawFamily;
using grid::diagnosis::Coordinate;
using grid::diagnosis::Enters;
using grid::diagnosis::Law;
using grid::diagnosis::LawShape;

generator::BeltRecipe belt_recipe_of(std::string_view kind, std::uint64_t seed) {
  generator::BeltRecipe recipe;
  recipe.nothing = kind != "causes";
  if (kind == "laws") recipe.law = static_cast<BeltLawFamily>(seed % generator::kBeltLawsOfOne);
  if (kind == "two") recipe.law = BeltLawFamily::product_of_two;
  if (kind == "gaussian") recipe.law = BeltLawFamily::gaussian_field;
  return recipe;
}

bool is_right(const BeltLaw& law, const Law& found) {
  const auto belt = static_cast<int>(law.belt);
  if (found.enters != static_cast<Enters>(static_cast<int>(Enters::tl) + belt)) return false;
  switch (law.family) {
    case BeltLawFamily::step_along_x:
    case BeltLawFamily::slope_from_x:
    case BeltLawFamily::ripple_along_x:
      return found.of == Coordinate::x;
    case BeltLawFamily::slope_from_y:
      return found.of == Coordinate::y;
    case BeltLawFamily::ripple_of_length:
      return found.of == static_cast<Coordinate>(static_cast<int>(Coordinate::length_tl) + belt);
    case BeltLawFamily::ripple_of_angle:
      return found.of == static_cast<Coordinate>(static_cast<int>(Coordinate::angle_tl) + belt);
    default:
      return false;
  }
}

std::optional<double> worst_of(const BeltLaw& law, const Law& found) {
  const auto& p = found.parameters;
  const auto sigmas = [&](std::size_t k, double truth) {
    return std::abs(p[k].value - truth) / std::max(p[k].sigma, 1e-9);
  };
  switch (law.family) {
    case BeltLawFamily::step_along_x:
      if (found.shape != LawShape::step) return std::nullopt;
      return std::max(sigmas(0, law.size_mm), sigmas(1, law.place));
    case BeltLawFamily::slope_from_x:
    case BeltLawFamily::slope_from_y:
      if (found.shape != LawShape::kink || found.towards != law.sign) return std::nullopt;
      return std::max(sigmas(0, law.size_mm * (found.to - found.from) / 1000.0), sigmas(1, law.place));
    default:
      if (found.shape != LawShape::wave) return std::nullopt;
      return std::max(sigmas(0, std::abs(law.size_mm)), sigmas(1, law.extent));
  }
}

}  // namespace

LawsTrial run_belts_laws_trial(std::string_view kind, std::uint64_t seed) {
  const generator::BeltDraw draw = generator::draw_belts(belt_recipe_of(kind, seed), seed);
  LawsTrial trial;
  trial.seed = seed;
  trial.points = static_cast<int>(draw.lengths_mm.size());
  grid::diagnosis::DiagnosisOptions how;
  how.next_measurements = false;
  const auto found = timed(trial, [&] { return grid::diagnosis::diagnose(measured_belts_of(draw), how); });
  if (draw.secret.law) {
    const BeltLaw& law = *draw.secret.law;
    trial.hidden = fmt::format("{} {:.1f} size {:.2f} of belt {} place {:.0f} extent {:.2f}",
                               word(law.family), law.strength, law.size_mm, law.belt, law.place, law.extent);
  } else {
    trial.hidden = draw.secret.effect;
  }
  if (!found) {
    trial.failed = true;
    return trial;
  }
  take_laws(*found, trial);
  if (!draw.secret.law || !trial.reported || kind != "laws") return trial;
  judge(trial, [&](const Law& law) { return is_right(*draw.secret.law, law); });
  if (trial.leads) trial.worst_sigmas = worst_of(*draw.secret.law, trial.laws.front());
  return trial;
}

}  // namespace chaintrue::sealed

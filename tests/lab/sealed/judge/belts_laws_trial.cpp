// SPDX-License-Identifier: GPL-3.0-or-later

#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/other_laws_trials.hpp"

namespace chaintrue::sealed {
namespace {

using generator::LawFamily;

generator::BeltRecipe belt_recipe_of(std::string_view kind, std::uint64_t seed) {
  generator::BeltRecipe recipe;
  recipe.nothing = kind != "causes";
  if (kind == "laws") recipe.law = generator::kBeltLaws[seed % generator::kBeltLawsOfOne];
  if (kind == "two") recipe.law = LawFamily::product_of_two;
  if (kind == "gaussian") recipe.law = LawFamily::gaussian_field;
  return recipe;
}

}  // namespace

LawsTrial run_belts_laws_trial(std::string_view kind, std::uint64_t seed) {
  const generator::BeltDraw draw = generator::draw_belts(belt_recipe_of(kind, seed), seed);
  LawsTrial trial;
  trial.seed = seed;
  trial.points = static_cast<int>(draw.lengths_mm.size());
  grid::diagnosis::DiagnosisOptions how;
  how.next_measurements = false;
  const auto found =
      timed(trial, [&] { return grid::diagnosis::diagnose(measured_belts_of(draw), how); });
  const auto& law = draw.secret.law;
  trial.hidden = law ? words_of(*law, kOfBelts) : draw.secret.effect;
  trial.failed = !found;
  if (found) judge_laws(*found, law ? &law->law : nullptr, kOfBelts, trial);
  return trial;
}

}  // namespace chaintrue::sealed

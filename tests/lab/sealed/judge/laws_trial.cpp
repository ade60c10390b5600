// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/laws_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "grid/containers.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/belts_trial.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::HiddenLaw;
using generator::LawFamily;
using grid::diagnosis::Coordinate;
using grid::diagnosis::Enters;
using grid::diagnosis::Law;
using grid::diagnosis::LawShape;
using Says = grid::diagnosis::DeclaredAnswer::Says;

const std::string kBeltsKind = "belts_";
const std::string kHolesKind = "holes_";

generator::Recipe recipe_of(std::string_view kind, std::uint64_t seed) {
  generator::Recipe recipe;
  constexpr int kPoints[] = {28, 60, 117};
  recipe.points = kPoints[seed % 3];
  recipe.kind =
      kind == "causes" || kind == "both" ? generator::Mix::single : generator::Mix::nothing;
  if (kind == "both") recipe.delta = 10.0;
  if (kind == "laws" || kind == "both") recipe.law = static_cast<LawFamily>((seed / 3) % 9);
  if (kind == "two") recipe.law = LawFamily::product_of_two;
  if (kind == "gaussian") recipe.law = LawFamily::gaussian_field;
  if (kind == "matern") recipe.law = LawFamily::matern_field;
  if (kind == "stretched") recipe.law = LawFamily::stretched_field;
  if (kind == "uneven") recipe.law = LawFamily::uneven_field;
  return recipe;
}

/// The value that follows `first` by so many.
template <class Entry>
Entry nth(Entry first, std::size_t n) {
  return static_cast<Entry>(static_cast<std::size_t>(first) + n);
}

bool is_variable_of(const HiddenLaw& law, const LawEntries& entries, const Law& found) {
  switch (law.family) {
    case LawFamily::step_along_x:
    case LawFamily::slope_from_x:
    case LawFamily::ripple_along_x:
      return found.of == Coordinate::x;
    case LawFamily::step_along_y:
    case LawFamily::slope_from_y:
      return found.of == Coordinate::y;
    case LawFamily::slope_oblique: {
      const double off =
          std::remainder(found.direction_deg - law.direction_rad * 180.0 / std::numbers::pi, 180.0);
      return found.of == Coordinate::across && std::abs(off) < 12.0;
    }
    case LawFamily::ripple_of_length:
      return found.of == nth(entries.length, law.chain);
    case LawFamily::ripple_of_angle:
      return found.of == nth(entries.angle, law.chain);
    case LawFamily::drop_at_edge:
      return found.of == (law.chain == 0 ? Coordinate::x : Coordinate::y) ||
             found.of == Coordinate::border;
    default:
      return false;
  }
}

Enters entry_of(const HiddenLaw& law, const LawEntries& entries) {
  return nth(law.moves_tool ? Enters::x : entries.reading, law.component);
}

/// Largest distance of a place, period or size from the truth, in sigmas, of a law with the right shape.
std::optional<double> worst_of(const HiddenLaw& law, const Law& found) {
  const auto sigmas = [&](std::size_t k, double truth) {
    return std::abs(found.parameters[k].value - truth) / std::max(found.parameters[k].sigma, 1e-9);
  };
  switch (law.family) {
    case LawFamily::step_along_x:
    case LawFamily::step_along_y:
      if (found.shape != LawShape::step) return std::nullopt;
      return std::max(sigmas(0, law.size_mm), sigmas(1, law.place));
    case LawFamily::slope_from_x:
    case LawFamily::slope_from_y:
      // A slope the other way differs by a linear term, which the settings and others absorb.
      if (found.shape != LawShape::kink || found.towards != law.sign) return std::nullopt;
      return std::max(sigmas(0, law.size_mm * (found.to - found.from) / 1000.0),
                      sigmas(1, law.place));
    case LawFamily::ripple_of_length:
    case LawFamily::ripple_of_angle:
    case LawFamily::ripple_along_x:
      if (found.shape != LawShape::wave) return std::nullopt;
      return std::max(sigmas(0, std::abs(law.size_mm)), sigmas(1, law.extent));
    case LawFamily::drop_at_edge:
      if (found.shape != LawShape::exponential || found.of == Coordinate::border)
        return std::nullopt;
      return sigmas(1, law.extent);
    default:
      return std::nullopt;
  }
}

std::optional<Says> said_of(const std::string& grid_text, const model::effects::Effect& effect) {
  grid::MeasuredGrid grid = grid::files::parse_grid(grid_text, "second.json").grid;
  grid.machine->declared = {&effect};
  const auto found = grid::diagnosis::diagnose(grid, verdict_alone());
  if (!found || found->declared.size() != 1) return std::nullopt;
  return found->declared.front().says;
}

std::optional<double> error_ratio(const generator::SealedSet& set,
                                  const model::effects::Effect& effect) {
  grid::MeasuredGrid grid = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  const auto plain = grid::joint_fit(grid::Measured(grid));
  grid.machine->declared = {&effect};
  const auto own = grid::diagnosis::fit_with_causes(grid::Measured(grid));
  const auto of_plain = plain ? map_errors(set, plain->map) : std::nullopt;
  const auto of_own = own ? map_errors(set, own->fit.map) : std::nullopt;
  if (!of_plain || !of_own) return std::nullopt;
  return of_own->true_rms_mm / of_plain->true_rms_mm;
}

/// From a session, a machine and a seed independent of the first.
void use(const generator::SealedSet& set, const std::vector<Law>& laws, Outcome& outcome) {
  constexpr std::uint64_t kOtherNoise = 70000;
  constexpr std::uint64_t kOtherFamily = 9;
  const auto written = grid::diagnosis::declaration_of(laws, model::Bed{});
  if (!written) return;
  const model::effects::Effect& effect = model::effects::declared_effect(*written);
  const generator::Layout layout = generator::layout_of(outcome.points);
  const std::uint64_t other = outcome.seed + kOtherFamily;
  const auto second = said_of(
      generator::other_session(set, layout.columns, layout.rows, outcome.seed + kOtherNoise),
      effect);
  const auto foreign =
      said_of(generator::draw_set(recipe_of("laws", other), other).grid_text, effect);
  outcome.add("used", true);
  outcome.add("confirmed", second == Says::confirmed);
  outcome.add("denied", foreign == Says::denied);
  outcome.add("mistaken", foreign == Says::confirmed);
  if (const auto ratio = error_ratio(set, effect)) outcome.numbers["error_ratio"] = *ratio;
}

/// The names after a claimed law adds or withdraws some.
std::vector<Claim> given_law(const grid::diagnosis::Diagnosis& found, std::vector<Claim> named) {
  if (!found.unexplained) return named;
  for (const auto& own : found.unexplained->causes_given_law) {
    if (own.parameters.empty()) {
      std::erase_if(named,
                    [&](const Claim& one) { return one.members.front() == id_of(own.cause); });
      continue;
    }
    Claim& more = named.emplace_back(Claim{{id_of(own.cause)}, own.probability});
    for (const auto& same : own.same_as) more.members.push_back(id_of(same));
  }
  return named;
}

void judge_names(const std::vector<Claim>& named, const Trial& trial, const std::string& given,
                 Outcome& outcome) {
  outcome.add("right" + given,
              grid::any_of(named, [&](const Claim& one) { return trial.is_hidden(one); }));
  outcome.add("wrong" + given, grid::any_of(named, [&](const Claim& one) {
                return !trial.is_hidden(one) && one.probability >= grid::diagnosis::kLawClaimed;
              }));
}

generator::BeltRecipe belt_recipe_of(std::string_view kind, std::uint64_t seed) {
  generator::BeltRecipe recipe;
  recipe.nothing = kind != "causes";
  if (kind == "laws") recipe.law = generator::kBeltLaws[seed % generator::kBeltLawsOfOne];
  if (kind == "two") recipe.law = LawFamily::product_of_two;
  if (kind == "gaussian") recipe.law = LawFamily::gaussian_field;
  return recipe;
}

Outcome run_belts_laws_trial(const std::string& kind, std::uint64_t seed) {
  const generator::BeltDraw draw = generator::draw_belts(belt_recipe_of(kind, seed), seed);
  grid::diagnosis::DiagnosisOptions how;
  how.next_measurements = false;
  const auto found = grid::diagnosis::diagnose(measured_belts_of(draw), how);
  Outcome outcome{.seed = seed, .points = static_cast<int>(draw.lengths_mm.size())};
  if (!draw.secret.effect.empty()) outcome.hidden.push_back(draw.secret.effect);
  if (!found) outcome.fail();
  if (found) judge_laws(*found, draw.secret.law ? &*draw.secret.law : nullptr, kOfBelts, outcome);
  return outcome;
}

}  // namespace

void judge_laws(const grid::diagnosis::Diagnosis& found, const generator::SizedLaw* hidden,
                const LawEntries& entries, Outcome& outcome) {
  const std::vector<Law> laws = found.unexplained ? found.unexplained->laws : std::vector<Law>{};
  const bool claimed = !laws.empty() && laws.front().probability >= grid::diagnosis::kLawClaimed;
  outcome.verdict = name(found.verdict);
  for (const Law& law : laws)
    outcome.named.push_back(fmt::format("{}/{}/{}={:.2f}", name(law.of), name(law.shape),
                                        name(law.enters), law.probability));
  outcome.add(claimed ? "claimed" : "unclaimed", true);
  if (hidden == nullptr) return;
  const HiddenLaw& truth = hidden->law;
  outcome.hidden.push_back(
      fmt::format("{}/{}", word(truth.family), name(entry_of(truth, entries))));
  outcome.strength = hidden->delta;
  const auto is_right = [&](const Law& law) {
    return is_variable_of(truth, entries, law) && law.enters == entry_of(truth, entries);
  };
  outcome.add("in_set", grid::any_of(laws, is_right));
  if (laws.empty() || !is_right(laws.front())) return;
  outcome.add("leads", true);
  const auto& left_out = laws.front().held_out;
  outcome.add("wave", is_periodic(laws.front().shape));
  outcome.add("predicts", left_out && left_out->inside.with_mm < left_out->inside.without_mm &&
                              left_out->outside.with_mm < left_out->outside.without_mm);
  if (const auto worst = worst_of(truth, laws.front())) {
    outcome.add("placed", true);
    outcome.add("near", *worst <= 3.0);
    outcome.numbers["worst_sigmas"] = *worst;
  }
}

Outcome run_laws_trial(const std::string& kind, std::uint64_t seed, bool in_use) {
  Outcome outcome;
  if (kind.starts_with(kBeltsKind)) {
    outcome = run_belts_laws_trial(kind.substr(kBeltsKind.size()), seed);
  } else if (kind.starts_with(kHolesKind)) {
    outcome = run_holes_laws_trial(kind.substr(kHolesKind.size()), seed);
  } else {
    const generator::Recipe recipe = recipe_of(kind, seed);
    const generator::SealedSet set = generator::draw_set(recipe, seed);
    outcome = {.seed = seed, .points = recipe.points};
    const auto found = grid::diagnosis::diagnose(
        grid::files::parse_grid(set.grid_text, "sealed.json").grid, verdict_alone());
    if (!found) {
      outcome.fail();
    } else {
      Trial trial(*found);
      for (const auto& hidden : set.answer.hidden) trial.hidden.push_back(id_of(hidden));
      outcome.hidden = trial.hidden;
      judge_names(trial.causes, trial, "", outcome);
      judge_names(given_law(*found, trial.causes), trial, "_given_law", outcome);
      judge_laws(*found, set.answer.law ? &*set.answer.law : nullptr, kOfChains, outcome);
      if (in_use && outcome.has("claimed")) use(set, found->unexplained->laws, outcome);
    }
  }
  outcome.kind = kind;
  return outcome;
}

}  // namespace chaintrue::sealed

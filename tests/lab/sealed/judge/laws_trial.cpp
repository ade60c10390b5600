// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/laws_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/law_declaration.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/other_laws_trials.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::HiddenLaw;
using generator::LawFamily;
using grid::diagnosis::Coordinate;
using grid::diagnosis::Enters;
using grid::diagnosis::Law;
using grid::diagnosis::LawShape;

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

/// As LawsTrial::worst_sigmas.
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

std::optional<LawInUse::Says> said_of(const std::string& grid_text,
                                      const model::effects::Effect& effect) {
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
std::optional<LawInUse> use(const generator::SealedSet& set, const LawsTrial& trial) {
  constexpr std::uint64_t kOtherNoise = 70000;
  constexpr std::uint64_t kOtherFamily = 9;
  const auto written = grid::diagnosis::declaration_of(trial.laws, model::Bed{});
  if (!written) return std::nullopt;
  const model::effects::Effect& effect = model::effects::declared_effect(*written);
  const generator::Layout layout = generator::layout_of(trial.points);
  const std::uint64_t other = trial.seed + kOtherFamily;
  LawInUse result;
  result.second = said_of(
      generator::other_session(set, layout.columns, layout.rows, trial.seed + kOtherNoise), effect);
  result.foreign = said_of(generator::draw_set(recipe_of("laws", other), other).grid_text, effect);
  result.error_ratio = error_ratio(set, effect);
  return result;
}

/// The names after a claimed law adds or withdraws some.
std::vector<NamedCause> given_law(const grid::diagnosis::Diagnosis& found,
                                  std::vector<NamedCause> named) {
  if (!found.unexplained) return named;
  for (const auto& own : found.unexplained->causes_given_law) {
    if (own.parameters.empty()) {
      std::erase_if(named, [&](const NamedCause& one) { return one.id == id_of(own.cause); });
      continue;
    }
    NamedCause more{id_of(own.cause), own.probability, {}};
    for (const auto& same : own.same_as) more.same_as.push_back(id_of(same));
    named.push_back(std::move(more));
  }
  return named;
}

LawsTrial::Names worth_of(const std::vector<NamedCause>& named, const generator::Answer& answer) {
  LawsTrial::Names names;
  for (const NamedCause& one : named) {
    const bool right = std::any_of(answer.hidden.begin(),
                                   answer.hidden.end(),
                                   [&](const auto& hidden) { return means(one, id_of(hidden)); });
    names.right = names.right || right;
    names.wrong = names.wrong || (!right && one.probability >= grid::diagnosis::kLawClaimed);
  }
  return names;
}

}  // namespace

std::string words_of(const generator::SizedLaw& hidden, const LawEntries& entries) {
  const HiddenLaw& law = hidden.law;
  return fmt::format("{} {:.1f} size {:.2f} {} place {:.0f} extent {:.2f} dir {:.0f}",
                     word(law.family),
                     hidden.delta,
                     law.size_mm,
                     name(entry_of(law, entries)),
                     law.place,
                     law.extent,
                     law.direction_rad * 180.0 / std::numbers::pi);
}

void judge_laws(const grid::diagnosis::Diagnosis& found,
                const HiddenLaw* hidden,
                const LawEntries& entries,
                LawsTrial& trial) {
  trial.sentence = found.sentence;
  if (found.unexplained) trial.laws = found.unexplained->laws;
  trial.reported = !trial.laws.empty();
  trial.claimed = trial.reported && trial.laws.front().probability >= grid::diagnosis::kLawClaimed;
  if (hidden == nullptr || !trial.reported) return;
  const auto is_right = [&](const Law& law) {
    return is_variable_of(*hidden, entries, law) && law.enters == entry_of(*hidden, entries);
  };
  trial.leads = is_right(trial.laws.front());
  trial.in_set = std::ranges::any_of(trial.laws, is_right);
  if (trial.leads) trial.worst_sigmas = worst_of(*hidden, trial.laws.front());
}

const std::vector<LawsKind>& laws_kinds() {
  static const std::vector<LawsKind> kKinds = {
      {"laws", "a law of one variable", true},
      {"both", "a law and a listed cause of strength 10", true},
      {"two", "a product of two waves", false},
      {"gaussian", "a Gaussian field", false},
      {"matern", "a Matern 3/2 field", false},
      {"stretched", "a field three times as long one way", false},
      {"uneven", "a field that is rougher on one side", false},
      {"causes", "one listed cause", false},
      {"nothing", "nothing", false},
      {"belts_laws", "a law of one variable in a belt", true},
      {"belts_two", "a product of two waves in a belt", false},
      {"belts_gaussian", "a Gaussian field in a belt", false},
      {"belts_causes", "one listed cause of belts", false},
      {"belts_nothing", "nothing in belts", false},
      {"holes_laws", "a law of one variable, holes", true},
      {"holes_two", "a product of two waves, holes", false},
      {"holes_gaussian", "a Gaussian field, holes", false},
      {"holes_causes", "one listed cause, holes", false},
      {"holes_nothing", "nothing, holes", false},
  };
  return kKinds;
}

LawsTrial run_laws_trial(std::string_view kind, std::uint64_t seed, bool in_use) {
  constexpr std::string_view kBelts = "belts_";
  constexpr std::string_view kHoles = "holes_";
  if (kind.starts_with(kBelts)) return run_belts_laws_trial(kind.substr(kBelts.size()), seed);
  if (kind.starts_with(kHoles)) return run_holes_laws_trial(kind.substr(kHoles.size()), seed);
  const generator::Recipe recipe = recipe_of(kind, seed);
  const generator::SealedSet set = generator::draw_set(recipe, seed);
  LawsTrial trial;
  trial.seed = seed;
  trial.points = recipe.points;
  trial.answer = set.answer;
  const auto found = timed(trial, [&] {
    return grid::diagnosis::diagnose(grid::files::parse_grid(set.grid_text, "sealed.json").grid,
                                     verdict_alone());
  });
  trial.failed = !found;
  if (!found) return trial;
  const std::vector<NamedCause> named = named_causes(*found);
  trial.names = worth_of(named, set.answer);
  trial.names_given_law = worth_of(given_law(*found, named), set.answer);
  judge_laws(*found, set.answer.law ? &set.answer.law->law : nullptr, kOfChains, trial);
  if (in_use && trial.claimed) trial.in_use = use(set, trial);
  return trial;
}

std::string line_of(std::string_view kind, const LawsTrial& trial) {
  std::string text = fmt::format("{} {} {}", kind, trial.seed, trial.points);
  if (trial.answer.law) text += " " + words_of(*trial.answer.law, kOfChains);
  for (const auto& hidden : trial.answer.hidden) text += " " + id_of(hidden);
  if (!trial.hidden.empty()) text += " " + trial.hidden;
  text += fmt::format(" | {}{}{}{}",
                      trial.failed ? "failed " : "",
                      trial.claimed ? "claimed " : "",
                      trial.leads ? "leads " : "",
                      trial.in_set ? "in_set " : "");
  if (trial.worst_sigmas) text += fmt::format("{:.1f}s ", *trial.worst_sigmas);
  for (const Law& law : trial.laws) {
    text += fmt::format("| {} {} {} {:.2f}/{:.2f}",
                        name(law.of),
                        name(law.shape),
                        name(law.enters),
                        law.probability,
                        law.shape_probability);
    if (law.of == Coordinate::across) text += fmt::format(" dir {:.0f}", law.direction_deg);
    for (const auto& p : law.parameters)
      text += fmt::format(" {}={:.2f}+-{:.2f}", p.parameter, p.value, p.sigma);
    if (law.held_out) {
      text += fmt::format(" left out {:.3f}/{:.3f} a quarter {:.3f}/{:.3f}",
                          law.held_out->inside.with_mm,
                          law.held_out->inside.without_mm,
                          law.held_out->outside.with_mm,
                          law.held_out->outside.without_mm);
    }
  }
  if (trial.in_use) {
    const auto said = [](const std::optional<LawInUse::Says>& says) {
      return says ? name(*says) : std::string_view("failed");
    };
    text += fmt::format(" | second {} foreign {} error {:.2f}",
                        said(trial.in_use->second),
                        said(trial.in_use->foreign),
                        trial.in_use->error_ratio.value_or(-1.0));
  }
  return text + fmt::format(" | {:.2f} s", trial.seconds);
}

}  // namespace chaintrue::sealed

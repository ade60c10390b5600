// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/stated_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "generator/hidden/random.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/holes_trial.hpp"
#include "sealed/judge/map_errors.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::CauseCard;
using generator::Dice;
using generator::Hidden;

constexpr std::string_view kTapeZero = "tape_zero_";
constexpr std::string_view kKnownTapeZero = "tape_zero_known";
constexpr int kRepeats = 6;

const CauseCard* card_of(std::string_view kind) {
  for (const CauseCard& card : generator::cards()) {
    if (card.id == kind) return &card;
  }
  return nullptr;
}

bool may_be_of_holes(const CauseCard* card) {
  if (card == nullptr) return true;
  return !card->needs_order() && card->cause != Cause::tape_scale &&
         card->cause != Cause::axes_skew;
}

/// Usual size; side, sign and place drawn.
std::vector<Hidden> usual_effect(const CauseCard* card, int visits, std::uint64_t seed) {
  if (card == nullptr) return {};
  Dice dice(seed, "usual effect");
  Hidden effect{card->cause, card->sides[dice.below(card->sides.size())], card->usual, 0.0};
  if (card->lower < 0.0) effect.size *= dice.sign();
  if (card->place == generator::Place::phase)
    effect.place = dice.uniform(-std::numbers::pi, std::numbers::pi);
  // Chains of the classic machine leave at 0.2 to 1.4 rad below the horizontal.
  if (card->place == generator::Place::angle) effect.place = dice.uniform(0.3, 1.0);
  if (card->place == generator::Place::visit) {
    const auto between = static_cast<std::size_t>(visits - 6);
    effect.place = 3.0 + static_cast<double>(dice.below(between));
  }
  return {effect};
}

void add_errors(const std::string& name, const MapErrors& errors, Outcome& outcome) {
  outcome.numbers[name + "_true_mm"] = errors.true_rms_mm;
  outcome.numbers[name + "_stated_mm"] = errors.stated_rms_mm;
  outcome.numbers[name + "_held"] = 0.5 * errors.covered / errors.places;
}

/// `judge` compares a map with the hidden machine.
template <class Judge>
void fit_both(const grid::Measured& measured, const Judge& judge, Outcome& outcome) {
  const auto plain = grid::joint_fit(measured);
  const auto own = grid::diagnosis::fit_with_causes(measured);
  const std::optional<MapErrors> of_plain = plain ? judge(plain->map) : std::nullopt;
  const std::optional<MapErrors> of_own = own ? judge(own->fit.map) : std::nullopt;
  if (!of_plain || !of_own) return outcome.fail();
  add_errors("plain", *of_plain, outcome);
  add_errors("own", *of_own, outcome);
  outcome.numbers["built"] = own->built_on.empty() ? 0.0 : 1.0;
}

grid::MeasuredGrid grid_of(const std::string& text) {
  return grid::files::parse_grid(text, "sealed.json").grid;
}

void read_chains(const generator::Recipe& recipe, Outcome& outcome) {
  const generator::SealedSet set = generator::draw_set(recipe, outcome.seed);
  fit_both(
      grid_of(set.grid_text),
      [&](const grid::CompensationMap& map) { return map_errors(set, map); }, outcome);
}

void cut_and_tape(const CauseCard* card, double zero_mm, Outcome& outcome) {
  CutHoles cut = cut_holes(usual_effect(card, 0, outcome.seed), outcome.seed);
  for (grid::HoleDistance& distance : cut.set.distances) distance.distance_mm += zero_mm;
  if (outcome.kind == kKnownTapeZero) cut.set.tape.tape_zero_offset_sigma_mm = 0.0;
  fit_both(
      cut.set,
      [&](const grid::CompensationMap& map) { return map_errors_of_free_sheet(cut.machine, map); },
      outcome);
}

}  // namespace

std::vector<std::string> stated_kinds() {
  std::vector<std::string> kinds;
  for (const CauseCard& card : generator::cards()) kinds.emplace_back(card.id);
  kinds.insert(kinds.end(), {"nothing", "tape_zero_known", "tape_zero_0", "tape_zero_2",
                             "tape_zero_5", "tape_zero_6.35"});
  return kinds;
}

Outcome stated_outcome(const std::string& kind, std::uint64_t seed) {
  Outcome outcome{.kind = kind, .seed = seed};
  if (kind.starts_with(kTapeZero)) {
    cut_and_tape(nullptr, std::strtod(kind.c_str() + kTapeZero.size(), nullptr), outcome);
    return outcome;
  }
  const CauseCard* card = card_of(kind);
  constexpr int kWays[] = {28, 28, 60, 117, 0};
  const int points = kWays[(seed - 1) % 5];
  const bool is_of_holes = points == 0 && may_be_of_holes(card);
  if (is_of_holes) {
    cut_and_tape(card, 0.0, outcome);
  } else {
    generator::Recipe recipe;
    recipe.points = points == 0 ? 28 : points;
    recipe.exactly = usual_effect(card, recipe.points + kRepeats, seed);
    if (recipe.exactly.empty()) recipe.kind = generator::Mix::nothing;
    read_chains(recipe, outcome);
    outcome.points = recipe.points;
  }
  outcome.kind += is_of_holes ? ":holes" : fmt::format(":{}", outcome.points);
  return outcome;
}

std::vector<std::string> zero_kinds() {
  return {"moved_left_6_15", "moved_left_10_17", "moved_right_-3_20", "nothing",
          "second_5",        "second_20",        "second_0"};
}

Outcome zero_outcome(const std::string& kind, std::uint64_t seed) {
  Outcome outcome{.kind = kind, .seed = seed};
  generator::Recipe recipe = recipe_of_start();
  char side[6] = "";
  double mm = 0.0, visit = 0.0;
  if (std::sscanf(kind.c_str(), "moved_%5[a-z]_%lf_%lf", side, &mm, &visit) == 3) {
    const auto where =
        side == std::string_view("left") ? generator::Where::left : generator::Where::right;
    recipe.exactly = {{Cause::zero_shift, where, mm, visit}};
  } else {
    recipe.kind = generator::Mix::nothing;
  }
  if (std::sscanf(kind.c_str(), "second_%lf", &mm) != 1) {
    read_chains(recipe, outcome);
    return outcome;
  }
  const generator::SealedSet set = generator::draw_set(recipe, seed);
  const grid::MeasuredGrid first = grid_of(set.grid_text);
  const grid::MeasuredGrid second = grid_of(another_session(set, mm, seed));
  const auto alone = grid::joint_fit(first);
  const auto both = grid::joint_fit({{"first", first}, {"second", second}});
  if (alone) add_errors("plain", map_errors(set, alone->map).value(), outcome);
  if (both) add_errors("own", map_errors(set, both->map).value(), outcome);
  return outcome;
}

}  // namespace chaintrue::sealed

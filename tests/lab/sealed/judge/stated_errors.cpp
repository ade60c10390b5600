// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/stated_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "generator/hidden/random.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/holes_trial.hpp"

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
  return !card->needs_order() && card->cause != Cause::tape_scale && card->cause != Cause::axes_skew;
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

using Judge = std::function<std::optional<MapErrors>(const grid::CompensationMap&)>;

void fit_both(const grid::Measured& measured, const Judge& judge, StatedRow& row) {
  const auto plain = grid::joint_fit(measured);
  const auto own = grid::diagnosis::fit_with_causes(measured);
  const auto of_plain = plain ? judge(plain->map) : std::nullopt;
  const auto of_own = own ? judge(own->fit.map) : std::nullopt;
  if (!of_plain || !of_own) return;
  row.plain = *of_plain;
  row.own = *of_own;
  row.is_built = !own->built_on.empty();
}

void fit_both(const generator::SealedSet& set, StatedRow& row) {
  fit_both(grid::Measured(grid::files::parse_grid(set.grid_text, "sealed.json").grid),
           [&](const grid::CompensationMap& map) { return map_errors(set, map); },
           row);
}

void cut_and_tape(const CauseCard* card, double zero_mm, std::uint64_t seed, StatedRow& row) {
  row.way = "holes";
  CutHoles cut = cut_holes(usual_effect(card, 0, seed), seed);
  for (grid::HoleDistance& distance : cut.set.distances) distance.distance_mm += zero_mm;
  if (row.kind == kKnownTapeZero) cut.set.tape.tape_zero_offset_sigma_mm = 0.0;
  fit_both(grid::Measured(cut.set),
           [&](const grid::CompensationMap& map) { return map_errors_of_free_sheet(cut.machine, map); },
           row);
}

void read_chains(const CauseCard* card, int points, std::uint64_t seed, StatedRow& row) {
  row.way = fmt::format("{}", points);
  generator::Recipe recipe;
  recipe.points = points;
  recipe.exactly = usual_effect(card, points + kRepeats, seed);
  if (recipe.exactly.empty()) recipe.kind = generator::Mix::nothing;
  fit_both(generator::draw_set(recipe, seed), row);
}

/// Sums over machines of squares, mm^2, and of intervals that hold what is true.
struct Tally {
  int machines = 0;
  int built = 0;
  double true_mm2[2] = {0.0, 0.0};
  double stated_mm2[2] = {0.0, 0.0};
  int covered[2] = {0, 0};
  int intervals = 0;

  void add(const StatedRow& row) {
    ++machines;
    built += row.is_built ? 1 : 0;
    intervals += 2 * row.plain.places;
    for (const int which : {0, 1}) {
      const MapErrors& errors = which == 0 ? row.plain : row.own;
      true_mm2[which] += errors.true_rms_mm * errors.true_rms_mm;
      stated_mm2[which] += errors.stated_rms_mm * errors.stated_rms_mm;
      covered[which] += errors.covered;
    }
  }
  [[nodiscard]] std::string line(std::string_view what) const {
    std::string text = fmt::format("| {} | {} ", what, machines);
    const double n = std::max(machines, 1);
    for (const int which : {0, 1}) {
      if (which == 1) text += fmt::format("| {} ", built);
      text += fmt::format("| {:.3f} | {:.3f} | {:.2f} | {:.1f} % ",
                          std::sqrt(true_mm2[which] / n),
                          std::sqrt(stated_mm2[which] / n),
                          std::sqrt(true_mm2[which] / stated_mm2[which]),
                          100.0 * covered[which] / std::max(intervals, 1));
    }
    return text + "|\n";
  }
};

}  // namespace

std::vector<std::string> stated_kinds() {
  std::vector<std::string> kinds;
  for (const CauseCard& card : generator::cards()) kinds.emplace_back(card.id);
  kinds.insert(kinds.end(), {"nothing", "tape_zero_known", "tape_zero_0", "tape_zero_2", "tape_zero_5", "tape_zero_6.35"});
  return kinds;
}

StatedRow stated_row(const std::string& kind, int k) {
  StatedRow row;
  row.kind = kind;
  row.machine = k;
  const auto seed = static_cast<std::uint64_t>(k) + 1;
  if (kind.starts_with(kTapeZero)) {
    cut_and_tape(nullptr, std::strtod(kind.c_str() + kTapeZero.size(), nullptr), seed, row);
    return row;
  }
  const CauseCard* card = card_of(kind);
  if (card == nullptr && kind != "nothing") throw std::runtime_error("no such kind: " + kind);
  constexpr int kWays[] = {28, 28, 60, 117, 0};
  const int points = kWays[k % 5];
  if (points == 0 && may_be_of_holes(card))
    cut_and_tape(card, 0.0, seed, row);
  else
    read_chains(card, points == 0 ? 28 : points, seed, row);
  return row;
}

StatedRow row_of_set(std::string kind, const generator::SealedSet& set) {
  StatedRow row;
  row.kind = std::move(kind);
  fit_both(set, row);
  return row;
}

std::string line_of(const StatedRow& row) {
  std::string text = fmt::format("{} {} {} {}", row.kind, row.way, row.machine, row.is_built ? 1 : 0);
  for (const MapErrors* errors : {&row.plain, &row.own}) {
    text += fmt::format(" {:.6f} {:.6f} {} {}",
                        errors->true_rms_mm,
                        errors->stated_rms_mm,
                        errors->places,
                        errors->covered);
  }
  return text;
}

std::optional<StatedRow> row_of(std::string_view line) {
  std::istringstream in{std::string(line)};
  StatedRow row;
  if (!(in >> row.kind >> row.way >> row.machine >> row.is_built)) return std::nullopt;
  for (MapErrors* errors : {&row.plain, &row.own}) {
    if (!(in >> errors->true_rms_mm >> errors->stated_rms_mm >> errors->places >> errors->covered))
      return std::nullopt;
  }
  return row;
}

std::string stated_table(const std::vector<StatedRow>& rows) {
  std::string text =
      "| hidden | machines | plain: true mm | stated | true / stated | 95 % hold | built on causes | "
      "with causes: true mm | stated | true / stated | 95 % hold |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  const auto pooled = [&](const std::string& what, const std::function<bool(const StatedRow&)>& is_in) {
    Tally tally;
    int failed = 0;
    for (const StatedRow& row : rows) {
      if (!is_in(row)) continue;
      if (row.own.places > 0)
        tally.add(row);
      else
        ++failed;
    }
    if (tally.machines > 0) text += tally.line(what);
    if (failed > 0) text += fmt::format("| {}: no map | {} |\n", what, failed);
  };
  std::vector<std::string> kinds = stated_kinds();
  for (const StatedRow& row : rows) {
    if (std::ranges::find(kinds, row.kind) == kinds.end()) kinds.push_back(row.kind);
  }
  for (const std::string& kind : kinds)
    pooled(kind, [&](const StatedRow& row) { return row.kind == kind; });
  const auto of_effects = [](const StatedRow& row) { return !row.kind.starts_with(kTapeZero); };
  for (const char* way : {"28", "60", "117", "holes"})
    pooled(way, [&](const StatedRow& row) { return of_effects(row) && row.way == way; });
  pooled("all", of_effects);
  return text;
}

}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/rates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "sealed/judge/binomial.hpp"

namespace chaintrue::sealed {
namespace {

/// Allowed difference of a rate between two versions where chance cannot be excluded.
constexpr double kMarginPoints = 1.0;
constexpr double kChance = 0.05;

std::string percent(double share) { return fmt::format("{:.1f}", 100.0 * share); }

std::pair<std::string, std::uint64_t> set_key(const Outcome& o) { return {o.kind, o.seed}; }

bool same_set(const Outcome& a, const Outcome& b) {
  // The strength is written to 0.01; another compiler may round it to a neighbouring value.
  return a.points == b.points && a.hidden == b.hidden && std::abs(a.strength - b.strength) < 0.02;
}

RowComparison compare_row(const RateRow& row,
                          const std::vector<std::pair<Outcome, Outcome>>& pairs) {
  RowComparison result;
  result.hidden = row.hidden;
  result.right_is = row.right_is;
  for (const auto& [frozen, now] : pairs) {
    if (!row.counts(frozen)) continue;
    const bool before = row.right(frozen), after = row.right(now);
    ++result.sets;
    result.both += before && after;
    result.lost += before && !after;
    result.gained += !before && after;
  }
  result.p = sign_test(result.lost, result.gained);
  return result;
}

}  // namespace

bool RateRow::counts(const Outcome& outcome) const {
  const bool is_of_kind = outcome.kind == kind || outcome.kind.ends_with(":" + kind);
  return is_of_kind && outcome.strength >= from_strength && outcome.strength < to_strength;
}

bool RateRow::right(const Outcome& outcome) const {
  return std::all_of(
      facts.begin(), facts.end(), [&](const std::string& fact) { return outcome.has(fact); });
}

const std::vector<RateRow>& rate_rows() {
  static const std::vector<RateRow> rows = {
      {"one cause, strength 6 to 8", "it leads", "single", {"leads"}, 0.0, 8.0},
      {"one cause, 8 to 12", "it leads", "single", {"leads"}, 8.0, 12.0},
      {"one cause, above 12", "it leads", "single", {"leads"}, 12.0},
      {"one cause", "named alone", "single", {"alone"}},
      {"one cause", "among those named", "single", {"held"}},
      {"one cause", "no pattern reported", "single", {"no_pattern"}},
      {"two causes", "both named", "two", {"all"}},
      {"two causes", "nothing else named", "two", {"nothing_false"}},
      {"three causes", "all named", "three", {"all"}},
      {"three causes", "nothing else named", "three", {"nothing_false"}},
      {"a cause and a smooth pattern", "cause named", "beside", {"outright", "all"}},
      {"a cause and a smooth pattern", "pattern reported", "beside", {"pattern"}},
      {"a cause and a smooth pattern", "both", "beside", {"outright", "all", "pattern"}},
      {"a cause and a smooth pattern", "no wrong name", "beside", {"nothing_false"}},
      {"a cause and another pattern", "cause named", "beside_other", {"outright", "all"}},
      {"a cause and another pattern", "pattern reported", "beside_other", {"pattern"}},
      {"a cause and another pattern", "both", "beside_other", {"outright", "all", "pattern"}},
      {"a cause and another pattern", "no wrong name", "beside_other", {"nothing_false"}},
      {"a pattern alone", "reported", "pattern", {"pattern"}},
      {"a pattern alone", "no wrong name", "pattern", {"nothing_false"}},
      {"a pattern near a cause", "reported", "near", {"pattern"}},
      {"a pattern near a cause", "no wrong name of 90 % or more", "near", {"no_false_claim"}},
      {"a cause that is not listed", "unknown pattern", "unlisted", {"refused"}},
      {"a cause that is not listed", "no name of 90 % or more", "unlisted", {"no_false_claim"}},
      {"a tenth of the points bad", "no cause named", "bad_points", {"no_name"}},
      {"a tenth of the points bad", "all found", "bad_points", {"bad_found"}},
      {"a tenth of the points bad", "no more set aside", "bad_points", {"no_more_bad"}},
      {"bad points and a cause", "it leads", "bad_points_and_effect", {"leads"}},
      {"bad points and a cause", "all bad points found", "bad_points_and_effect", {"bad_found"}},
      {"nothing", "no cause named", "nothing", {"no_name"}},
      {"nothing", "no pattern reported", "nothing", {"no_pattern"}},
      {"nothing", "no point set aside", "nothing", {"no_more_bad"}},
      {"nothing, heavy tails", "no cause named", "heavy", {"no_name"}},
      {"nothing, heavy tails", "no pattern reported", "heavy", {"no_pattern"}},
      {"nothing, noise stated wrongly", "no cause named", "wrong_noise", {"no_name"}},
      {"nothing, noise stated wrongly", "no pattern reported", "wrong_noise", {"no_pattern"}},
      {"holes, a long chain", "it leads", "holes", {"leads"}},
      {"holes, nothing", "no cause named", "holes_nothing", {"no_name"}},
      {"belts, one cause, strength 6 to 8", "named alone", "belts_weak", {"alone"}},
      {"belts, one cause, strength 6 to 8", "among those named", "belts_weak", {"held"}},
      {"belts, one cause, strength 6 to 8", "no wrong name", "belts_weak", {"nothing_false"}},
      {"belts, one cause, 8 to 12", "named alone", "belts_middle", {"alone"}},
      {"belts, one cause, 8 to 12", "among those named", "belts_middle", {"held"}},
      {"belts, one cause, 8 to 12", "no wrong name", "belts_middle", {"nothing_false"}},
      {"belts, one cause, 12 to 60", "named alone", "belts_strong", {"alone"}},
      {"belts, one cause, 12 to 60", "among those named", "belts_strong", {"held"}},
      {"belts, one cause, 12 to 60", "no wrong name", "belts_strong", {"nothing_false"}},
      {"belts, nothing", "no cause named", "belts_nothing", {"no_name"}},
      {"belts, nothing", "no pattern alone", "belts_nothing", {"no_pattern"}},
      {"belts, three bad readings", "found and no others", "belts_bad", {"bad_found"}},
      {"belts, three bad readings", "no cause named", "belts_bad", {"no_name"}},
      {"belts, bad readings and a cause", "found and no others", "belts_bad_and_cause", {"bad_found"}},
      {"belts, bad readings and a cause", "cause named", "belts_bad_and_cause", {"held"}}};
  return rows;
}

std::string rates_table(const std::vector<Outcome>& outcomes) {
  std::string text = "| hidden | right is | % | sets | 95 % bounds |\n|---|---|---|---|---|\n";
  for (const RateRow& row : rate_rows()) {
    int hits = 0, of = 0;
    for (const Outcome& outcome : outcomes) {
      if (!row.counts(outcome)) continue;
      ++of;
      hits += row.right(outcome);
    }
    if (of == 0) continue;
    const RateBounds bounds = rate_bounds_95(hits, of);
    text += fmt::format("| {} | {} | {} | {} of {} | {} to {} |\n",
                        row.hidden,
                        row.right_is,
                        percent(static_cast<double>(hits) / of),
                        hits,
                        of,
                        percent(bounds.lower),
                        percent(bounds.upper));
  }
  return text;
}

double RowComparison::difference() const {
  return sets == 0 ? 0.0 : 100.0 * (gained - lost) / sets;
}

bool RowComparison::worse() const { return difference() < -kMarginPoints && p < kChance; }

bool Comparison::worse() const {
  return std::any_of(rows.begin(), rows.end(), [](const auto& row) { return row.worse(); });
}

Comparison compare(const std::vector<Outcome>& frozen,
                   const std::vector<Outcome>& now,
                   const std::vector<RateRow>& rows) {
  std::map<std::pair<std::string, std::uint64_t>, const Outcome*> of_now;
  for (const Outcome& outcome : now) of_now[set_key(outcome)] = &outcome;
  std::vector<std::pair<Outcome, Outcome>> pairs;
  Comparison result;
  for (const Outcome& before : frozen) {
    const auto found = of_now.find(set_key(before));
    if (found == of_now.end()) continue;
    const Outcome& after = *found->second;
    const bool failed = before.verdict == "failed" || after.verdict == "failed";
    if (!failed && !same_set(before, after)) {
      throw std::invalid_argument("these are not the same sets:\n" + line_of(before) + "\n" +
                                  line_of(after));
    }
    pairs.emplace_back(before, after);
    if (line_of(before) != line_of(after)) result.changed.emplace_back(before, after);
  }
  result.sets = static_cast<int>(pairs.size());
  for (const RateRow& row : rows) {
    RowComparison compared = compare_row(row, pairs);
    if (compared.sets > 0) result.rows.push_back(std::move(compared));
  }
  return result;
}

std::string comparison_table(const Comparison& comparison) {
  std::string text =
      "| hidden | right is | sets | right in both | lost | gained | points | p | |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const RowComparison& row : comparison.rows) {
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {:+.1f} | {:.3f} | {} |\n",
                        row.hidden,
                        row.right_is,
                        row.sets,
                        row.both,
                        row.lost,
                        row.gained,
                        row.difference(),
                        row.p,
                        row.worse() ? "WORSE" : "");
  }
  return text;
}

}  // namespace chaintrue::sealed

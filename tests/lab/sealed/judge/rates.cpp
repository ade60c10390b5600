// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/rates.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "grid/containers.hpp"
#include "sealed/judge/binomial.hpp"

namespace chaintrue::sealed {
namespace {

/// Allowed difference of a rate between two versions where chance cannot be excluded.
constexpr double kMarginPoints = 1.0;
constexpr double kChance = 0.05;
/// At which a rate contradicts what is asked.
constexpr double kRare = 1e-3;

std::string percent(double share) { return fmt::format("{:.1f}", 100.0 * share); }

std::pair<std::string, std::uint64_t> set_key(const Outcome& o) { return {o.kind, o.seed}; }

bool same_set(const Outcome& a, const Outcome& b) {
  // The strength is written to 0.01; another compiler may round it to a neighbouring value.
  return a.points == b.points && a.hidden == b.hidden && std::abs(a.strength - b.strength) < 0.02;
}

/// Of a row, all together and by group of kinds.
struct Counted {
  Count all;
  std::map<std::string, Count> groups;
  bool is_pooled = false;

  Counted(const RateRow& row, const std::vector<Outcome>& outcomes) {
    for (const Outcome& outcome : outcomes) {
      if (!row.counts(outcome)) continue;
      is_pooled = is_pooled || (outcome.kind != row.kind && row.kind != "*");
      for (Count* count : {&all, &groups[outcome.group()]}) {
        ++count->of;
        count->hits += row.right(outcome) ? 1 : 0;
      }
    }
  }

  RateBounds bounds() const {
    if (!is_pooled) return rate_bounds_95(all.hits, all.of);
    std::vector<Count> clusters;
    for (const auto& [group, count] : groups) clusters.push_back(count);
    return clustered_bounds(clusters);
  }
};

RowComparison compare_row(const RateRow& row,
                          const std::vector<std::pair<Outcome, Outcome>>& pairs) {
  RowComparison result{row};
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
  return (kind == "*" || outcome.kind == kind || outcome.kind.ends_with(":" + kind)) &&
         outcome.strength >= from_strength && outcome.strength < to_strength &&
         grid::all_of(among, [&](const std::string& fact) { return outcome.has(fact); });
}

bool RateRow::right(const Outcome& outcome) const {
  return grid::all_of(facts, [&](const std::string& fact) { return outcome.has(fact); });
}

std::vector<RateRow> rows_of(const std::string& name) {
  std::vector<RateRow> rows;
  for (const std::vector<std::string>& cells : table("sealed/rows.tsv")) {
    if (cells.front() != name) continue;
    rows.push_back({cells.at(7), cells.at(8), cells.at(1), words_of(cells.at(5), ','),
                    number_of<double>(cells.at(2)), number_of<double>(cells.at(3)),
                    words_of(cells.at(4), ','), number_of<double>(cells.at(6))});
  }
  return rows;
}

std::vector<std::string> kinds_of(const std::vector<RateRow>& rows) {
  std::vector<std::string> kinds;
  for (const RateRow& row : rows) {
    if (!grid::contains(kinds, row.kind)) kinds.push_back(row.kind);
  }
  return kinds;
}

const std::vector<RateRow>& rate_rows() {
  static const std::vector<RateRow> rows = rows_of("sealed");
  return rows;
}

std::string rates_table(const std::vector<Outcome>& outcomes, const std::vector<RateRow>& rows) {
  if (rows.empty()) return "";
  std::string text = "| hidden | right is | % | sets | 95 % bounds |\n|---|---|---|---|---|\n";
  for (const RateRow& row : rows) {
    const Counted counted(row, outcomes);
    const auto& [hits, of] = counted.all;
    if (of == 0) continue;
    const RateBounds bounds = counted.bounds();
    text += fmt::format("| {} | {} | {} | {} of {} | {} to {} |\n", row.hidden, row.right_is,
                        percent(static_cast<double>(hits) / of), hits, of, percent(bounds.lower),
                        percent(bounds.upper));
  }
  return text;
}

std::string missed(const std::vector<Outcome>& outcomes, const std::vector<RateRow>& rows) {
  std::string text;
  for (const RateRow& row : rows) {
    const auto& [hits, of] = Counted(row, outcomes).all;
    if (of > 0 && row.asked > 0.0 &&
        probability_of_at_least(of - hits, of, 1.0 - row.asked) < kRare)
      text += fmt::format("MISSED: {}, {}: {} of {}, {} % asked\n", row.hidden, row.right_is, hits,
                          of, percent(row.asked));
  }
  return text;
}

std::string numbers_table(const std::vector<Outcome>& outcomes) {
  std::map<std::pair<std::string, std::string>, std::vector<double>> all;
  for (const Outcome& outcome : outcomes) {
    for (const auto& [name, value] : outcome.numbers) {
      all[{outcome.group(), name}].push_back(value);
      if (outcome.group() == outcome.kind) continue;
      all[{":" + outcome.way(), name}].push_back(value);
      all[{"all", name}].push_back(value);
    }
  }
  if (all.empty()) return "";
  std::string text =
      "| kind | number | sets | mean | rms | median | least | most "
      "|\n|---|---|---|---|---|---|---|---|\n";
  for (auto& [what, values] : all) {
    grid::sort(values);
    double sum = 0.0, squares = 0.0;
    for (const double value : values) {
      sum += value;
      squares += value * value;
    }
    const auto n = static_cast<double>(values.size());
    text += fmt::format("| {} | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.3f} | {:.3f} |\n",
                        what.first, what.second, values.size(), sum / n, std::sqrt(squares / n),
                        values[values.size() / 2], values.front(), values.back());
  }
  return text;
}

double RowComparison::difference() const {
  return sets == 0 ? 0.0 : 100.0 * (gained - lost) / sets;
}

bool RowComparison::worse() const { return difference() < -kMarginPoints && p < kChance; }

bool Comparison::worse() const {
  return grid::any_of(rows, [](const auto& row) { return row.worse(); });
}

Comparison compare(const std::vector<Outcome>& frozen, const std::vector<Outcome>& now,
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
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {:+.1f} | {:.3f} | {} |\n", row.row.hidden,
                        row.row.right_is, row.sets, row.both, row.lost, row.gained,
                        row.difference(), row.p, row.worse() ? "WORSE" : "");
  }
  return text;
}

}  // namespace chaintrue::sealed

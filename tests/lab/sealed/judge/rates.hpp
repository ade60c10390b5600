// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of rates from the outcomes of sealed sets, and the comparison of two versions'
/// outcomes of the same sets.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// One row of the table: the sets of a kind within a range of strength that have all of `facts`.
struct RateRow {
  std::string hidden;    ///< for the table
  std::string right_is;  ///< for the table
  std::string kind;  ///< or the kind's end, after a colon
  std::vector<std::string> facts;
  double from_strength = 0.0;
  double to_strength = 1e9;

  [[nodiscard]] bool counts(const Outcome& outcome) const;
  [[nodiscard]] bool right(const Outcome& outcome) const;
};
[[nodiscard]] const std::vector<RateRow>& rate_rows();

/// As Markdown, with binomial 95 % bounds; rows without sets are left out.
[[nodiscard]] std::string rates_table(const std::vector<Outcome>& outcomes);

/// One row for two versions on the same sets.
struct RowComparison {
  std::string hidden;
  std::string right_is;
  int sets = 0;
  int both = 0;    ///< right in both
  int lost = 0;    ///< right as frozen, wrong now
  int gained = 0;  ///< wrong as frozen, right now
  double p = 1.0;  ///< sign_test(lost, gained)

  /// In points, new less frozen.
  [[nodiscard]] double difference() const;
  /// By more than one point, and by more than chance gives once in twenty times.
  [[nodiscard]] bool worse() const;
};
struct Comparison {
  std::vector<RowComparison> rows;
  int sets = 0;  ///< present in both
  /// Sets with different outcomes, frozen and new; names and verdicts included.
  std::vector<std::pair<Outcome, Outcome>> changed;

  [[nodiscard]] bool worse() const;
};
/// For the sets present in both. \throws std::invalid_argument if the hidden causes of a set differ:
/// these are not the same sets.
[[nodiscard]] Comparison compare(const std::vector<Outcome>& frozen,
                                 const std::vector<Outcome>& now,
                                 const std::vector<RateRow>& rows = rate_rows());
[[nodiscard]] std::string comparison_table(const Comparison& comparison);

}  // namespace chaintrue::sealed

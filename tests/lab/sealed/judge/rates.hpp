// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Tables of outcomes: rates of facts with their bounds, numbers, and the comparison of two versions'
/// outcomes of the same sets.
#include <string>
#include <utility>
#include <vector>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// One row of a table: the sets of a kind within a range of strength, with all of `among`, that have all of `facts`.
struct RateRow {
  std::string hidden;    ///< for the table
  std::string right_is;  ///< for the table
  std::string kind;      ///< or what follows the colon of several kinds; * for any
  std::vector<std::string> facts;
  double from_strength = 0.0;
  double to_strength = 1e9;
  std::vector<std::string> among{};
  double asked = 0.0;  ///< the least rate; 0: none

  bool counts(const Outcome& outcome) const;
  bool right(const Outcome& outcome) const;
};

/// Those of a table in tests/lab/sealed/rows.tsv.
std::vector<RateRow> rows_of(const std::string& name);

/// Each once, in their order.
std::vector<std::string> kinds_of(const std::vector<RateRow>& rows);

/// Of the frozen list of sealed sets (plan.hpp).
const std::vector<RateRow>& rate_rows();

/// As Markdown, with 95 % bounds: clustered_bounds() of a row that pools kinds. Rows without sets are left out.
std::string rates_table(const std::vector<Outcome>& outcomes,
                        const std::vector<RateRow>& rows = rate_rows());

/// A line for each row whose rate contradicts what is asked: chance alone is as far off once in a thousand.
std::string missed(const std::vector<Outcome>& outcomes, const std::vector<RateRow>& rows);

/// As Markdown: the numbers of each kind up to its colon, of what follows the colon, and of all that have one.
std::string numbers_table(const std::vector<Outcome>& outcomes);

/// One row for two versions on the same sets.
struct RowComparison {
  RateRow row;
  int sets = 0;
  int both = 0;    ///< right in both
  int lost = 0;    ///< right as frozen, wrong now
  int gained = 0;  ///< wrong as frozen, right now
  double p = 1.0;  ///< sign_test(lost, gained)

  /// In points, new less frozen.
  double difference() const;
  /// By more than one point, and by more than chance gives once in twenty times.
  bool worse() const;
};

struct Comparison {
  std::vector<RowComparison> rows;
  int sets = 0;  ///< present in both
  /// Sets with different outcomes, frozen and new; names and verdicts included.
  std::vector<std::pair<Outcome, Outcome>> changed;
  bool worse() const;
};

/// For the sets present in both. \throws std::invalid_argument if the hidden causes of a set differ:
/// these are not the same sets.
Comparison compare(const std::vector<Outcome>& frozen, const std::vector<Outcome>& now,
                   const std::vector<RateRow>& rows = rate_rows());

std::string comparison_table(const Comparison& comparison);

}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The findings of the input checks, and the evidence needed to report an error.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "grid/problem_kind.hpp"

namespace chaintrue::grid::input_checks {

/// How the checked numbers were written: --inches applies to a table.
enum class Written { in_json, in_table };
/// The end of a question about inches.
std::string_view or_say_inches(Written written);

/// A finding about the whole file, or about all rows from one on.
struct WholeFinding {
  std::optional<std::size_t> from_row;
  /// What the mistake looks like, and what to do.
  std::string mistake;
  /// The error of the file as written.
  std::string found;
  /// A wrongly stated machine would look the same: ask, do not refuse.
  bool is_doubtful = false;
  /// Residual of the rows after the correction; unknown if no usual mistake explains them.
  std::optional<double> mended_mm = std::nullopt;
  ProblemKind kind = ProblemKind::other_sheet;

  /// "x_mm and y_mm look like inches: ... (half of the marks are ... off as it stands; ...)"
  std::string sentence() const;
};

/// A finding about one row.
struct RowFinding {
  std::size_t row = 0;
  /// A whole sentence or two, with the value that was meant.
  std::string sentence;
  /// No machine can be fitted to this row as written.
  bool is_impossible = false;
};

struct Findings {
  std::optional<WholeFinding> whole;
  std::vector<RowFinding> rows;
};

/// One account of a file, as written or with one error corrected.
struct Account {
  double log_likelihood = 0.0;
  double median_mm = 0.0;  ///< median residual from the trend
  double prior_chi_square = 0.0;
};

struct Candidate {
  ProblemKind kind = ProblemKind::other_sheet;
  std::string sentence;
  Account account;
  std::optional<std::size_t> from_row = std::nullopt;
  bool is_doubtful = false;
};

/// A corrected file must agree like a sound one.
inline constexpr double kSoundMm = 12.0;
/// A row this far off the trend is not noise, friction or a skipped tooth (6 to 20 mm).
inline constexpr double kGrossMm = 15.0;
inline constexpr double kGrossScales = 8.0;
/// Logarithm of how much likelier a correction must make the file: a hundred times.
inline constexpr double kHundredTimes = 4.605;

/// For a row that is certainly off: the factor by which a question must be likelier than a blunder
/// of any size, three.
inline constexpr double kThreeTimes = 1.099;

/// The likeliest candidate, if it makes the file sound and a hundred times likelier for each of the
/// candidates and what was also tried; and the next one, if nearly as good.
std::optional<WholeFinding> whole_finding(std::vector<Candidate> candidates, const Account& plain,
                                          std::size_t also_tried, double odd_trend,
                                          std::string found);

/// "312 mm", "2.2 m"
std::string length_in_words(double mm);

}  // namespace chaintrue::grid::input_checks

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the input checks find, and by how much an error must explain a file to be named.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "grid/problem_kind.hpp"

namespace chaintrue::grid::input_checks {

/// How the numbers that are checked were written: of a table --inches can say that they are inches.
enum class Written { in_json, in_table };
/// What a question about inches ends with.
[[nodiscard]] std::string_view or_say_inches(Written written);

/// Of the whole file, or of all its rows from one on.
struct WholeFinding {
  std::optional<std::size_t> from_row;
  /// What the mistake looks like, and what to do.
  std::string mistake;
  /// How far off the file is as it stands.
  std::string found;
  /// A machine that is stated as much off would look the same: to be asked, not refused.
  bool is_doubtful = false;
  /// By how much the rows disagree once it is mended; unknown where no usual mistake explains them.
  std::optional<double> mended_mm = std::nullopt;
  ProblemKind kind = ProblemKind::other_sheet;

  /// "x_mm and y_mm look like inches: ... (half of the marks are ... off as it stands; ...)"
  [[nodiscard]] std::string sentence() const;
};

/// Of one row.
struct RowFinding {
  std::size_t row = 0;
  /// A whole sentence or two, with the value that was meant.
  std::string sentence;
  /// No machine can be fitted to this row as it stands.
  bool is_impossible = false;
};

struct Findings {
  std::optional<WholeFinding> whole;
  std::vector<RowFinding> rows;
};

/// One account of a file, as written or with one error corrected.
struct Account {
  double log_likelihood = 0.0;
  double median_mm = 0.0;  ///< what the trend leaves of half of the rows
  double prior_chi_square = 0.0;
};

struct Candidate {
  ProblemKind kind = ProblemKind::other_sheet;
  std::string sentence;
  Account account;
  std::optional<std::size_t> from_row = std::nullopt;
  bool is_doubtful = false;
};

/// A file that is mended agrees like a sound one.
inline constexpr double kSoundMm = 12.0;
/// A row this far off the trend is nobody's noise, friction or skipped tooth (6 to 20 mm).
inline constexpr double kGrossMm = 15.0;
inline constexpr double kGrossScales = 8.0;
/// Logarithm of how much likelier a correction must make the file: a hundred times.
inline constexpr double kHundredTimes = 4.605;

/// Of a row that is off beyond doubt: how much likelier a question must make it than a blunder of any
/// size, three times.
inline constexpr double kThreeTimes = 1.099;

/// The candidate that makes the file the likeliest, where that is sound and makes it a hundred times
/// likelier for each of the `tried`; and the next one, where it does nearly as well.
[[nodiscard]] std::optional<WholeFinding> whole_finding(std::vector<Candidate> candidates,
                                                        const Account& plain,
                                                        std::size_t tried,
                                                        double odd_trend,
                                                        std::string found);

/// "312 mm", "2.2 m"
[[nodiscard]] std::string length_in_words(double mm);

}  // namespace chaintrue::grid::input_checks

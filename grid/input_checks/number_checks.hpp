// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The values that may have been meant by one wrongly written number.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::grid::input_checks {

inline constexpr double kMmPerInch = 25.4;
/// Units in which lengths are written by mistake.
struct WrittenUnit {
  const char* word;
  double mm;
};
inline constexpr WrittenUnit kWrittenUnits[] = {
    {"inches", kMmPerInch}, {"centimetres", 10.0}, {"metres", 1000.0}};
inline constexpr double kMmPerFoot = 304.8;
/// The mark at which a tape is held without its hook.
inline constexpr double kTapeMarkMm = 100.0;

struct NumberError {
  double value = 0.0;  ///< what may have been meant
  /// "is the minus missing?", "is it 563.5 rather than 536.5?"
  std::string question;
  /// Logarithm of the number of values that such errors can give: the penalty for a chance fit.
  double penalty = 0.0;
};

/// A lost or needless minus, digits exchanged, dropped, doubled or wrong, the point at another
/// place, the tape's 100 mm mark or a foot, inches. `is_signed` is false for lengths.
[[nodiscard]] std::vector<NumberError> number_errors(double written, bool is_signed);

/// The shortest decimal text of a number.
std::string digits_of(double value);

}  // namespace chaintrue::grid::input_checks

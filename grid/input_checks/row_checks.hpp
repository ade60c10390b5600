// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Errors in one row of points: the row with each error corrected, and the question to the
/// user.
#pragma once

#include <string>
#include <vector>

#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::input_checks {

struct RowError {
  MeasuredPoint meant;
  /// The questioned number: "y_mm 536.5"; empty for the whole row.
  std::string number;
  std::string question;
  double penalty = 0.0;  ///< as NumberError
  bool mends_reading = false;
};

[[nodiscard]] std::vector<RowError> row_errors(const MeasuredPoint& written);

}  // namespace chaintrue::grid::input_checks

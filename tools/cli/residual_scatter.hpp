// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A chart of residuals against a possible cause: dots of two colours and a curve.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tools/cli/names.hpp"
#include "tools/report/bed_chart.hpp"

namespace chaintrue::cli {

struct ResidualDot {
  std::string name;
  double x = 0.0;
  double y_mm = 0.0;
  bool is_first = true;  ///< of the first colour
  bool is_bad = false;
};

struct ResidualScatter {
  std::string title{};
  std::string caption{};
  std::string x_title{};
  std::vector<ResidualDot> dots{};
  std::vector<std::pair<double, double>> curve{};  ///< x and mm
  std::vector<double> y_also_mm{};  ///< in the window, like good dots, 0 and the curve
  double least_span_mm = 0.2;       ///< of the window
  std::string first_label{};
  std::string second_label{};  ///< empty: one colour
  const char* first_color = report::kBeforeColor;
  const char* second_color = report::kAfterColor;
};

/// Bad dots are drawn at the rim, so that they do not flatten the rest.
[[nodiscard]] Chart residual_scatter_chart(const ResidualScatter& scatter);

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/residual_scatter.hpp"
#include "grid/containers.hpp"

#include <algorithm>

namespace chaintrue::cli {
namespace {

struct Window {
  double low = 0.0;
  double high = 0.0;
};

/// With a margin, and with a positive width.
Window window_of(const std::vector<double>& values, double share, double least) {
  if (values.empty()) return {0.0, least};
  const auto [low, high] = grid::minmax_element(values);
  const double margin = std::max(share * (*high - *low), 0.5 * (least - (*high - *low)));
  return {*low - margin, *high + margin};
}

}  // namespace

Chart residual_scatter_chart(const ResidualScatter& scatter) {
  std::vector<double> along, up = {0.0};
  grid::append_all(up, scatter.y_also_mm);
  for (const ResidualDot& dot : scatter.dots) {
    along.push_back(dot.x);
    if (!dot.is_bad) up.push_back(dot.y_mm);
  }
  for (const auto& [x, y_mm] : scatter.curve) up.push_back(y_mm);
  const Window x = window_of(along, 0.03, 1e-6), y = window_of(up, 0.08, scatter.least_span_mm);
  DataTable points{"points", {"name", "x", "y_mm", "is_first", "is_bad"}, {}};
  for (const ResidualDot& dot : scatter.dots) {
    points.rows.push_back(
        {dot.name, dot.x, std::clamp(dot.y_mm, y.low, y.high), dot.is_first, dot.is_bad});
  }
  DataTable curve{"curve", {"x", "y_mm"}, {}};
  for (const auto& [at, y_mm] : scatter.curve) curve.rows.push_back({at, y_mm});
  Chart chart{
      .specification = "residual_scatter", .title = scatter.title, .caption = scatter.caption};
  chart.data = {std::move(points), std::move(curve)};
  chart.signals = {{"x_title", scatter.x_title},
                   {"x_min", x.low},
                   {"x_max", x.high},
                   {"bottom_mm", y.low},
                   {"top_mm", y.high},
                   {"first_label", scatter.first_label},
                   {"second_label", scatter.second_label},
                   {"first_color", std::string(scatter.first_color)},
                   {"second_color", std::string(scatter.second_color)}};
  return chart;
}

}  // namespace chaintrue::cli

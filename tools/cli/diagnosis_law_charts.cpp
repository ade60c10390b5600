// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the unexplained pattern: their curves among partial residuals, and the bed with and
// without one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/diagnosis/law_words.hpp"
#include "tools/cli/diagnosis_charts.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/residual_scatter.hpp"

namespace chaintrue::cli {
namespace {

using diagnosis::Law;
using diagnosis::LawResidual;
using diagnosis::LawShape;
using diagnosis::PointPicture;

constexpr int kCurvePoints = 200;
/// With more waves than this only one is drawn, with all points on it.
constexpr double kMostWaves = 3.0;

bool is_folded(const Law& law) {
  return is_periodic(law.shape) && law.to - law.from > kMostWaves * law.parameters[1].value;
}

double degrees_of(const Law& law, double at) {
  return diagnosis::unit_of(law.of) == "rad" ? at * 180.0 / std::numbers::pi : at;
}

/// x of a point.
double drawn(const Law& law, double at) {
  if (!is_folded(law)) return degrees_of(law, at);
  const double period = law.parameters[1].value;
  return degrees_of(law, at - law.from - period * std::floor((at - law.from) / period));
}

std::string axis_title(const Law& law) {
  const std::string_view unit = diagnosis::unit_of(law.of);
  const std::string_view words = unit == "rad"  ? "degrees"
                                 : unit == "n"  ? "N"
                                 : unit == "mm" ? "mm"
                                                : "visits";
  const std::string variable = variable_in_words(law);
  if (is_folded(law)) {
    return fmt::format("{}, {} past a full period of {:.4g}",
                       variable,
                       words,
                       degrees_of(law, law.parameters[1].value));
  }
  return unit == "visit" ? variable : fmt::format("{}, {}", variable, words);
}

std::vector<std::pair<double, double>> curve_of(const Law& law) {
  const double span = is_folded(law) ? law.parameters[1].value : law.to - law.from;
  std::vector<std::pair<double, double>> curve;
  if (is_folded(law)) {
    for (int k = 0; k <= kCurvePoints; ++k) {
      const double off = span * k / kCurvePoints;
      curve.emplace_back(degrees_of(law, off), value_of(law, law.from + off));
    }
    return curve;
  }
  std::vector<double> at;
  for (int k = 0; k <= kCurvePoints; ++k) at.push_back(law.from + span * k / kCurvePoints);
  if (law.shape == LawShape::step) {
    // Both ends of the step at its place.
    const double place = std::clamp(law.parameters[1].value, law.from, law.to);
    at = {law.from, place - 1e-9 * (law.to - law.from), place, law.to};
  }
  for (const double v : at) curve.emplace_back(drawn(law, v), value_of(law, v));
  return curve;
}

Chart law_chart(const Law& law, bool is_likeliest) {
  ResidualScatter chart{
      .title = is_likeliest ? "The most probable" : "Its best rival",
      .caption = fmt::format("{}: {}. {}",
                             capitalised(in_words(law)),
                             diagnosis::percent(law.probability),
                             is_likeliest ? "Dots are the readings minus all other known effects; "
                                            "the right curve passes through them."
                                          : "The same readings, under this law."),
      .x_title = axis_title(law),
      .first_label = "readings and curve",
      .first_color = is_likeliest ? report::kAfterColor : report::kNeutralColor};
  for (const LawResidual& point : law.points)
    chart.dots.push_back({point_name(point.index), drawn(law, point.at), point.residual_mm});
  chart.curve = curve_of(law);
  return residual_scatter_chart(chart);
}

}  // namespace

ChartRow law_charts(const Diagnosis& found) {
  const std::vector<Law>& laws = found.unexplained->laws;
  ChartRow row;
  for (std::size_t k = 0; k < std::min<std::size_t>(laws.size(), 2); ++k)
    row.charts.push_back(law_chart(laws[k], k == 0));
  return row;
}

std::vector<ChartRow> law_rest_charts(const Diagnosis& found) {
  const Law& law = found.unexplained->laws.front();
  std::vector<Arrow> before, after;
  for (const PointPicture& point : found.points) {
    const auto own = std::find_if(law.points.begin(), law.points.end(), [&](const LawResidual& p) {
      return p.index == point.index;
    });
    const Eigen::Vector2d& shift = found.causes.empty() ? point.before_mm : point.after_mm;
    before.push_back(arrow_of(point, shift));
    if (own == law.points.end() || !own->left_x_mm || !own->left_y_mm) continue;
    after.push_back(arrow_of(point, {*own->left_x_mm, *own->left_y_mm}));
  }
  return report::arrow_rows(
      bed_of(found),
      before,
      after,
      {found.causes.empty() ? "Without it: the machine calibrated"
                            : "Without it: the residual with the causes",
       "Arrows from the intended to the actual position of the tool. Grey: one sigma of the noise "
       "at that mark.",
       "With it, same scale",
       "Neighbours that still point the same way show an error that the law does not explain "
       "either."});
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// What the residuals follow: chain length, angle at the sprocket, visits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "grid/plane_vectors.hpp"
#include "model/effects/effect.hpp"
#include "tools/cli/diagnosis_sections.hpp"

namespace chaintrue::cli {
namespace {

using grid::row_of;

constexpr const char* kPaidOutColor = report::kThirdColor;
constexpr const char* kTakenInColor = report::kFourthColor;

/// A number of a point, for one of the chains.
using OfChain = std::function<double(const PointPicture&, Side chain)>;

/// A scatter plot's x and the group of each dot.
struct Scatter {
  std::string title;
  std::string caption;
  std::string x_title;
  OfChain x;
  Side chain = Side::left;
  bool by_direction = false;
  /// For the dots of the first colour.
  Eigen::Vector2d PointPicture::*first = &PointPicture::chain_before_mm;
};

/// Means of the good points in stretches of equal width along x.
std::vector<std::pair<double, double>> means_of(const Diagnosis& found, const Scatter& scatter) {
  const std::size_t bins = found.points.size() >= 60 ? 10 : 6;
  const auto all = mapped(
      found.points, [&](const PointPicture& point) { return scatter.x(point, scatter.chain); });
  const auto [low, high] = minmax_element(all);
  std::vector<double> x(bins), y(bins), count(bins);
  for (const auto i : each_index(all)) {
    if (found.points[i].bad) continue;
    const double share = (all[i] - *low) / std::max(*high - *low, 1e-12);
    const auto bin =
        std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, share) * as_double(bins)));
    x[bin] += all[i];
    y[bin] += found.points[i].chain_before_mm[row_of(scatter.chain)];
    count[bin] += 1.0;
  }
  std::vector<std::pair<double, double>> means;
  for (std::size_t i = 0; i < bins; ++i) {
    if (count[i] > 0.0) means.emplace_back(x[i] / count[i], y[i] / count[i]);
  }
  return means;
}

Chart scatter_chart(const Diagnosis& found, const Scatter& scatter) {
  const bool has_after = !scatter.by_direction && !found.causes.empty();
  ResidualScatter chart{
      .title = scatter.title, .caption = scatter.caption, .x_title = scatter.x_title};
  const auto add = [&](const PointPicture& point, double residual_mm, bool is_first) {
    chart.dots.push_back({point_name(point.index), scatter.x(point, scatter.chain), residual_mm,
                          is_first, point.bad});
  };
  for (const PointPicture& point : found.points) {
    const int direction =
        scatter.chain == Side::left ? point.direction_left : point.direction_right;
    add(point, (point.*scatter.first)[row_of(scatter.chain)],
        !scatter.by_direction || direction > 0);
    if (has_after) add(point, point.chain_after_mm[row_of(scatter.chain)], false);
    if (point.bad) continue;
    // Both chains at one scale, so that the noise of one does not look like the error of the other.
    for (const Side side : kSides) {
      chart.y_also_mm.push_back((point.*scatter.first)[row_of(side)]);
      if (has_after) chart.y_also_mm.push_back(point.chain_after_mm[row_of(side)]);
    }
  }
  if (!scatter.by_direction) chart.curve = means_of(found, scatter);
  chart.first_label = scatter.by_direction ? "paid out to get there" : "calibrated";
  if (scatter.by_direction) {
    chart.second_label = "taken in";
    chart.first_color = kPaidOutColor;
    chart.second_color = kTakenInColor;
  } else if (has_after) {
    chart.second_label = "with the cause";
  }
  return residual_scatter_chart(chart);
}

std::vector<ChartRow> length_charts(const Diagnosis& found) {
  const model::Sprocket& sprocket = found.extended_machine.sprocket;
  const double turn_mm = sprocket.teeth * sprocket.pitch_mm;
  std::vector<ChartRow> rows;
  for (const Side chain : kSides) {
    const bool is_last = chain == Side::right;
    rows.push_back(
        {{scatter_chart(
              found,
              {.title = fmt::format("Against the {} chain's length", chain_name(chain)),
               .caption = is_last ? "A slope means a chain that is too long or short, a step a "
                                    "skipped link. The line joins the means of the calibrated dots."
                                  : "",
               .x_title = "chain length, mm",
               .x = [](const PointPicture& point, Side side) { return point.lengths[side]; },
               .chain = chain}),
          scatter_chart(found, {.title = fmt::format("Over one sprocket turn ({:g} mm)", turn_mm),
                                .caption = is_last ? "A wave means an eccentric sprocket." : "",
                                .x_title = "mm past a full turn",
                                .x =
                                    [turn_mm](const PointPicture& point, Side side) {
                                      const double length = point.lengths[side];
                                      return length - turn_mm * std::floor(length / turn_mm);
                                    },
                                .chain = chain})}});
  }
  return rows;
}

/// One chart of each chain, with the caption under the first. \param title names the chain
ChartRow charts_of_chains(const Diagnosis& found, Scatter scatter, std::string_view title) {
  ChartRow row;
  for (const Side chain : kSides) {
    scatter.chain = chain;
    scatter.title = fmt::format(fmt::runtime(title), chain_name(chain));
    row.charts.push_back(scatter_chart(found, scatter));
    scatter.caption.clear();
  }
  return row;
}

ChartRow angle_charts(const Diagnosis& found) {
  return charts_of_chains(
      found,
      {.caption = "A bend at some angle means that the chain touches something below that angle.",
       .x_title = "degrees below the horizontal at the sprocket",
       .x =
           [](const PointPicture& point, Side side) {
             return (side == Side::left ? point.angle_left_rad : point.angle_right_rad) * 180.0 /
                    std::numbers::pi;
           }},
      "Against the {} chain's angle");
}

ChartRow order_charts(const Diagnosis& found) {
  // A cause of the visit shows before it is removed; without one, other causes would only hide the
  // remainder.
  const bool of_the_visit = any_of(found.causes, [](const auto& cause) {
    return effects::depends_on_visit(*cause.cause.effect);
  });
  const bool shows_rest = !of_the_visit && !found.causes.empty();
  return charts_of_chains(
      found,
      {.caption = "Two layers of colour mean friction or play, a slope drift, a step a skipped "
                  "link.",
       .x_title = "number of the visit",
       .x = [](const PointPicture& point, Side) { return as_double(*point.order); },
       .by_direction = true,
       .first = shows_rest ? &PointPicture::chain_after_mm : &PointPicture::chain_before_mm},
      shows_rest ? "The {} chain, visit by visit: what is left" : "The {} chain, visit by visit");
}

}  // namespace

bool has_order(const Diagnosis& found) {
  return !found.points.empty() && all_of(found.points, &PointPicture::order);
}

Section residuals_section(const Diagnosis& found) {
  Section section{"What the error follows"};
  if (is_of_distances(found)) {
    section.blocks.emplace_back(distance_scatter_charts(found));
    section.say(
        "Distances do not show the chain's length at a hole or the order of the holes, "
        "so drift, skipped links and friction cannot be detected.");
    return section;
  }
  append_all(section.blocks, length_charts(found));
  section.blocks.emplace_back(angle_charts(found));
  if (has_order(found)) {
    section.blocks.emplace_back(order_charts(found));
  } else {
    section.say(
        "The order in which the points were visited is not recorded, so drift, skipped "
        "links and friction cannot be detected.");
  }
  if (!found.distances.empty()) section.blocks.emplace_back(distance_scatter_charts(found));
  return section;
}

namespace {

struct Window {
  double low = 0.0;
  double high = 0.0;
};

/// With a margin, and with a positive width.
Window window_of(const std::vector<double>& values, double share, double least) {
  if (values.empty()) return {0.0, least};
  const auto [low, high] = minmax_element(values);
  const double margin = std::max(share * (*high - *low), 0.5 * (least - (*high - *low)));
  return {*low - margin, *high + margin};
}

}  // namespace

Chart residual_scatter_chart(const ResidualScatter& scatter) {
  std::vector<double> along, up = {0.0};
  append_all(up, scatter.y_also_mm);
  for (const ResidualDot& dot : scatter.dots) {
    along.push_back(dot.x);
    if (!dot.is_bad) up.push_back(dot.y_mm);
  }
  for (const auto& [x, y_mm] : scatter.curve) up.push_back(y_mm);
  const Window x = window_of(along, 0.03, 1e-6), y = window_of(up, 0.08, scatter.least_span_mm);
  DataTable points{"points", {"name", "x", "y_mm", "is_first", "is_bad"}};
  for (const ResidualDot& dot : scatter.dots) {
    points.rows.push_back(
        {dot.name, dot.x, std::clamp(dot.y_mm, y.low, y.high), dot.is_first, dot.is_bad});
  }
  DataTable curve{"curve", {"x", "y_mm"}};
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/drawn_measures.hpp"

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::observation {

const Kind drawn_measures{"drawn_measures", "measure", "measures", "point", false};

MeasureRow measure_row(DrawnMeasure::Kind kind, const Vector2d& from, const Vector2d& to,
                       const Vector2d& middle) {
  const Vector2d way = to - from;
  const double length = way.norm();
  const Vector2d along = way / length;
  if (kind == DrawnMeasure::Kind::length)
    return {length, -along.transpose(), along.transpose(), RowVector2d::Zero()};
  const RowVector2d across(-along.y(), along.x());
  const double share = along.dot(middle - from) / length;
  return {across.dot(middle - from), (share - 1.0) * across, -share * across, across};
}

DrawnMeasures::DrawnMeasures(std::vector<DrawnPoint> points, std::vector<DrawnMeasure> measures,
                             double noise_dof)
    : Observation(false, noise_dof), points_(std::move(points)) {
  for (const DrawnMeasure& own : measures) {
    if (!(own.sigma_mm > 0.0))
      throw precondition("a measure with sigma {} mm; it must be positive", own.sigma_mm);
    if (std::max({own.from, own.to, own.middle}) >= points_.size())
      throw precondition("a measure from point {} to {} of {} points", own.from, own.to,
                         points_.size());
  }
  const auto key = [&](std::size_t i) {
    const DrawnMeasure& m = measures[i];
    return std::tie(m.kind, points_[m.from].name, points_[m.to].name, m.value_mm, m.sigma_mm);
  };
  auto order = numbers_below(measures.size());
  sort(order, ascending(key));
  for (const auto i : each_index(points_))
    places_.push_back({i, points_[i].name, points_[i].commanded, points_[i].paid_out});
  measured_.resize(std::ssize(order));
  for (const auto k : each_index(order)) {
    measures_.push_back(measures[order[k]]);
    measured_[as_index(k)] = measures_.back().value_mm;
    units_.push_back({as_index(k), 1, order[k]});
  }
}

tl::expected<Linearisation, Unreachable> DrawnMeasures::linearise(const View& view,
                                                                  const Columns& columns) const {
  const auto at = located(view, columns.parameters);
  if (!at) return failed(at);
  const Index p = columns.parameters ? view.mechanism->values().size() : 0;
  Linearisation line = blank(p + (columns.sheet ? 3 : 0));
  for (const auto k : each_index(measures_)) {
    const auto row = as_index(k);
    const DrawnMeasure& m = measures_[k];
    const Located &from = (*at)[m.from], &to = (*at)[m.to], &middle = (*at)[m.middle];
    const MeasureRow own = measure_row(m.kind, from.at, to.at, middle.at);
    line.predicted[row] = own.value_mm;
    if (columns.parameters) {
      line.by_setting.row(row).head(p) = own.by_from * from.by_parameter +
                                         own.by_to * to.by_parameter +
                                         own.by_middle * middle.by_parameter;
    }
    line.units.push_back({MatrixXd::Constant(1, 1, m.sigma_mm * m.sigma_mm), {}});
  }
  return line;
}

std::string DrawnMeasures::untestable(const Effect& effect, EffectSide) const {
  if (effect.needs != DataNeed::order) return "";
  return fmt::format("a drawing does not show the order of its lines, which {} needs", effect.id);
}

std::string DrawnMeasures::name_of(std::size_t unit) const {
  const DrawnMeasure& m = measures_.at(unit);
  return fmt::format("the {} {}-{}", m.kind == DrawnMeasure::Kind::length ? "length" : "bow of",
                     points_[m.from].name, points_[m.to].name);
}

tl::expected<std::vector<DrawnMeasures::Located>, Unreachable> DrawnMeasures::located(
    const View& view, bool with_parameters) const {
  std::vector<Located> all;
  for (const auto i : each_index(points_)) {
    const auto tool = view.mechanism->locate_by_first(points_[i].paid_out);
    if (!tool) return tl::unexpected(tool.error().at(i));
    Located own{vector_of(*tool), Matrix2Xd::Zero(2, 0)};
    if (with_parameters) {
      const auto lengths =
          view.mechanism->predict(*tool, {}, model::Derivatives::by_position_and_parameter);
      if (!lengths) return tl::unexpected(lengths.error().at(i));
      const Matrix2d slope = lengths->by_position.topRows<2>();
      own.by_parameter = -slope.inverse() * lengths->by_parameter.topRows<2>();
    }
    all.push_back(std::move(own));
  }
  return all;
}

}  // namespace chaintrue::grid::observation

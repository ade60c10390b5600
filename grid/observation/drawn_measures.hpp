// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Measurements on a drawing that the machine made: lengths between drawn crosses, and the bow of a
/// line, with a string held along it.
///
///   K_i   lengths that the controller paid out for cross i (two, counted correctly)
///   q_i   where the tool was: f(q_i) = K_i, dq_i/dtheta = -J_i^-1 df/dtheta
///   u, n along the line from a to b, and across it, to the left going from a to b
///
///   length   |q_b - q_a|,           derivative u (dq_b - dq_a)
///   bow      n (q_m - q_a),         derivative n (dq_m - dq_a - t (dq_b - dq_a))            (1)
///
/// m is the drawn point at which the bow was measured and t its share of the way along the string.
/// Both are independent of the sheet's placement and of the drawing's rotation. Each measure is one
/// row and may be an outlier independently.
///
/// \code
///   const DrawnMeasures readings(points, measures, 15.0);
///   const auto line = readings.linearise(View(mechanism), columns_of(readings));
/// \endcode
#pragma once

#include <fmt/format.h>
#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "grid/containers.hpp"
#include "grid/eigen.hpp"
#include "grid/observation/observation.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::observation {

/// A point that was drawn.
struct DrawnPoint {
  std::string name;            ///< "A"
  model::MarkPoint commanded;  ///< in the controller's own frame
  model::ChainLengths paid_out;
};

struct DrawnMeasure {
  enum class Kind { length, bow } kind = Kind::length;
  /// Into the points.
  std::size_t from = 0;
  std::size_t to = 0;
  std::size_t middle = 0;  ///< of a bow
  double value_mm = 0.0;   ///< a bow is positive to the left, going from `from` to `to`
  double sigma_mm = 0.5;
};

/// (1) as a row: the measure and its derivatives by the three points; for a length `middle` is
/// ignored.
struct MeasureRow {
  double value_mm = 0.0;
  RowVector2d by_from, by_to, by_middle;
};
MeasureRow measure_row(DrawnMeasure::Kind kind, const Vector2d& from, const Vector2d& to,
                       const Vector2d& middle);

class DrawnMeasures final : public Observation {
 public:
  /// Sorts the measures by their points. `noise_dof` are the degrees of freedom of their sigmas.
  /// \throws std::invalid_argument for a sigma that is not positive or a missing point.
  DrawnMeasures(std::vector<DrawnPoint> points, std::vector<DrawnMeasure> measures,
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
    for (std::size_t i = 0; i < points_.size(); ++i)
      places_.push_back({i, points_[i].name, points_[i].commanded, points_[i].paid_out});
    measured_.resize(std::ssize(order));
    for (std::size_t k = 0; k < order.size(); ++k) {
      measures_.push_back(measures[order[k]]);
      measured_[as_index(k)] = measures_.back().value_mm;
      units_.push_back({as_index(k), 1, order[k]});
    }
  }

  const Kind& kind() const override { return drawn_measures; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override {
    const auto at = located(view, columns.parameters);
    if (!at) return tl::unexpected(at.error());
    const Index p = columns.parameters ? view.mechanism->values().size() : 0;
    Linearisation line = blank(p + (columns.sheet ? 3 : 0));
    for (std::size_t k = 0; k < measures_.size(); ++k) {
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

  std::string untestable(const model::effects::Effect& effect,
                         model::effects::EffectSide) const override {
    if (effect.needs != model::effects::DataNeed::order) return "";
    return fmt::format("a drawing does not show the order of its lines, which {} needs", effect.id);
  }

  /// "the length A-B", "the bow of A-B".
  std::string name_of(std::size_t unit) const override {
    const DrawnMeasure& m = measures_.at(unit);
    return fmt::format("the {} {}-{}", m.kind == DrawnMeasure::Kind::length ? "length" : "bow of",
                       points_[m.from].name, points_[m.to].name);
  }

  const std::vector<DrawnPoint>& points() const { return points_; }
  /// In the order of the rows.
  const std::vector<DrawnMeasure>& measures() const { return measures_; }

 private:
  /// A point with its derivative by the parameters, 2 x p or 2 x 0.
  struct Located {
    Vector2d at;
    Matrix2Xd by_parameter;
  };
  [[nodiscard]] tl::expected<std::vector<Located>, Unreachable> located(
      const View& view, bool with_parameters) const {
    const auto wanted = with_parameters ? model::Derivatives::by_position_and_parameter
                                        : model::Derivatives::by_position;
    std::vector<Located> all;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto tool = view.mechanism->locate_by_first(points_[i].paid_out);
      if (!tool) return tl::unexpected(tool.error().at(i));
      Located own{vector_of(*tool), Matrix2Xd::Zero(2, 0)};
      if (with_parameters) {
        const auto lengths = view.mechanism->predict(*tool, {}, wanted);
        if (!lengths) return tl::unexpected(lengths.error().at(i));
        const Matrix2d slope = lengths->by_position.topRows<2>();
        own.by_parameter = -slope.inverse() * lengths->by_parameter.topRows<2>();
      }
      all.push_back(std::move(own));
    }
    return all;
  }

  std::vector<DrawnPoint> points_;
  std::vector<DrawnMeasure> measures_;
};

}  // namespace chaintrue::grid::observation

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

#include <string>
#include <vector>

#include "grid/observation/observation.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::observation {

/// A point that was drawn.
struct DrawnPoint {
  std::string name;     ///< "A"
  MarkPoint commanded;  ///< in the controller's own frame
  ChainLengths paid_out;
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
                double noise_dof);

  const Kind& kind() const override { return drawn_measures; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;

  std::string untestable(const Effect& effect, EffectSide) const override;

  /// "the length A-B", "the bow of A-B".
  std::string name_of(std::size_t unit) const override;

  const std::vector<DrawnPoint>& points() const { return points_; }
  /// In the order of the rows.
  const std::vector<DrawnMeasure>& measures() const { return measures_; }

 private:
  /// A point with its derivative by the parameters, 2 x p or 2 x 0.
  struct Located {
    Vector2d at;
    Matrix2Xd by_parameter;
  };
  [[nodiscard]] tl::expected<std::vector<Located>, Unreachable> located(const View& view,
                                                                        bool with_parameters) const;

  std::vector<DrawnPoint> points_;
  std::vector<DrawnMeasure> measures_;
};

}  // namespace chaintrue::grid::observation

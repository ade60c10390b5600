// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/pattern.hpp"

#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

double bell(double square) { return std::exp(-0.5 * square); }

/// Density of a half-Cauchy over the logarithm of the strength, but for a constant.
double cauchy_weight(double delta) {
  constexpr double kScale = 10.0;
  return delta / (1.0 + std::pow(delta / kScale, 2));
}

}  // namespace

double log_share_of_pattern(int index) {
  double sum = 0.0;
  for (const double delta : kPatternDeltas) sum += cauchy_weight(delta);
  const auto deltas = static_cast<int>(std::size(kPatternDeltas));
  return std::log(cauchy_weight(kPatternDeltas[index % deltas]) / sum) -
         std::log(static_cast<double>(std::size(kPatternShapes)));
}

Eigen::Matrix2d pattern_block(const PatternShape& shape,
                              const PatternPlace& a,
                              const PatternPlace& b) {
  const double dx = std::pow((a.mark.x_mm - b.mark.x_mm) / shape.length_mm, 2);
  const double dy = std::pow((a.mark.y_mm - b.mark.y_mm) / shape.length_mm, 2);
  if (shape.kind == PatternKind::chains) return bell(dx + dy) * Eigen::Matrix2d::Identity();
  return 0.5 * (bell(dx) + bell(dy)) * a.by_mark * b.by_mark.transpose();
}

Eigen::MatrixXd pattern_covariance(const Session& session,
                                   const Rows& rows,
                                   const std::vector<Eigen::Index>& kept,
                                   const PatternShape& shape) {
  // Rows stand in pairs, one a point; readings of the machine come after them.
  std::vector<std::size_t> points;
  for (const Eigen::Index row : kept) {
    if (row < session.point_rows() && row % 2 == 0) {
      points.push_back(static_cast<std::size_t>(row / 2));
    }
  }
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t a = 0; a < points.size(); ++a) {
    const PointState& i = rows.points[points[a]];
    const PatternPlace at{session.points[points[a]].mark, i.by_mark};
    for (std::size_t b = 0; b <= a; ++b) {
      const PointState& j = rows.points[points[b]];
      const PatternPlace there{session.points[points[b]].mark, j.by_mark};
      const Eigen::Matrix2d block =
          i.whitening * pattern_block(shape, at, there) * j.whitening.transpose();
      const auto row = 2 * static_cast<Eigen::Index>(a);
      const auto column = 2 * static_cast<Eigen::Index>(b);
      c.block<2, 2>(row, column) = block;
      c.block<2, 2>(column, row) = block.transpose();
    }
  }
  return c;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/missing_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "interp/require.hpp"
#include "interp/spline_axis.hpp"

namespace chaintrue::interp {
namespace {

/// The spline along one line at its hole `at` as weights on the line's nodes, zero at its holes. Empty
/// with fewer than three present nodes.
std::optional<VectorXd> along(const std::vector<double>& nodes, const VectorXd& line, Index at) {
  std::vector<Index> present;
  for (Index i = 0; i < line.size(); ++i) {
    if (!std::isnan(line[i])) present.push_back(i);
  }
  if (present.size() < 3) return std::nullopt;
  const Eigen::Map<const VectorXd> all(nodes.data(), line.size());
  const VectorXd own = all(present);
  VectorXd weights = VectorXd::Zero(line.size());
  weights(present) = SplineAxis({own.begin(), own.end()}).cardinal_weights(all[at]).col(0);
  return weights;
}

}  // namespace

std::optional<FilledGrid> fill_missing(const std::vector<double>& x_nodes,
                                       const std::vector<double>& y_nodes,
                                       const Eigen::Ref<const MatrixXd>& values) {
  const auto nx = std::ssize(x_nodes);
  const auto ny = std::ssize(y_nodes);
  require(values.rows() == nx && values.cols() == ny, "{} x {} values for {} x {} nodes",
          values.rows(), values.cols(), nx, ny);
  FilledGrid result{values, {}};
  const auto is_hole = values.array().isNaN();
  const MatrixXd holes = is_hole.cast<double>();
  const MatrixXd present = is_hole.select(0.0, values);
  for (Index iy = 0; iy < ny; ++iy) {
    for (Index ix = 0; ix < nx; ++ix) {
      if (!is_hole(ix, iy)) continue;
      const auto row = along(x_nodes, values.col(iy), ix);
      const auto column = along(y_nodes, values.row(ix).transpose(), iy);
      if (!row && !column) return std::nullopt;
      const double by_row = row ? row->dot(present.col(iy)) : NAN;
      const double by_column = column ? column->dot(present.row(ix)) : NAN;
      const bool row_has_more = nx - is_hole.col(iy).count() >= ny - is_hole.row(ix).count();
      const double by_line = row && (!column || row_has_more) ? by_row : by_column;
      double value = by_line;
      double doubt = 0.0;
      if (row && column) {
        doubt = std::abs(by_row - by_column);
        if (row->cwiseAbs().dot(holes * column->cwiseAbs()) == 0.0) {
          value = by_row + by_column - row->dot(present * *column);
          doubt = std::min(std::abs(by_row - value), std::abs(by_column - value));
        }
      }
      result.values(ix, iy) = value;
      result.filled.push_back({ix, iy, doubt, by_line});
    }
  }
  return result;
}

}  // namespace chaintrue::interp

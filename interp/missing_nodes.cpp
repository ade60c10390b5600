// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/missing_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/spline_axis.hpp"

namespace chaintrue::interp {
namespace {

/// The spline along one line at a hole as weights on the line's nodes, zero at its holes. Empty with
/// fewer than three present nodes.
std::optional<VectorXd> along(const std::vector<double>& nodes, const VectorXd& line, double at) {
  std::vector<double> x;
  std::vector<Index> present;
  for (Index i = 0; i < line.size(); ++i) {
    if (!std::isnan(line(i))) {
      x.push_back(nodes[static_cast<std::size_t>(i)]);
      present.push_back(i);
    }
  }
  if (x.size() < 3) return std::nullopt;
  VectorXd weights = VectorXd::Zero(line.size());
  weights(present) = SplineAxis(x).cardinal_weights(at);
  return weights;
}

}  // namespace

std::optional<FilledGrid> fill_missing(const std::vector<double>& x_nodes,
                                       const std::vector<double>& y_nodes,
                                       const Eigen::Ref<const MatrixXd>& values) {
  if (values.rows() != static_cast<Index>(x_nodes.size()) ||
      values.cols() != static_cast<Index>(y_nodes.size())) {
    throw std::invalid_argument(fmt::format("{} x {} values for {} x {} nodes", values.rows(),
                                            values.cols(), x_nodes.size(), y_nodes.size()));
  }
  FilledGrid result{values, {}};
  const auto is_hole = values.array().isNaN();
  const MatrixXd holes = is_hole.cast<double>();
  const MatrixXd present = is_hole.select(0.0, values);
  for (Index iy = 0; iy < values.cols(); ++iy) {
    for (Index ix = 0; ix < values.rows(); ++ix) {
      if (holes(ix, iy) == 0.0) continue;
      const auto row = along(x_nodes, values.col(iy), x_nodes[static_cast<std::size_t>(ix)]);
      const auto column =
          along(y_nodes, values.row(ix).transpose(), y_nodes[static_cast<std::size_t>(iy)]);
      if (!row && !column) return std::nullopt;
      const double by_row = row ? row->dot(present.col(iy)) : NAN;
      const double by_column = column ? column->dot(present.row(ix)) : NAN;
      const bool row_has_more = static_cast<double>(values.rows()) - holes.col(iy).sum() >=
                                static_cast<double>(values.cols()) - holes.row(ix).sum();
      FilledNode node{ix, iy, row && (!column || row_has_more) ? by_row : by_column, 0.0, 0.0};
      node.by_line = node.value;
      if (row && column) {
        node.doubt = std::abs(by_row - by_column);
        if (row->cwiseAbs().dot(holes * column->cwiseAbs()) == 0.0) {
          node.value = by_row + by_column - row->dot(present * *column);
          node.doubt = std::min(std::abs(by_row - node.value), std::abs(by_column - node.value));
        }
      }
      result.values(ix, iy) = node.value;
      result.filled.push_back(node);
    }
  }
  return result;
}

}  // namespace chaintrue::interp

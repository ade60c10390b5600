// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/missing_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/spline_axis.hpp"

namespace chaintrue::interp {
namespace {

/// Value at a hole from the spline along one line: weights of the line's nodes, zero at its holes.
struct LineFill {
  Eigen::VectorXd weights;
  double value;
  std::size_t present;
};

std::optional<LineFill> along(const std::vector<double>& nodes,
                              const Eigen::VectorXd& line,
                              double at) {
  std::vector<double> x;
  std::vector<Eigen::Index> present;
  for (Eigen::Index i = 0; i < line.size(); ++i) {
    if (!std::isnan(line(i))) {
      x.push_back(nodes[static_cast<std::size_t>(i)]);
      present.push_back(i);
    }
  }
  if (x.size() < 3) {
    return std::nullopt;
  }
  LineFill fill{Eigen::VectorXd::Zero(line.size()), 0.0, x.size()};
  fill.weights(present) = SplineAxis(x).cardinal_weights(at);
  fill.value = fill.weights(present).dot(line(present));
  return fill;
}

/// R C f of (1); empty if a node that it needs is missing.
std::optional<double> across(const Eigen::Ref<const Eigen::MatrixXd>& values,
                             const LineFill& row,
                             const LineFill& column) {
  double sum = 0.0;
  for (Eigen::Index iy = 0; iy < values.cols(); ++iy) {
    for (Eigen::Index ix = 0; ix < values.rows(); ++ix) {
      const double weight = row.weights(ix) * column.weights(iy);
      if (weight == 0.0) continue;
      if (std::isnan(values(ix, iy))) return std::nullopt;
      sum += weight * values(ix, iy);
    }
  }
  return sum;
}

}  // namespace

std::optional<FilledGrid> fill_missing(const std::vector<double>& x_nodes,
                                       const std::vector<double>& y_nodes,
                                       const Eigen::Ref<const Eigen::MatrixXd>& values) {
  if (values.rows() != static_cast<Eigen::Index>(x_nodes.size()) ||
      values.cols() != static_cast<Eigen::Index>(y_nodes.size())) {
    throw std::invalid_argument(fmt::format("{} x {} values for {} x {} nodes",
                                            values.rows(),
                                            values.cols(),
                                            x_nodes.size(),
                                            y_nodes.size()));
  }
  FilledGrid result{values, {}};
  for (Eigen::Index iy = 0; iy < values.cols(); ++iy) {
    for (Eigen::Index ix = 0; ix < values.rows(); ++ix) {
      if (!std::isnan(values(ix, iy))) {
        continue;
      }
      const auto row = along(x_nodes, values.col(iy), x_nodes[static_cast<std::size_t>(ix)]);
      const auto column =
          along(y_nodes, values.row(ix).transpose(), y_nodes[static_cast<std::size_t>(iy)]);
      if (!row && !column) return std::nullopt;
      const bool by_row = row && (!column || row->present >= column->present);
      FilledNode node{ix, iy, by_row ? row->value : column->value, 0.0, 0.0};
      node.by_line = node.value;
      if (row && column) {
        node.doubt = std::abs(row->value - column->value);
        if (const auto both = across(values, *row, *column)) {
          node.value = row->value + column->value - *both;
          node.doubt =
              std::min(std::abs(row->value - node.value), std::abs(column->value - node.value));
        }
      }
      result.values(ix, iy) = node.value;
      result.filled.push_back(node);
    }
  }
  return result;
}

}  // namespace chaintrue::interp

// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/missing_nodes.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/spline_axis.hpp"

namespace chaintrue::interp {
namespace {

struct LineFill {
  double value;
  std::size_t present;
};

std::optional<LineFill> along(const std::vector<double>& nodes,
                              const Eigen::VectorXd& line,
                              double at) {
  std::vector<double> x;
  std::vector<double> f;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double value = line(static_cast<Eigen::Index>(i));
    if (!std::isnan(value)) {
      x.push_back(nodes[i]);
      f.push_back(value);
    }
  }
  if (x.size() < 3) {
    return std::nullopt;
  }
  const SplineAxis axis(x);
  const Eigen::Map<const Eigen::VectorXd> values(f.data(), static_cast<Eigen::Index>(f.size()));
  return LineFill{axis.cardinal_weights(at).dot(values), x.size()};
}

}  // namespace

tl::expected<FilledGrid, UnfillableNode> fill_missing(
    const std::vector<double>& x_nodes,
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
      if (!row && !column) {
        return tl::unexpected(UnfillableNode{ix, iy});
      }
      const bool by_row = row && (!column || row->present >= column->present);
      const double value = by_row ? row->value : column->value;
      const double doubt = row && column ? std::abs(row->value - column->value) : 0.0;
      result.values(ix, iy) = value;
      result.filled.push_back({ix, iy, value, doubt});
    }
  }
  return result;
}

}  // namespace chaintrue::interp

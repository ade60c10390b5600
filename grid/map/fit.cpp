// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fit.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/lattice_residual.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

namespace {

/// A full grid and its values.
struct Lattice : LatticeNodes {
  PerSide<MatrixXd> lengths_mm;
};

/// Repeats are averaged.
Lattice lattice_of(const std::vector<LengthPoint>& points) {
  std::vector<MarkPoint> marks;
  for (const LengthPoint& point : points) marks.push_back(point.mark);
  Lattice lattice{lattice_nodes(marks), {}};
  for (const Side side : kSides) {
    MatrixXd& lengths_mm = lattice.lengths_mm[side];
    lengths_mm = MatrixXd::Zero(lattice.visits.rows(), lattice.visits.cols());
    for (const auto i : each_index(points)) {
      const auto [ix, iy] = lattice.of_mark[i];
      lengths_mm(ix, iy) += points[i].lengths[side];
    }
    lengths_mm.array() /= lattice.visits.array().max(1).cast<double>();
  }
  return lattice;
}

/// The prediction of each inner line's nodes by a map without that line.
struct LineErrors {
  std::vector<HeldOutResidual> residuals;
  /// The error that the full grid has between its lines, one sigma: halving the spacing divides a
  /// cubic spline's error by 16, a parabola's (three lines left) by 8.
  double interpolation_sigma_mm = 0.0;
};

LineErrors leave_lines_out(const Lattice& lattice, const interp::TensorEnds& ends, bool columns) {
  const std::vector<double>& lines = columns ? lattice.x_nodes_mm : lattice.y_nodes_mm;
  LineErrors errors;
  double squares = 0.0;
  for (std::size_t line = 1; line + 1 < lines.size(); ++line) {
    Indices x = numbers_below(lattice.x_nodes_mm.size()),
            y = numbers_below(lattice.y_nodes_mm.size());
    std::erase(columns ? x : y, line);
    const auto x_kept = mapped(x, [&](std::size_t i) { return lattice.x_nodes_mm[i]; });
    const auto y_kept = mapped(y, [&](std::size_t i) { return lattice.y_nodes_mm[i]; });
    const auto axes = std::make_shared<const interp::TensorAxes>(x_kept, y_kept, ends);
    const auto spline = [&](const MatrixXd& all) {
      const MatrixXd values = all(x, y);
      return interp::TensorSpline(axes, values, parabola_slopes(x_kept, y_kept, values));
    };
    const interp::TensorSpline left = spline(lattice.lengths_mm.left);
    const interp::TensorSpline right = spline(lattice.lengths_mm.right);
    const std::size_t nodes = columns ? lattice.y_nodes_mm.size() : lattice.x_nodes_mm.size();
    for (const std::size_t node : each_below(nodes)) {
      const std::size_t ix = columns ? line : node;
      const std::size_t iy = columns ? node : line;
      const auto l = left.at(lattice.x_nodes_mm[ix], lattice.y_nodes_mm[iy]);
      const auto r = right.at(lattice.x_nodes_mm[ix], lattice.y_nodes_mm[iy]);
      const auto i = as_index(ix);
      const auto j = as_index(iy);
      HeldOutResidual residual;
      residual.chain_mm = {lattice.lengths_mm.left(i, j) - l.value,
                           lattice.lengths_mm.right(i, j) - r.value};
      residual.mark_jacobian << l.dx, l.dy, r.dx, r.dy;
      squares += residual.chain_mm.squaredNorm();
      errors.residuals.push_back(residual);
    }
  }
  if (!errors.residuals.empty()) {
    const double rms = std::sqrt(squares / (2.0 * as_double(errors.residuals.size())));
    errors.interpolation_sigma_mm = rms / (lines.size() > 4 ? 16.0 : 8.0);
  }
  return errors;
}

tl::expected<void, FitFailure> check_full(const Lattice& lattice) {
  const Index nx = lattice.visits.rows();
  const Index ny = lattice.visits.cols();
  const auto missing = (lattice.visits.array() == 0).count();
  if (missing == 0 && nx >= 2 && ny >= 2) return {};
  return failed(
      FitReason::not_a_grid,
      fmt::format("--surface direct needs a point at every crossing of full rows and columns; "
                  "these points form {} columns and {} rows with {} empty crossings. If the sled "
                  "was off its marks, --surface residual accepts the points as they are",
                  nx, ny, missing));
}

/// SurfaceKind::direct.
tl::expected<CompensationMap, FitFailure> fit_direct(const MeasuredGrid& grid,
                                                     const FitOptions& options) {
  const auto points = length_points(grid);
  if (!points) return failed(FitReason::no_lengths, points.error());
  Lattice lattice = lattice_of(*points);
  if (auto full = check_full(lattice); !full) return failed(full);

  const LineErrors columns = leave_lines_out(lattice, options.ends, true);
  const LineErrors rows = leave_lines_out(lattice, options.ends, false);
  MapContents map;
  map.name = grid.name;
  map.domain = {lattice.x_nodes_mm.front(), lattice.x_nodes_mm.back(), lattice.y_nodes_mm.front(),
                lattice.y_nodes_mm.back()};
  std::vector<MarkPoint> marks;
  for (const LengthPoint& point : *points) marks.push_back(point.mark);
  const MeasuredArea area(marks, map.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  const StatedNoise assumed;
  const StatedNoise noise = grid.noise.value_or(assumed);
  map.noise = {noise.length_mm, noise.position_mm,
               grid.noise ? NoiseSource::stated : NoiseSource::assumed, 1.0};
  std::vector<HeldOutResidual> lines = columns.residuals;
  append_all(lines, rows.residuals);
  map.accuracy.leave_one_out = summarise(lines);
  const HeldOutError by_columns = summarise(columns.residuals);
  const HeldOutError by_rows = summarise(rows.residuals);
  map.accuracy.blocked = by_columns.tool.rms_mm > by_rows.tool.rms_mm ? by_columns : by_rows;
  map.surface =
      DirectSurface{lattice.x_nodes_mm, lattice.y_nodes_mm, lattice.lengths_mm, options.ends,
                    std::hypot(columns.interpolation_sigma_mm, rows.interpolation_sigma_mm)};
  map.notes.push_back(
      "The lengths were interpolated without a machine. With few points the error between them "
      "reaches millimetres near the motors, however accurately each point was measured. "
      "Leave-one-out here leaves out one column or row at a time; blocked is the worse of the "
      "two.");
  const CompensationMap bare(map);
  for (const LengthPoint& point : *points) {
    const auto here = bare.lengths(point.mark);
    if (!here) continue;
    MapPoint result;
    result.mark = point.mark;
    result.lengths = point.lengths;
    const Vector2d chain = difference(point.lengths, here->lengths);
    result.mapped_mm = -(here->mark_jacobian.inverse() * chain);
    map.points.push_back(result);
  }
  const CompensationMap first(map);
  measure_expected_error(first, map.accuracy);
  map.mirror = test_mirror(first);
  return CompensationMap(std::move(map));
}

}  // namespace

tl::expected<CompensationMap, FitFailure> fit(const MeasuredGrid& grid, const FitOptions& options) {
  if (options.surface == SurfaceKind::residual) {
    return joint_fit(grid, {.outside = options.outside, .progress = options.progress})
        .map([](JointFit&& fit) { return std::move(fit.map); });
  }
  const auto corrected = corrected_data(grid);
  if (!corrected) return failed(corrected);
  auto map = fit_direct(corrected->grid, options);
  if (!map) return map;
  return map->with_notes_first(corrected->notes).with_outside(options.outside);
}

}  // namespace chaintrue::grid

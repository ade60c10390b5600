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

/// Repeated readings are averaged; a crossing without a reading is 0.
PerSide<MatrixXd> lengths_at(const LatticeNodes& nodes, const std::vector<LengthPoint>& points) {
  PerSide<MatrixXd> lengths_mm;
  for (const Side side : kSides) {
    MatrixXd& own = lengths_mm[side];
    own = MatrixXd::Zero(nodes.visits.rows(), nodes.visits.cols());
    for (const auto i : each_index(points)) {
      const auto [ix, iy] = nodes.of_mark[i];
      own(ix, iy) += points[i].lengths[side];
    }
    own.array() /= nodes.visits.array().max(1).cast<double>();
  }
  return lengths_mm;
}

/// The prediction of each inner line's nodes by a map without that line.
struct LineErrors {
  std::vector<HeldOutResidual> residuals;
  /// The error that the full grid has between its lines, one sigma: halving the spacing divides a
  /// cubic spline's error by 16, a parabola's (three lines left) by 8.
  double interpolation_sigma_mm = 0.0;
};

LineErrors leave_lines_out(const DirectSurface& surface, bool columns) {
  const auto lines = columns ? &DirectSurface::x_nodes_mm : &DirectSurface::y_nodes_mm;
  const auto across = columns ? &DirectSurface::y_nodes_mm : &DirectSurface::x_nodes_mm;
  LineErrors errors;
  double squares = 0.0;
  for (std::size_t line = 1; line + 1 < (surface.*lines).size(); ++line) {
    Indices x = numbers_below(surface.x_nodes_mm.size()),
            y = numbers_below(surface.y_nodes_mm.size());
    std::erase(columns ? x : y, line);
    MapContents rest;
    auto& left = std::get<DirectSurface>(rest.surface = surface);
    (left.*lines).erase((left.*lines).begin() + static_cast<std::ptrdiff_t>(line));
    for (const Side side : kSides) left.lengths_mm[side] = surface.lengths_mm[side](x, y);
    const MapField field(rest);
    for (const std::size_t node : each_index(surface.*across)) {
      const auto [ix, iy] = columns ? std::pair(line, node) : std::pair(node, line);
      const auto i = as_index(ix), j = as_index(iy);
      const ChainLengths there{surface.lengths_mm.left(i, j), surface.lengths_mm.right(i, j)};
      // Without a machine it has an answer everywhere.
      const MapLengths here =
          field.at({surface.x_nodes_mm[ix], surface.y_nodes_mm[iy]}).value().here;
      const Vector2d off = difference(there, here.lengths);
      squares += off.squaredNorm();
      errors.residuals.push_back({off, here.mark_jacobian});
    }
  }
  if (!errors.residuals.empty()) {
    const double rms = std::sqrt(squares / (2.0 * as_double(errors.residuals.size())));
    errors.interpolation_sigma_mm = rms / ((surface.*lines).size() > 4 ? 16.0 : 8.0);
  }
  return errors;
}

tl::expected<void, FitFailure> check_full(const LatticeNodes& nodes) {
  const Index nx = nodes.visits.rows();
  const Index ny = nodes.visits.cols();
  const auto missing = (nodes.visits.array() == 0).count();
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
  const auto marks = mapped(*points, &LengthPoint::mark);
  const LatticeNodes nodes = lattice_nodes(marks);
  if (auto full = check_full(nodes); !full) return failed(full);
  DirectSurface surface{nodes.x_nodes_mm, nodes.y_nodes_mm, lengths_at(nodes, *points),
                        options.ends};
  const LineErrors columns = leave_lines_out(surface, true);
  const LineErrors rows = leave_lines_out(surface, false);
  surface.interpolation_sigma_mm =
      std::hypot(columns.interpolation_sigma_mm, rows.interpolation_sigma_mm);
  MapContents map;
  map.name = grid.name;
  const auto &x = nodes.x_nodes_mm, &y = nodes.y_nodes_mm;
  map.domain = {x.front(), x.back(), y.front(), y.back()};
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
  map.surface = std::move(surface);
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

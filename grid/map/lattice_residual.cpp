// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/lattice_residual.hpp"

#include <algorithm>
#include <limits>

#include "grid/containers.hpp"
#include "grid/map/fitted_points.hpp"
#include "grid/statistics.hpp"
#include "interp/missing_nodes.hpp"

namespace chaintrue::grid {
namespace {

/// Marks within this of a line lie on it.
constexpr double kOnLineMm = 0.01;
constexpr double kEmpty = std::numeric_limits<double>::quiet_NaN();
/// Share of the readings that the effective parameters make up where restricted maximum likelihood
/// finds no noise.
constexpr double kMetClosely = 0.95;
/// One line with a node left out predicts it up to 1.6 times as badly as a surface does, without
/// noise, and 3.4 to 6 times with noise, which the lines' ends amplify.
constexpr double kStillPredicts = 2.0;
/// Halving the spacing divides the error of a cubic by 16 inside, by some 8 in the cells at the
/// ends.
constexpr double kHalvedSpacing = 8.0;

/// The distinct coordinates, rising; of those on one line the least.
std::vector<double> lines_at(std::vector<double> coordinates_mm) {
  sort(coordinates_mm);
  const auto same = [](double a, double b) { return b - a <= kOnLineMm; };
  coordinates_mm.erase(std::unique(coordinates_mm.begin(), coordinates_mm.end(), same),
                       coordinates_mm.end());
  return coordinates_mm;
}

/// The line of one of the coordinates that formed the lines.
Index line_at(const std::vector<double>& lines_mm, double coordinate_mm) {
  return std::lower_bound(lines_mm.begin(), lines_mm.end(), coordinate_mm - kOnLineMm) -
         lines_mm.begin();
}

/// The node of each point of the fit; rejected points and places without a point are empty nodes.
std::optional<LatticeNodes> places_of(const std::vector<FittedPoint>& points) {
  std::vector<MarkPoint> marks;
  Index good = 0;
  for (const FittedPoint& point : points) {
    marks.push_back(point.point.mark);
    good += point.is_rejected() ? 0 : 1;
  }
  LatticeNodes places = lattice_nodes(marks);
  constexpr Index kFewestLines = 4;
  const Index nodes = places.visits.size();
  if (std::min(places.visits.rows(), places.visits.cols()) < kFewestLines) return std::nullopt;
  if (places.visits.maxCoeff() > 1 || 10 * (nodes - good) > nodes) return std::nullopt;
  return places;
}

/// Measured minus the calibrated machine with its chains' scales, at every node; empty ones NaN.
PerSide<MatrixXd> left_by_machine(const estimation::Estimate& estimate,
                                  const std::vector<FittedPoint>& points,
                                  const LatticeNodes& places) {
  const MatrixXd none = MatrixXd::Constant(places.visits.rows(), places.visits.cols(), kEmpty);
  PerSide<MatrixXd> values{none, none};
  const ReadingModel model(estimate.machine);
  const SheetPlacement& sheet = estimate.observations.front().sheet;
  for (const auto i : each_index(points)) {
    if (points[i].is_rejected()) continue;
    const LengthPoint& point = points[i].point;
    // The fit reached every point with these settings.
    const ChainLengths lengths = model.at(sheet.to_bed(point.mark)).value().lengths;
    const auto [ix, iy] = places.of_mark[i];
    for (const Side side : kSides) {
      values[side](ix, iy) =
          point.lengths[side] - (1.0 + estimate.surface.scale[side]) * lengths[side];
    }
  }
  return values;
}

/// The longer line's prediction of a left-out node, NaN if it cannot be filled: the measure of the
/// surface's error between the nodes.
double predicted(const LatticeNodes& places, MatrixXd values, Index ix, Index iy) {
  values(ix, iy) = kEmpty;
  const auto filled = interp::fill_missing(places.x_nodes_mm, places.y_nodes_mm, values);
  if (!filled) return kEmpty;
  auto* node =
      find_where(filled->filled, [&](const auto& one) { return one.ix == ix && one.iy == iy; });
  return node->by_line;
}

}  // namespace

std::optional<LatticeFit> fit_lattice(const estimation::Estimate& estimate,
                                      const std::vector<FittedPoint>& points) {
  const auto places = places_of(points);
  if (!places) return std::nullopt;
  const PerSide<MatrixXd> values = left_by_machine(estimate, points, *places);
  LatticeFit lattice;
  std::vector<Vector2d> errors_here;
  std::vector<Vector2d> errors_there;
  for (const auto i : each_index(points)) {
    const auto [ix, iy] = places->of_mark[i];
    Vector2d residual = points[i].left_out;
    if (!points[i].is_rejected()) {
      errors_there.push_back(residual);
      for (const Side side : kSides) {
        residual[row_of(side)] =
            values[side](ix, iy) - predicted(*places, values[side], ix, iy);
      }
      if (!residual.allFinite()) return std::nullopt;
      errors_here.push_back(residual);
    }
    lattice.left_out_residual_mm.push_back(residual);
  }
  const bool noisy =
      estimate.effective_parameters < kMetClosely * 2.0 * as_double(errors_here.size());
  if (noisy || rms(errors_here) > kStillPredicts * rms(errors_there)) return std::nullopt;

  lattice.residual.x_nodes_mm = places->x_nodes_mm;
  lattice.residual.y_nodes_mm = places->y_nodes_mm;
  lattice.residual.doubt_mm = MatrixXd::Zero(values.left.rows(), values.left.cols());
  for (Side side : kSides) {
    const auto filled = interp::fill_missing(places->x_nodes_mm, places->y_nodes_mm, values[side]);
    if (!filled) return std::nullopt;
    lattice.residual.values_mm[side] = filled->values;
    for (const interp::FilledNode& node : filled->filled) {
      double& doubt = lattice.residual.doubt_mm(node.ix, node.iy);
      doubt = std::max({doubt, node.doubt, rms(errors_here)});
    }
  }
  lattice.residual.interpolation_sigma_mm = rms(errors_here) / kHalvedSpacing;
  return lattice;
}

LatticeNodes lattice_nodes(const std::vector<MarkPoint>& marks) {
  std::vector<double> x, y;
  for (const MarkPoint& mark : marks) {
    x.push_back(mark.x_mm);
    y.push_back(mark.y_mm);
  }
  LatticeNodes nodes{lines_at(std::move(x)), lines_at(std::move(y)), {}, {}};
  nodes.visits = Eigen::MatrixXi::Zero(std::ssize(nodes.x_nodes_mm), std::ssize(nodes.y_nodes_mm));
  for (const MarkPoint& mark : marks) {
    const auto [ix, iy] = nodes.of_mark.emplace_back(
        std::array{line_at(nodes.x_nodes_mm, mark.x_mm), line_at(nodes.y_nodes_mm, mark.y_mm)});
    ++nodes.visits(ix, iy);
  }
  return nodes;
}

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_holes.hpp"

#include <Eigen/LU>
#include <cmath>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/containers.hpp"
#include "grid/map/tool_displacement.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"
#include "model/belts/belt_mechanism.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid::belts {

namespace {

/// Writes the rows of a set from `row` on, after those of the sets before it; false if the machine
/// cannot hold the tool at one of its holes. `origin`: where the first set's commands count from.
bool put_set(const BeltHoles& holes, const AnchorVector& anchors, double factor, FramePoint origin,
             Index row, TapedRows& all) {
  if (!holes.machine.anchors_known) {
    throw precondition("{} holes of a machine whose anchors in force are not known",
                       holes.set.holes.size());
  }
  const auto mechanism = make_belt_mechanism(holes.machine)->with_values(anchors);
  const FramePoint centre = centre_of(holes.machine);
  const auto count = std::ssize(holes.set.holes);
  const Index first = 2 * std::ssize(all.marks);
  std::vector<MarkPoint> marks;
  MatrixXd marks_by_frame = MatrixXd::Zero(2 * count, kFrameUnknowns);
  MatrixXd laid(2 * count, 3);
  for (const Index i : each_below(count)) {
    const auto place = observation::placed_hole(
        *mechanism, hole_at(holes.machine, holes.set.holes[as_size(i)].commanded));
    if (!place) return false;
    const Vector2d mark = factor * (place->at - vector_of(centre));
    marks.push_back({mark.x(), mark.y()});
    all.marks.push_back(
        {factor * (place->at.x() - origin.x_mm), factor * (place->at.y() - origin.y_mm)});
    marks_by_frame.block<2, kAnchorUnknowns>(2 * i, 0) = factor * place->by_parameter;
    marks_by_frame.block<2, 1>(2 * i, kAnchorUnknowns) = mark;
    laid.middleRows<2>(2 * i) = SheetPlacement{}.sensitivity(marks.back());
  }
  const observation::DistanceGeometry geometry = observation::distance_geometry(holes.set, marks);
  const Index own = geometry.predicted_mm.size();
  for (const Index k : each_below(own)) {
    all.residual_mm[row + k] =
        length_of(holes.set, holes.set.distances[as_size(k)]) - geometry.predicted_mm[k];
  }
  const MatrixXd by_sheet = geometry.by_mark * laid;
  all.by_mark.block(row, first, own, 2 * count) = geometry.by_mark;
  all.by_frame.middleRows(row, own) = geometry.by_mark * marks_by_frame;
  all.by_sheet.middleRows(row, own) = by_sheet;
  const observation::DistanceNoise noise = observation::distance_noise(holes.set, geometry);
  auto scaled = all.noise_mm2.block(row, row, own, own);
  scaled = noise.holes_mm2;
  scaled.diagonal() += noise.tape_mm2;
  all.shared_mm2.block(row, row, own, own) =
      noise.size_mm2 + noise.tape_zero_mm2 +
      linear::outer(by_sheet * observation::kSheetByEdges.sigma().asDiagonal());
  return true;
}

}  // namespace

std::optional<TapedRows> taped_rows(const std::vector<BeltHoles>& sets, const AnchorVector& anchors,
                                    double log_scale) {
  Index distances = 0;
  Index holes = 0;
  for (const BeltHoles& set : sets) {
    distances += std::ssize(set.set.distances);
    holes += std::ssize(set.set.holes);
  }
  TapedRows all{VectorXd(distances),
                MatrixXd(distances, kFrameUnknowns),
                MatrixXd::Zero(distances, 2 * holes),
                MatrixXd(distances, 3),
                {},
                MatrixXd::Zero(distances, distances),
                MatrixXd::Zero(distances, distances)};
  const FramePoint origin = centre_of(sets.front().machine);
  Index row = 0;
  for (const BeltHoles& set : sets) {
    if (!put_set(set, anchors, std::exp(log_scale), origin, row, all)) return std::nullopt;
    row += std::ssize(set.set.distances);
  }
  return all;
}

MatrixXd taped_covariance(const TapedRows& rows, const TapedNoise& noise, const Flags& counting) {
  MatrixXd covariance = noise.factor * noise.factor * rows.noise_mm2 + rows.shared_mm2;
  if (noise.size_mm > 0.0) {
    const MatrixXd kernel = displacement_kernel(rows.marks, rows.marks, noise.reach_mm);
    for (const Index axis : {0, 1}) {
      const MatrixXd by_axis =
          rows.by_mark(Eigen::all, Eigen::seq(axis, Eigen::last, Eigen::fix<2>));
      covariance += noise.size_mm * noise.size_mm * linear::carried(by_axis, kernel);
    }
  }
  for (const auto k : each_index(counting)) {
    if (!counting[k]) covariance(as_index(k), as_index(k)) += kRejectedMm2;
  }
  return covariance;
}

}  // namespace chaintrue::grid::belts

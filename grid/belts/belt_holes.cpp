// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_holes.hpp"

#include <Eigen/LU>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/precondition.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::BedPoint;
using model::Belt;
using model::FramePoint;

namespace {

Eigen::Vector2d place_of_anchor(const model::Anchor& anchor) { return {anchor.x_mm, anchor.y_mm}; }

/// Where the upper spans end, and u_i . (dm - dA_i) = 0 with u_i from anchor i to the tool.
struct Placed {
  Eigen::Vector2d at;
  Eigen::Matrix<double, 2, kAnchorUnknowns> by_anchors;
};

std::optional<Placed> placed(const model::BeltMachine& in_force,
                             const model::BeltMachine& machine,
                             BedPoint command) {
  const FramePoint meant = model::to_frame(in_force, command);
  const Eigen::Vector2d target(meant.x_mm, meant.y_mm);
  const Eigen::Vector2d tl = place_of_anchor(machine.anchors.tl);
  const Eigen::Vector2d tr = place_of_anchor(machine.anchors.tr);
  const auto place = model::crossing({tl.x(), tl.y()},
                                     (target - place_of_anchor(in_force.anchors.tl)).norm(),
                                     {tr.x(), tr.y()},
                                     (target - place_of_anchor(in_force.anchors.tr)).norm());
  if (!place) return std::nullopt;
  Placed result{{place->x_mm, place->y_mm}, Eigen::Matrix<double, 2, kAnchorUnknowns>::Zero()};
  Eigen::Matrix2d ways;
  ways.row(0) = (result.at - tl).normalized();
  ways.row(1) = (result.at - tr).normalized();
  const Eigen::Matrix2d inverse = ways.inverse();
  // tl x, tl y, tr x, tr y; the lower anchors move no hole.
  result.by_anchors.middleCols<2>(0) = inverse.col(0) * ways.row(0);
  result.by_anchors.middleCols<2>(2) = inverse.col(1) * ways.row(1);
  return result;
}

}  // namespace

Eigen::Vector3d sheet_variance() {
  using observation::kSheetShiftMm;
  using observation::kSheetTurnRad;
  return {
      kSheetShiftMm * kSheetShiftMm, kSheetShiftMm * kSheetShiftMm, kSheetTurnRad * kSheetTurnRad};
}

std::optional<HoleRows> hole_rows(const BeltHoles& holes,
                                  const AnchorVector& anchors,
                                  double log_scale) {
  if (!holes.machine.anchors_known) {
    throw precondition("{} holes of a machine whose anchors in force are not known",
                       holes.set.holes.size());
  }
  const model::BeltMachine machine = with_anchors(holes.machine, anchors);
  const FramePoint centre = model::centre_of(holes.machine);
  const double factor = std::exp(log_scale);
  const auto count = std::ssize(holes.set.holes);
  HoleRows rows;
  rows.marks_by_frame = Eigen::MatrixXd::Zero(2 * count, kFrameUnknowns);
  Eigen::MatrixXd laid(2 * count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto place = placed(holes.machine, machine, holes.set.holes[as_size(i)].commanded);
    if (!place) return std::nullopt;
    const Eigen::Vector2d mark = factor * (place->at - Eigen::Vector2d(centre.x_mm, centre.y_mm));
    rows.frame_places.push_back({place->at.x(), place->at.y()});
    rows.marks.push_back({mark.x(), mark.y()});
    rows.marks_by_frame.block<2, kAnchorUnknowns>(2 * i, 0) = factor * place->by_anchors;
    rows.marks_by_frame.block<2, 1>(2 * i, kAnchorUnknowns) = mark;
    laid.middleRows<2>(2 * i) << 1.0, 0.0, -mark.y(), 0.0, 1.0, mark.x();
  }
  const observation::DistanceGeometry geometry =
      observation::distance_geometry(holes.set, rows.marks);
  rows.residual_mm.resize(geometry.predicted_mm.size());
  for (Eigen::Index k = 0; k < rows.residual_mm.size(); ++k) {
    rows.residual_mm[k] =
        length_of(holes.set, holes.set.distances[as_size(k)]) - geometry.predicted_mm[k];
  }
  rows.by_mark = geometry.by_mark;
  rows.by_size = geometry.by_size;
  rows.by_frame = geometry.by_mark * rows.marks_by_frame;
  rows.by_sheet = geometry.by_mark * laid;
  return rows;
}

Eigen::MatrixXd hole_covariance(const BeltHoles& holes, const HoleRows& rows, double noise_factor) {
  observation::DistanceGeometry geometry{rows.residual_mm, rows.by_mark, rows.by_size};
  const observation::DistanceNoise noise = observation::distance_noise(holes.set, geometry);
  Eigen::MatrixXd covariance = noise.holes_mm2;
  covariance.diagonal() += noise.tape_mm2;
  covariance *= noise_factor * noise_factor;
  return covariance + noise.size_mm2 + noise.tape_zero_mm2 +
         rows.by_sheet * sheet_variance().asDiagonal() * rows.by_sheet.transpose();
}

}  // namespace chaintrue::grid::belts

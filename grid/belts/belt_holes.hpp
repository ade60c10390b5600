// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Holes that a four-belt router cut at commanded places, and the taped distances between them.
///
/// Notation
///   a, s   the frame (anchor_fit.hpp): five coordinates of anchors, logarithm of the scale
///   m_i    where the spans that the controller paid out for hole i end, by its upper two belts: the
///          circles about the anchors in a meet there; in the frame's own millimetres
///   q_i    exp(s) (m_i - c), c where the controller's commands count from: on the sheet, but for
///          where the sheet lies
///   d_k    a distance as distance_geometry() has it of the q_i
///
///   C = f^2 (tape^2 I + hole^2 B B') + size^2 w w' + zero^2 1 1' + P S P' + G K G'          (1)
///
/// with B = G = dd/dq, P = dd/d(where the sheet lies), which edges alone notice, and f how much
/// larger the noise is than stated. K is the covariance of what displaces neighbouring holes equally
/// (tool_displacement.hpp), or nothing.
///
/// Arm, extension and heights cancel in m_i: controller and machine share them.
///
/// \code
///   const BeltHoles holes{machine_in_force, set};
///   const auto rows = belts::taped_rows({holes}, belts::anchors_of(fit.machine), 0.0);
///   if (rows) residual = rows->residual_mm;
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/observation/measured_holes.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

struct BeltHoles {
  /// With the anchors and scales in force when the holes were cut.
  BeltMachine machine;
  /// Its machine hangs on chains and is ignored.
  MeasuredHoles set;
};

}  // namespace chaintrue::grid

namespace chaintrue::grid::belts {

/// Anchors, then the logarithm of the scale.
inline constexpr Index kFrameUnknowns = kAnchorUnknowns + 1;

/// Added to the variance of a rejected distance, mm^2: a sigma of ten metres, so that it has no
/// weight.
inline constexpr double kRejectedMm2 = 1e8;

/// The distances of all sets about a frame, one set after the other; mm.
struct TapedRows {
  VectorXd residual_mm;          ///< n, taped (less the tape's zero offset) less predicted
  MatrixXd by_frame;             ///< n x 6, d(predicted)/d(a, s)
  MatrixXd by_mark;              ///< n x 2 N
  MatrixXd by_sheet;             ///< n x 3, by its own sheet's shift in x and y, and its turn
  std::vector<MarkPoint> marks;  ///< of all holes, from where the first set's commands count
  MatrixXd noise_mm2;            ///< the factor of f^2 in (1)
  MatrixXd shared_mm2;           ///< of (1) what sizes, zeros and sheets share
};
/// Empty if the machine cannot hold the tool at a hole. \throws std::invalid_argument for a
/// machine whose anchors in force are not known.
std::optional<TapedRows> taped_rows(const std::vector<BeltHoles>& sets, const AnchorVector& anchors,
                                    double log_scale);

/// Size and reach of the displacement, and the factor on the stated noise.
struct TapedNoise {
  double factor = 1.0;
  double size_mm = 0.0;  ///< 0: no displacement
  double reach_mm = 1.0;
};
/// (1), with rejected distances given no weight.
MatrixXd taped_covariance(const TapedRows& rows, const TapedNoise& noise, const Flags& counting);
}  // namespace chaintrue::grid::belts

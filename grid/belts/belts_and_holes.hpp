// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One fit of the lengths that four belts measured and of holes that were cut and taped: anchors,
/// the absolute scale, and the displacement of the tool from where its upper two belts put it.
///
/// Notation
///   x   five coordinates of anchors and the logarithm of the scale; about x_b with covariance S_b
///       from the belts (places projected out) or, without belts, as stated
///   r   distances minus their prediction from x; r_b = r + J (x - x_b), J = d(predicted)/dx
///   C   covariance of the distances, (1) of belt_holes.hpp
///
///   minimise  (x - x_b)' S_b^-1 (x - x_b) + r' C^-1 r                                       (1)
///   V = C + J S_b J',   log p = -1/2 (r_b' V^-1 r_b + log |V|)                              (2)
///   left out:  [V^-1 r_b]_i / [V^-1]_ii with variance 1 / [V^-1]_ii                         (3)
///
/// The noise's factor (a scaled inverse chi square of noise_dof) and the displacement's size and
/// reach maximise (2) on a grid finer than so few readings can resolve; a displacement is included
/// if it is twenty times as likely, summed over the grid, as none. A distance beyond 3.5 sigmas of
/// (3) is rejected, the worst first.
///
/// The displacement is what the holes show; residuals of the belts' lengths are not part of it.
///
/// The map's frame is that of the first set's sheet: by its edges where they were measured in all
/// directions, otherwise so laid that its holes, as a whole, lie where they were commanded.
///
/// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations
/// 5.8 for (2) and 5.12 for (3).
///
/// \code
///   const auto fit = fit_belts_and_holes(belts, {{belts.machine, holes}});
///   if (fit) use(fit->belts.machine, fit->belts.scale->factor, fit->holes.displacement);
/// \endcode
#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/belt_holes.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/map/tool_displacement.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// Prior sigma of the scale: no known machine has a belt per turn that is 2 % off its nominal
/// length.
inline constexpr double kBeltScaleSigma = 0.02;
/// One sigma of a stated anchor coordinate without belt readings: the accuracy that six places
/// about the middle give (docs/maslow4.md).
inline constexpr double kStatedAnchorMm = 50.0;
/// Solving (2) takes a second for this many.
inline constexpr std::size_t kMostTapedByBelts = 400;

/// A fitted hole.
struct BeltHole {
  std::string name;
  BedPoint commanded;
  /// Where the upper two belts put it, relative to the origin of commands, mm; the sheet may lie
  /// elsewhere.
  MarkPoint mark;
};

/// A distance of one set of holes, in the order of the sets.
struct BeltTapedDistance {
  std::size_t set = 0;
  std::string words;  ///< "A-B"
  double measured_mm = 0.0;
  double residual_mm = 0.0;  ///< taped less fitted
  double left_out_mm = 0.0;
  double left_out_sigma_mm = 0.0;
  bool rejected = false;
};

struct HolesWithBelts {
  /// The machine in force when the first set was cut; the origin of commands is where its frame's
  /// diagonals cross.
  BeltMachine machine;
  std::vector<BeltHole> holes;  ///< of the first set, which defines the frame
  std::vector<BeltTapedDistance> distances;
  double noise_factor = 1.0;  ///< relative to the stated noise of tape and holes
  std::optional<DisplacementParts> displacement;
  /// Covariance of x, and of the displacement at its places.
  MatrixXd covariance;
  /// The sheet's placement by its edges; absent if the holes determine it.
  std::optional<Vector3d> sheet;  ///< x_mm, y_mm, rotation_rad
  double left_out_rms_mm = 0.0;   ///< of distances that were not rejected
};

struct BeltsAndHolesFit {
  BeltsFit belts;  ///< without places where no belts were given
  HolesWithBelts holes;
};

/// The state known without the holes.
struct BeltsByThemselves {
  BeltsFit fit;
  AnchorFit frame;
  MatrixXd covariance;  ///< of five coordinates, mm^2; with a tape of the scale's logarithm too
};
/// Allows for errors of readings only; diagnosis/anchors_with_causes.hpp also allows for causes. Without points, the anchors of
/// the machine, each with kStatedAnchorMm.
[[nodiscard]] tl::expected<BeltsByThemselves, BeltsFitFailure> fit_by_themselves(
    const MeasuredBelts& belts);

/// `belts` are the readings as `alone` explains them, without the causes in it. \throws
/// std::invalid_argument without distances, or where the anchors in force when the holes were cut
/// are not known.
[[nodiscard]] tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_belts_and_holes(
    const MeasuredBelts& belts, const std::vector<BeltHoles>& sets, BeltsByThemselves alone);
/// With the result of fit_by_themselves() for them.
[[nodiscard]] tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_belts_and_holes(
    const MeasuredBelts& belts, const std::vector<BeltHoles>& sets);

}  // namespace chaintrue::grid

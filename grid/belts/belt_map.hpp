// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where the tool of a router on four belts stands on the sheet for lengths of its upper two belts,
/// and back: anchors, scale and displacement as fitted.
///
///   m      where the two level spans end about the fitted anchors, the frame's own millimetres
///   raw    exp(s) (m - c), c where commands count from
///   sheet  R (raw + d(raw)) + t                                                             (1)
///
/// R and t lay the sheet: as its edges say, otherwise so that the holes (without holes the places
/// that the belts measured), as a whole, lie where they were commanded. d is the displacement that
/// the holes show, or nothing. The inverse of (1) is a fixed point, for d changes by less than a
/// hundredth of a millimetre in a millimetre.
///
/// Lengths are those of the belts themselves at the bed's height, from the anchor slanting to the
/// end: what the motors pay out. `left` is the top left belt.
///
/// A scale that no tape has told is 1: then the sheet is measured in the belts' millimetres.
///
/// \code
///   const BeltMap map(fit.belts, &fit.holes);
///   const auto lengths = map.lengths({100.0, -200.0});
///   if (lengths) tool = map.tool(*lengths);   // (100, -200) again
/// \endcode
#pragma once

#include <memory>
#include <tl/expected.hpp>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/map/measured_area.hpp"
#include "model/belts/belt_kinematics.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid {

/// The machine as it was stated before the fit. \throws std::invalid_argument where it was not.
[[nodiscard]] model::BeltMachine machine_in_force(const BeltsFit& fit);

/// A machine whose upper lengths are the belts' own.
[[nodiscard]] model::BeltMachine paying_out(model::BeltMachine machine);

/// Immutable, thread safe.
class BeltMap {
 public:
  /// `holes` may be null. \throws std::invalid_argument without holes where the anchors in force are
  /// not known, or with fewer than three places.
  explicit BeltMap(const BeltsFit& fit, const HolesBesideBelts* holes = nullptr);

  [[nodiscard]] tl::expected<model::ChainLengths, model::BeltFailure> lengths(
      model::BedPoint sheet) const;
  [[nodiscard]] tl::expected<model::BedPoint, model::BeltFailure> tool(
      model::ChainLengths lengths) const;
  /// One sigma of each length, from what is uncertain of the fit; a point that lengths() answers.
  [[nodiscard]] model::ChainLengths sigma(model::BedPoint sheet) const;
  /// Of the tool for such lengths: the root of the summed variances of x and y.
  [[nodiscard]] double tool_sigma_mm(model::BedPoint sheet) const;
  [[nodiscard]] MapStatus status(model::BedPoint sheet) const {
    return area_->status(model::identity_placement(sheet));
  }
  [[nodiscard]] const interp::Rectangle& domain() const { return area_->domain(); }
  /// What the controller believed when the places, or the holes, were commanded.
  [[nodiscard]] const model::BeltMachine& in_force() const { return in_force_; }

 private:
  /// (1) of one set of unknowns.
  struct Placing {
    model::BeltMachine machine;
    double factor = 1.0;
    model::FramePoint centre;
    std::shared_ptr<const ToolDisplacement> displacement;  ///< may be null
    model::SheetPlacement sheet;

    [[nodiscard]] model::BedPoint on_sheet(model::FramePoint place) const;
    [[nodiscard]] model::FramePoint in_frame(model::BedPoint sheet) const;
  };
  /// Places that the sheet is laid by.
  struct Reference {
    model::BedPoint commanded;
    double left_mm = 0.0;   ///< level span of the top left belt
    double right_mm = 0.0;  ///< of the top right one
  };
  [[nodiscard]] Placing placing(const Eigen::VectorXd& unknowns) const;
  void lay(Placing& placing) const;

  model::BeltMachine in_force_;
  std::vector<Reference> references_;
  std::optional<DisplacementParts> displacement_;
  std::optional<Eigen::Vector3d> by_edges_;
  Placing best_;
  std::vector<Placing> others_;  ///< one sigma away, a column of the covariance's root each
  std::shared_ptr<const MeasuredArea> area_;
};

}  // namespace chaintrue::grid

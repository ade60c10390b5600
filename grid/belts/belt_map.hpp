// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map of a router on four belts (mechanism_map.hpp): anchors, scale and displacement as fitted.
///
///   m      where the two level spans end about the fitted anchors, the frame's own millimetres
///   raw    exp(s) (m - c), c where commands count from
///   sheet  R (raw + d(raw)) + t                                                             (1)
///
/// R and t lay the sheet: as its edges say, otherwise so that the holes (without holes the places
/// that the belts measured), as a whole, lie where they were commanded. d is the displacement that
/// the holes show, or nothing.
///
/// Lengths are those of the belts themselves at the bed's height, from the anchor slanting to the
/// end: what the motors pay out. `left` is the top left belt.
///
/// Without a tape the scale is 1 and the sheet is measured in the belts' millimetres.
///
/// \code
///   const BeltMap map(fit.belts, &fit.holes);
///   const auto lengths = map.lengths({100.0, -200.0});
///   if (lengths) tool = map.tool(*lengths);   // (100, -200) again
/// \endcode
#pragma once

#include "grid/belts/belts_and_holes.hpp"
#include "grid/map/mechanism_map.hpp"
#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid {

/// A machine whose upper lengths are the belts' own.
BeltMachine paying_out(BeltMachine machine);

/// Immutable, thread safe. Lengths are tl, tr, bl, br; the lower two follow the tool.
class BeltMap final : public MechanismMap {
 public:
  /// `holes` may be null. \throws std::invalid_argument without holes where the anchors in force are
  /// not known, or with fewer than three places.
  explicit BeltMap(const BeltsFit& fit, const HolesWithBelts* holes = nullptr);

  /// Without a scale from a tape, the tool's error in true millimetres is unknown.
  [[nodiscard]] tl::expected<LengthsAnswer, MapFailure> query(BedPoint point) const override;
  /// The controller's machine when the places or holes were commanded.
  const BeltMachine& in_force() const { return in_force_; }

 private:
  BeltMachine in_force_;
  bool knows_scale_;
};

}  // namespace chaintrue::grid

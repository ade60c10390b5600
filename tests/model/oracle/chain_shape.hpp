// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The shape of a hanging chain and the tension along it, from a pose of Model::inextensible,
/// elastic or elastic_3d.
///
/// \code
///   const ChainShape shape(equilibrium_parameters(machine), pose, Side::left);
///   for (double s = 0.0; s <= shape.length_mm(); s += 10.0) plot(shape.at(s));
/// \endcode
#pragma once

#include "model/catenary.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {

/// A point of the chain.
struct ShapePoint {
  BedPoint place;
  double off_sheet_mm = 0.0;  ///< towards the front; zero but for elastic_3d
  double tension_n = 0.0;
  double stretched_length_mm = 0.0;  ///< from the sled's end to here
};

/// Const, no allocation. Accuracy: that of the pose.
class ChainShape {
 public:
  /// `parameters` and `model` must be those of the kinematics that returned the pose. \throws
  /// std::invalid_argument for a closed formula, whose chains have no shape.
  ChainShape(const EquilibriumParameters& parameters,
             const Pose& pose,
             Side side,
             Model model = Model::elastic);
  /// Free unstretched length, from the sled's end to the sprocket's tangent.
  [[nodiscard]] double length_mm() const { return load_.length_mm; }
  /// The chain at unstretched length s from the sled's end. \throws std::invalid_argument outside
  /// [0, length_mm()].
  [[nodiscard]] ShapePoint at(double s_mm) const;

 private:
  ChainMaterial chain_;
  CatenaryLoad load_;  // in the vertical plane that the chain hangs in
  BedPoint end_;       // the chain's end at ring or bracket
  double end_off_sheet_mm_ = 0.0;
  double across_u_ = 1.0, across_y_ = 0.0, across_z_ = 0.0;  // that plane's horizontal, unit
  double up_y_ = 1.0, up_z_ = 0.0;
  double towards_ = 1.0;  // +1: u points to +x
};

}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The equilibrium with three-dimensional sag: on a frame that leans back, gravity's part off the
/// sheet deflects the chains too (up to 10 % of the sag at 15 degrees).
///
/// Notation in addition to equilibrium.hpp's, per chain in the frame (u, y, z), z off the sheet
///   t    the frame's tilt
///   n    straight up, (0, cos t, sin t)
///   w0   the chain's full weight per mm, w / cos t
///   T0   its pull on the sled, (H, V, N)
///   v    T0 . n
///   h    T0 - v n: the chain hangs in the plane of h and n as a catenary with (|h|, v) for (H, V)
///
/// The sled lies on the sheet and carries N; the sprocket's tangent lies in the sheet, at slope
/// atan2(V + w S, H). Per chain one more unknown, N, and one more equation: the chain leaves and
/// reaches the sheet's plane at the same height. Sled rotation about the sheet's normal as in the
/// plane; tilting off the sheet is not modelled.
#pragma once

#include "model/equilibrium.hpp"

namespace chaintrue::model {

/// \tparam kRotates brackets. Accuracy: 1e-10 mm over the default bed, against 40-digit tables.
template <bool kRotates>
class SpatialKinematics final : public Kinematics {
 public:
  explicit SpatialKinematics(const EquilibriumParameters& parameters);
  [[nodiscard]] PoseResult inverse(BedPoint point) const override;
  [[nodiscard]] PoseResult forward(ChainLengths lengths) const override;
  [[nodiscard]] Eigen::Matrix2d jacobian(const Pose& pose) const override;
  [[nodiscard]] Eigen::Vector2d sensitivity(const Pose& pose, Parameter parameter) const override;

 private:
  EquilibriumConstants m_;
  double cos_tilt_ = 1.0, sin_tilt_ = 0.0;
};

extern template class SpatialKinematics<false>;
extern template class SpatialKinematics<true>;

}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Settings and chain scales by least squares alone, for a surface that passes through every point.
///
/// The joint fit weighs a setting against the bend of the surface that would replace it: right for
/// naming settings, but what it leaves to the surface need not be small. A surface through all the
/// nodes errs between them in proportion to what it has to carry, so for it the settings are those
/// that leave least at the nodes. For machines whose lengths err by 0.8 mm more than any model says
/// that lowers the largest error between 4 x 7 to 7 x 13 nodes by a fifth to a half.
#pragma once

#include "grid/map/joint_fit.hpp"

namespace chaintrue::grid {

/// `fit` with the machine, sheet and scales that minimise
///
///   sum over good points |y - (1 + e) f(theta)|^2 / s^2 + |theta / sigma|^2 + |e / kScaleSigma|^2
///
/// with s, the size of what is left, by restricted maximum likelihood. Covariances of the settings
/// and scales grow by the square of what they moved: the joint fit's estimate remains the best one
/// of the settings themselves. Unchanged where the least squares fail.
[[nodiscard]] JointFit with_plain_calibration(const JointFitInput& input, JointFit fit);

}  // namespace chaintrue::grid

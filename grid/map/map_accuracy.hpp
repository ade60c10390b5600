// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A finished map's statements about its points: held-out errors, their noise and the mirror claim.
#pragma once

#include <vector>

#include "grid/map/compensation_map.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// One held-out residual in the chains, and the derivative that carries it to the tool.
struct HeldOutResidual {
  Vector2d chain_mm;
  Matrix2d mark_jacobian;
};

/// Zero everywhere for no residuals.
[[nodiscard]] HeldOutError summarise(const std::vector<HeldOutResidual>& residuals);

/// The accuracy of one reading: at the tool, both axes together, rms over the good points. Reported
/// on every page.
double noise_at_tool_mm(const CompensationMap& map);

/// R at (x, y) against L at (-x, y), over the good points whose mirror image lies on the measured
/// part.
MirrorTest test_mirror(const CompensationMap& map);

}  // namespace chaintrue::grid

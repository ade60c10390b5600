// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Kinematics from a closed formula for a ring sled: straight line, wrap, the firmware's chain of
/// formulas, the one-shot catenary. Derivatives are exact (dual.hpp). Tensions in the pose are
/// those of straight weightless chains along the formula's angles.
#pragma once

#include "model/kinematics.hpp"

namespace chaintrue::model {

enum class Formula { straight, wrap, firmware, one_shot };

/// Lengths do not depend on parameters that are not in the formula: the firmware's sag factor is a
/// separate number, not a weight.
/// \param tolerance_percent of the firmwares, which divide the straight part by 1 + tolerance / 100
/// \throws std::invalid_argument for brackets: the closed formulas have no rotating sled.
std::unique_ptr<const Kinematics> make_formula_kinematics(
    const EquilibriumParameters& parameters, Formula formula,
    const PerSide<double>& tolerance_percent = {});

}  // namespace chaintrue::model

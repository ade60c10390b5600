// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The effects of a router on four belts (effect.hpp), in the order in which they act:
///
///   machine   where an anchor really is                                `alter_anchor`
///   belt      what the encoder counts in addition to the belt's length  `add`
///
/// Then the count is printed in the controller's convention: belt_readings.hpp.
#pragma once

#include "model/effects/effect_table.hpp"

namespace chaintrue::model::belts {

extern const effects::Effect anchor_moved, anchor_height, belt_stretch, anchor_flex, belt_scale,
    belt_zero, tooth_skip, drift, zero_shift;

effects::EffectTable belt_effects();

}  // namespace chaintrue::model::belts

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The effects of a V-plotter (effect.hpp), in the order in which they act:
///
///   machine   geometry and forces of the equilibrium       `alter_cords`
///   cord      what is added to the cord's own length       `add`
///
/// What is a setting (the pins' spacing and rise, zeros and scales) is a parameter of the mechanism
/// and no effect.
#pragma once

#include "model/effects/effect_table.hpp"

namespace chaintrue::model::plotter {

effects::EffectTable plotter_effects();

}  // namespace chaintrue::model::plotter

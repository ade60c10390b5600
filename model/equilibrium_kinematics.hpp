// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Kinematics from the full equilibrium in the sheet's plane: ring or brackets, heavy elastic
/// chains, and as their limits inextensible and weightless ones. Equations and notation in
/// equilibrium.hpp.
#pragma once

#include "model/equilibrium.hpp"

namespace chaintrue::model {

/// For models that neglect a term: its parameter is zero and the lengths do not depend on it.
struct NotModelled {
  bool sprocket = false;
  bool chain_weight = false;
  bool compliance = false;
};

/// Accuracy (inverse and forward, against 40-digit tables): 1e-11 mm over the default bed, 1e-9 mm
/// down to 23 mm below the beam and 19 mm from a sprocket's vertical.
std::unique_ptr<const Kinematics> make_equilibrium_kinematics(EquilibriumParameters parameters,
                                                              const NotModelled& not_modelled = {});

}  // namespace chaintrue::model

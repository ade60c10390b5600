// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where or when an effect may set in, by the variable of its place at the places of the tool.
/// Private to grid/diagnosis.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/regressor_system.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::grid::diagnosis {

/// The parameter for where or when an effect sets in; null if it has none.
const EffectParameter* place_parameter(const Effect& effect);

/// The variable that this place is compared with.
model::effects::PlaceVariable variable_of_place(const Effect& effect, const EffectParameter& place);
/// Between the nearest places of the tool to either side of it, in that variable: a step at one place between them
/// is the same at all readings as one at another. Empty if a side has none, and for phases.
struct PlaceGap {
  double below = 0.0;
  double above = 0.0;
};
std::optional<PlaceGap> gap_about(const RegressorSystem& system, CauseId cause, double place);

/// The variable's value at every place of the tool, for the chain of this side or of either.
std::vector<double> compared_at_places(const RegressorSystem& system,
                                       model::effects::PlaceVariable variable, EffectSide side);

/// Places where an effect may set in: visits, phases of a turn, angles (or another variable of the
/// place) between those of the places of the tool.
std::vector<double> places_to_set_in(const RegressorSystem& system, CauseId cause);

/// Whether its formula has a step where it sets in, and so no derivative by its place.
bool has_step(const Effect& effect);

}  // namespace chaintrue::grid::diagnosis

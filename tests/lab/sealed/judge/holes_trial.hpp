// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Holes cut by the hidden machine, which shares no code with the product: its equilibrium with the
/// lengths that the controller paid out, measured with a tape, and diagnosed.
#pragma once

#include <cstdint>
#include <span>

#include "grid/observation/measured_holes.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// Where the hidden machine comes to rest when its controller has paid out these lengths, searched
/// from a place near by. \throws std::runtime_error where no place has them.
generator::Vec2 place_reached(const generator::HiddenMachine& machine,
                              const model::ChainLengths& paid_out, generator::Vec2 near);
/// fixtures/holes/nine_holes.json.
const grid::MeasuredHoles& nine_holes();

/// The measurements, and the machine that cut the holes.
struct CutHoles {
  grid::MeasuredHoles set;
  generator::HiddenMachine machine;
};

/// Nine holes and twenty distances (fixtures/holes/nine_holes.json, its lengths replaced); motors
/// off by 1.5 mm and zeros by 0.5 mm, one sigma; stated 3 and 1. \throws std::runtime_error if the
/// machine cannot cut one of the holes.
CutHoles cut_holes(const std::vector<generator::Hidden>& effects, std::uint64_t seed);

/// No cause, or a chain that is 0.15 % long, left for even seeds and right for odd ones: a strength
/// of some eight. `points` is the number of distances.
[[nodiscard]] Outcome run_holes_trial(const std::string& kind, bool long_chain, std::uint64_t seed);

}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The input of a fit: a grid's points as chain lengths, and a machine corrected by its extra
/// readings.
#pragma once

#include <cstddef>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid {

/// A point with its lengths, however they were given.
using LengthPoint = observation::Place;

/// Every point's lengths. A point that gives a command has the lengths that the machine's
/// controller pays out for it. Fails with a sentence where that cannot be reached, or no controller
/// is stated.
[[nodiscard]] tl::expected<std::vector<LengthPoint>, std::string> length_points(
    const MeasuredGrid& grid);

/// Points as an observation, in their order.
observation::ChainLengthReadings chain_length_readings(
    const std::vector<LengthPoint>& points, observation::PointNoise noise, double noise_dof,
    const std::optional<SheetUncertainty>& sheet);

/// Points within this distance of each other are repeats of one place.
inline constexpr double kRepeatDistanceMm = 25.0;

/// Groups of two or more points at one place, as positions in `points`.
std::vector<Indices> repeat_groups(const std::vector<LengthPoint>& points);

/// Readings that replace a part of the stated machine: sled_mass_kg and chain_mass_kg_per_m replace
/// it, ring_radius_mm is combined with the stated one by their sigmas, link_pitch_mm becomes a
/// chain_pitch_error.
[[nodiscard]] Machine with_readings(Machine machine, const std::vector<ExtraReading>& readings);

/// The readings that the settings predict: motor_spacing_mm and beam_rise_mm.
std::vector<ExtraReading> setting_readings(const std::vector<ExtraReading>& readings);

}  // namespace chaintrue::grid

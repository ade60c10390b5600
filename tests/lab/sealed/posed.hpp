// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Shared by the tests of the diagnosis: sets with given effects.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnosis.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// A set with exactly these effects; regular grid, six repeats, usual noise.
[[nodiscard]] generator::SealedSet posed(std::vector<generator::Hidden> effects,
                                         generator::Order order,
                                         std::uint64_t seed,
                                         int points = 28);
[[nodiscard]] grid::MeasuredGrid read(const generator::SealedSet& set);
/// Without gain and next measurements. Fails the test if the diagnosis fails.
[[nodiscard]] grid::diagnosis::Diagnosis diagnosed(const grid::MeasuredGrid& grid);

/// The ids (effect:side) of the causes, the first one first, without their classes.
[[nodiscard]] std::vector<std::string> ids(const grid::diagnosis::Diagnosis& found);
/// The first cause is the given one or a member of its class.
[[nodiscard]] bool led_by(const grid::diagnosis::Diagnosis& found, const std::string& id);
[[nodiscard]] bool names_any(const grid::diagnosis::Diagnosis& found);

/// Trials of seeds first .. first + count - 1.
[[nodiscard]] std::vector<Trial> trials(TrialOptions options, std::uint64_t first, int count);

}  // namespace chaintrue::sealed

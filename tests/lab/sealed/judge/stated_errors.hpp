// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Stated errors of maps against the true ones: hidden machines, each with one effect of the
/// catalogue at its usual size or with none, measured in the ways and layouts of docs. Chain
/// lengths are read at 28, 60 or 117 marks with six second visits; distances are taped between nine
/// holes, where the effect is one that holes can have.
///
/// Of each machine two maps are made: `plain`, and `own` on the causes that are found. Numbers of an outcome:
///   plain_true_mm, plain_stated_mm, own_true_mm, own_stated_mm   errors of the tool
///   plain_held, own_held                                         shares of 95 % intervals that hold the truth
///   built                                                        1 if the own map is built on causes
/// There are none where one of the fits failed.
#include <string>
#include <vector>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// Effects of the catalogue, "nothing", and holes alone with a tape whose zero is off by so much
/// ("tape_zero_5") or stated to be known exactly.
std::vector<std::string> stated_kinds();
/// Its way, 28, 60, 117 or holes, follows the kind after a colon, except for tapes. \throws std::runtime_error if the
/// hidden machine cannot be measured.
[[nodiscard]] Outcome stated_outcome(const std::string& kind, std::uint64_t seed);

/// Readings of the list of start: zeros that move by so much, left or right, from a visit on ("moved_left_6_15"); and a
/// first session (plain), and it with a second whose left zero is another (own): "second_20".
std::vector<std::string> zero_kinds();
[[nodiscard]] Outcome zero_outcome(const std::string& kind, std::uint64_t seed);

}  // namespace chaintrue::sealed

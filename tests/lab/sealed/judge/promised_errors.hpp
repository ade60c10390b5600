// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What an owner is promised of the tool's error, rms and at worst, against what it is: today, with the
/// map, with numbers typed in, with the map that belongs to these, and along the cuts of a program that
/// the map compensates. Hidden machines, whose controller is GroundControl's, by its formulas written
/// here a second time; plotters by theirs.
///
/// Numbers of an outcome, for each of today, map, typed, map_after and cuts:
///   map_stated_mm, map_true_mm               rms of what is promised, and of what is true
///   map_worst_stated_mm, map_worst_true_mm   the same at worst
///   map_exceeded                             1 if the largest error exceeds its stated bound
/// Belts have no map apart from their anchors; of plotters there is a promise along cuts alone.
#include <string>
#include <vector>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// A machine, and how it is measured, after a colon: chains that are worn, on a beam that bends, with settings three
/// times as far off as usual: 28, 60 or 117 marks with lengths read, or the list of start; four belts; and plotters with
/// nothing hidden.
std::vector<std::string> promised_kinds();

/// Failed where there is no map. \throws std::runtime_error where the hidden machine cannot be measured.
[[nodiscard]] Outcome promised_outcome(const std::string& kind, std::uint64_t seed);

}  // namespace chaintrue::sealed

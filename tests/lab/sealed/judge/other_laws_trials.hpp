// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws hidden in sessions of four belts, and in holes that were cut and measured with a tape.
/// Private to the judge: laws_trial.hpp runs them.
#pragma once

#include <cstdint>
#include <string_view>

#include "sealed/judge/laws_trial.hpp"

namespace chaintrue::sealed {

/// "laws", "two", "gaussian", "causes" or "nothing" in 30, 56 or 90 places.
[[nodiscard]] LawsTrial run_belts_laws_trial(std::string_view kind, std::uint64_t seed);

/// The same in 30 holes with 93 distances.
[[nodiscard]] LawsTrial run_holes_laws_trial(std::string_view kind, std::uint64_t seed);

}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map as one uniform table of both chain lengths, which asks no machine for its equilibrium any
/// more, with the measured bound of what that costs (CompiledPair::error). Apart from the map
/// itself, so that only those who need the table know it.
///
/// \code
///   const auto table = compile(map);
///   if (table && table->error().bound <= 0.005) {
///     const auto here = table->at(100.0, -200.0);   // lengths of the left and the right chain, mm
///   }
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/map/compensation_map.hpp"
#include "interp/compiled_pair.hpp"

namespace chaintrue::grid {

/// Over the map's whole domain, in the frame of its marks; left chain first. The lengths of
/// `columns` x `rows` cells at 256 bytes each; the error is that of lengths in mm. Fails with
/// MapFailure::unreachable where the chains cannot hold the sled somewhere on the domain, and with
/// wave_along_chain where a sprocket of the map's machine is eccentric: that wave repeats with every
/// turn, faster than a table follows, and the map itself answers with it.
/// \throws std::invalid_argument unless both counts are positive.
[[nodiscard]] tl::expected<interp::CompiledPair, MapFailure> compile(const CompensationMap& map,
                                                                     int columns = 100,
                                                                     int rows = 50);

}  // namespace chaintrue::grid

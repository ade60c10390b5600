// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Several sets of holes that one machine cut, with other controller settings in force, as one set:
/// what they share is learnt from all of them, a bend of the bed that no setting has included.
///
/// Another road than fit_together's, which keeps each set its own sheet and controller. A hole is
/// where its chain lengths put it. So each later set's holes get the commands by which
/// the first one's controller would have paid out the same lengths; distances stay what they are.
///
/// \code
///   const auto all = sets_together({august, september});
///   if (all) use(fit_holes(*all));
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid {

/// The first set's holes keep their names, those of the k-th are called "A (k)". Hooks are
/// subtracted, sigmas written to the distances. Every set was cut on a sheet of its own: distances
/// to edges are the first sheet's alone, those of the others are left out.
///
/// Fails in words where a set has no machine, another machine's settings or another sigma of its
/// holes, or where a command is out of the controller's reach. \throws std::invalid_argument
/// without a set.
[[nodiscard]] tl::expected<MeasuredHoles, std::string> sets_together(
    const std::vector<MeasuredHoles>& sets);

}  // namespace chaintrue::grid

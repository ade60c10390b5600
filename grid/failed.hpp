// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The return value of a failed function: a reason and a sentence.
///
/// \code
///   if (!grid.machine) return failed(FitReason::no_machine, "the grid names no machine: give --machine");
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "model/failure.hpp"

namespace chaintrue::grid {

template <typename Reason>
[[nodiscard]] tl::unexpected<Failure<Reason>> failed(Reason why, std::string sentence) {
  return tl::unexpected(Failure<Reason>(why, std::move(sentence)));
}

}  // namespace chaintrue::grid

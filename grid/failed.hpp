// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a function returns whose task has failed, by the reason and in a sentence.
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

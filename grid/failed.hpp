// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The return value of a failed function: a reason and a sentence, or the failure of what it called.
///
/// \code
///   if (!grid.machine) return failed(FitReason::no_machine, "the grid names no machine: give --machine");
///   if (!map) return failed(map);
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
template <typename Value, typename Error>
[[nodiscard]] tl::unexpected<Error> failed(const tl::expected<Value, Error>& of) {
  return tl::unexpected(of.error());
}

}  // namespace chaintrue::grid

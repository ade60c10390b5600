// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Preconditions. Internal to interp.
///
///     require(count >= 2, "{} nodes from {} to {}", count, low, high);

#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue {

/// \throws std::invalid_argument with this text where the precondition does not hold.
template <class... Values>
void require(bool holds, fmt::format_string<const Values&...> text, const Values&... values) {
  if (!holds) throw std::invalid_argument(fmt::format(text, values...));
}

}  // namespace chaintrue

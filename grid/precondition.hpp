// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A broken precondition is told with its values, whatever they are. The gate of grid/printing.hpp
/// lets no NaN into anything that is printed for a person; here it is what must be told.
///
/// \code
///   if (!(sigma_mm > 0.0)) throw precondition("a tape of {} mm", sigma_mm);
/// \endcode
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace chaintrue::grid {

/// To be thrown: the sentence with its values, NaN and infinity as "nan" and "inf".
template <class... Args>
[[nodiscard]] std::invalid_argument precondition(::fmt::format_string<Args...> sentence,
                                                 Args&&... args) {
  return std::invalid_argument(::fmt::format(sentence, std::forward<Args>(args)...));
}

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reports a broken precondition with its values. NaN and infinity are allowed here, unlike in
/// grid/printing.hpp: they are what must be reported.
///
/// \code
///   if (!(sigma_mm > 0.0)) throw precondition("a tape of {} mm", sigma_mm);
/// \endcode
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace chaintrue::grid {

/// The exception to throw: the sentence with its values, NaN and infinity as "nan" and "inf".
template <class... Args>
std::invalid_argument precondition(::fmt::format_string<Args...> sentence, Args&&... args) {
  return std::invalid_argument(::fmt::format(sentence, std::forward<Args>(args)...));
}

}  // namespace chaintrue::grid

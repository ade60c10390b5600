// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Independent work on several cores. The library itself starts no thread: it does one index after another until a
/// program states otherwise, as the command does with oneTBB (grid/threads/).
///
/// \code
///   std::vector<double> squares(n);
///   for_each_index(n, [&](std::size_t k) { squares[k] = k * k; });   // each index writes to its own place
/// \endcode
#pragma once

#include <cstddef>
#include <functional>

namespace chaintrue::grid {

using IndexWork = std::function<void(std::size_t)>;
/// Calls work(0) ... work(count - 1), in any order, and returns when all are done.
using IndexLoop = void (*)(std::size_t count, const IndexWork& work);

/// Calls `work` for each index below `count`. The work of one index must not depend on that of another, so that the
/// result is the same for any number of threads. Throws what `work` throws.
void for_each_index(std::size_t count, const IndexWork& work);

/// Sets how `for_each_index` runs; null for one index after another. Do not call it during such a
/// loop.
void set_index_loop(IndexLoop loop);

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Several cores for what is independent (grid/parallel.hpp), by oneTBB. A library of its own, so that the installed
/// ones do not depend on oneTBB.
#pragma once

namespace chaintrue::grid {

/// `count` threads from now on, 0 for one a core. Answers are the same for any number. Built without oneTBB, the work
/// stays on one.
void use_threads(int count);

}  // namespace chaintrue::grid

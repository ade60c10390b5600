// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a program gives the library: several cores for what is independent (grid/parallel.hpp), by oneTBB, and memory
/// that it keeps. A library of its own, so that the installed ones do not depend on oneTBB.
#pragma once

namespace chaintrue::grid {

/// `count` threads from now on, 0 for one a core. Answers are the same for any number. Built without oneTBB, the work
/// stays on one.
void use_threads(int count);

/// The process keeps freed memory from now on, except blocks of 32 MB and more. A diagnosis allocates and
/// frees matrices of megabytes; mapping pages anew for each takes up to half of its time. Does nothing
/// without glibc.
void keep_freed_memory();

}  // namespace chaintrue::grid

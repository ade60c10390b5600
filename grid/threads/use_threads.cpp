// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/threads/use_threads.hpp"

#include <cstdlib>  // says whether this is glibc
#ifdef __GLIBC__
#include <malloc.h>
#endif

#ifdef CHAINTRUE_HAS_TBB
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <optional>

#include "grid/parallel.hpp"
#endif

namespace chaintrue::grid {

#ifdef CHAINTRUE_HAS_TBB

void use_threads(int count) {
  static std::optional<tbb::global_control> limit;
  limit.reset();
  if (count > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  set_index_loop([](std::size_t indices, const IndexWork& work) {
    tbb::parallel_for(std::size_t{0}, indices, work);
  });
}

#else

void use_threads(int /*count*/) {}

#endif

void keep_freed_memory() {
#ifdef __GLIBC__
  // Blocks of kLargeBytes are few, and are given back. What one thread frees serves the others.
  constexpr int kNeverTrim = -1, kGrowByBytes = 1 << 24, kLargeBytes = 1 << 25, kHeaps = 1;
  mallopt(M_ARENA_MAX, kHeaps);
  mallopt(M_MMAP_THRESHOLD, kLargeBytes);
  mallopt(M_TRIM_THRESHOLD, kNeverTrim);
  mallopt(M_TOP_PAD, kGrowByBytes);
#endif
}

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/sweep/run_sweep.hpp"

#ifdef CHAINTRUE_HAS_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#endif

#include <functional>
#include <mutex>
#include <optional>

namespace chaintrue::grid::sweep {
namespace {

// The k-th cell of a share.
std::uint64_t cell_of(const Share& share, std::uint64_t k) {
  return share.index + share.count * (share.rank + share.ranks * k);
}

std::uint64_t cells_of(const Share& share, std::uint64_t cells) {
  const std::uint64_t first = cell_of(share, 0);
  return first < cells ? (cells - first - 1) / (share.count * share.ranks) + 1 : 0;
}

#ifdef CHAINTRUE_HAS_TBB

void for_all(std::uint64_t count, int threads, const std::function<void(std::uint64_t)>& work) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  tbb::parallel_for(tbb::blocked_range<std::uint64_t>(0, count, 1), [&](const auto& range) {
    for (std::uint64_t k = range.begin(); k != range.end(); ++k) work(k);
  });
}

#else

void for_all(std::uint64_t count, int /*threads*/, const std::function<void(std::uint64_t)>& work) {
  for (std::uint64_t k = 0; k < count; ++k) work(k);
}

#endif

}  // namespace

std::uint64_t run_sweep(const SweepSpec& spec, const CellStore& store, const SweepRun& run) {
  const std::uint64_t total = cells_of(run.share, cells(spec));
  std::uint64_t pending = 0;
  for (std::uint64_t k = 0; k < total; ++k) pending += store.has(cell_of(run.share, k)) ? 0 : 1;
  if (pending == 0) return 0;
  const KeepCell keep = store.open();
  std::mutex writing;
  std::uint64_t finished = 0;
  for_all(total, run.threads, [&](std::uint64_t k) {
    const std::uint64_t cell = cell_of(run.share, k);
    if (store.has(cell)) return;
    const CellResult result = run_cell(spec, cell);
    const std::scoped_lock lock(writing);
    keep(cell, result);
    ++finished;
    if (run.progress) run.progress(finished, pending);
  });
  return finished;
}

}  // namespace chaintrue::grid::sweep

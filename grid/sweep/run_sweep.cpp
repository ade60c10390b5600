// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/sweep/run_sweep.hpp"

#include <mutex>

#include "grid/parallel.hpp"

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

}  // namespace

std::uint64_t run_sweep(const SweepSpec& spec, const CellStore& store, const SweepRun& run) {
  const std::uint64_t total = cells_of(run.share, cells(spec));
  std::uint64_t pending = 0;
  for (std::uint64_t k = 0; k < total; ++k) pending += store.has(cell_of(run.share, k)) ? 0 : 1;
  if (pending == 0) return 0;
  const KeepCell keep = store.open();
  std::mutex writing;
  std::uint64_t finished = 0;
  for_each_index(static_cast<std::size_t>(total), [&](std::uint64_t k) {
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

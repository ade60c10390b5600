// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the cells of a sweep on all cores (oneTBB), handing each over as soon as it is finished.
#pragma once

#include <cstdint>
#include <functional>

#include "grid/sweep/sweep_spec.hpp"

namespace chaintrue::grid::sweep {

/// Which share of the cells: those whose number leaves `index` when divided by `count`; of these,
/// among the processes that run together, every `ranks`-th.
struct Share {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
  std::uint64_t rank = 0;
  std::uint64_t ranks = 1;
};

using KeepCell = std::function<void(std::uint64_t, const CellResult&)>;

/// Where finished cells are kept (grid/files/sweep_store.hpp).
struct CellStore {
  std::function<bool(std::uint64_t)> has;
  /// Called once, where a cell is to be computed; what it returns is called one cell at a time.
  std::function<KeepCell()> open;
};

struct SweepRun {
  Share share;
  int threads = 0;  ///< 0: all cores
  /// Called after each cell with how many of this run's cells are finished and how many there are;
  /// one call at a time.
  std::function<void(std::uint64_t, std::uint64_t)> progress;
};

/// Runs what the share still lacks. \returns how many cells were computed.
/// \throws whatever the store throws.
std::uint64_t run_sweep(const SweepSpec& spec, const CellStore& store, const SweepRun& run);

}  // namespace chaintrue::grid::sweep

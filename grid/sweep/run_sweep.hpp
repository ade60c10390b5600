// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the cells of a sweep on all cores (oneTBB); each is stored as soon as it is finished.
#pragma once

#include <cstdint>
#include <functional>

#include "grid/sweep/sweep_spec.hpp"

namespace chaintrue::grid::sweep {

/// A share of the cells: those whose number modulo `count` is `index`; of these every `ranks`-th,
/// among the processes that run together.
struct Share {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
  std::uint64_t rank = 0;
  std::uint64_t ranks = 1;
};

using KeepCell = std::function<void(std::uint64_t, const CellResult&)>;

/// The store of finished cells (grid/files/sweep_store.hpp).
struct CellStore {
  std::function<bool(std::uint64_t)> has;
  /// Called once, before the first cell is computed; the function it returns is called by one
  /// thread at a time.
  std::function<KeepCell()> open;
};

struct SweepRun {
  Share share;
  /// Called after each cell with the number of finished cells and of all cells of this run; one
  /// call at a time.
  std::function<void(std::uint64_t, std::uint64_t)> progress;
};

/// Runs the unfinished cells of the share. \returns how many cells were computed. \throws whatever
/// the store throws.
std::uint64_t run_sweep(const SweepSpec& spec, const CellStore& store, const SweepRun& run);

}  // namespace chaintrue::grid::sweep

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the cells of a sweep on all cores (oneTBB), keeping each as soon as it is finished.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "grid/sweep/result_store.hpp"

namespace chaintrue::grid::sweep {

/// Which share of the cells: those whose number leaves `index` when divided by `count`; of these,
/// among the processes that run together, every `ranks`-th.
struct Share {
  std::uint64_t index = 0;
  std::uint64_t count = 1;
  std::uint64_t rank = 0;
  std::uint64_t ranks = 1;
};

struct SweepRun {
  std::filesystem::path directory;
  Share share;
  int threads = 0;  ///< 0: all cores
  /// Called after each cell with how many of this run's cells are finished and how many there are;
  /// one call at a time.
  std::function<void(std::uint64_t, std::uint64_t)> progress;
};

/// Runs what the share still lacks. \returns how many cells were computed.
/// \throws files::InputError where the folder cannot be written or holds cells of another
/// specification.
std::uint64_t run_sweep(const SweepSpec& spec, std::uint64_t spec_hash, const SweepRun& run);

}  // namespace chaintrue::grid::sweep

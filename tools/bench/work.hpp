// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A benchmark of one piece of work.
///
/// \code
///   add("map/fit", [](const benchmark::State&) {
///     return [grid = grid_of(7, 4)] { return grid::fit(grid); };
///   });
/// \endcode
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>

namespace chaintrue::bench {

/// `prepare(state)` returns what is measured.
/// \param items that one run of the work handles; 0: not counted
template <class Prepare>
benchmark::internal::Benchmark* add(const std::string& name, Prepare prepare,
                                    benchmark::TimeUnit unit = benchmark::kMillisecond,
                                    std::int64_t items = 0) {
  return benchmark::RegisterBenchmark(name.c_str(),
                                      [prepare, items](benchmark::State& state) {
                                        auto work = prepare(state);
                                        for (auto _ : state) benchmark::DoNotOptimize(work());
                                        if (items > 0)
                                          state.SetItemsProcessed(state.iterations() * items);
                                      })
      ->Unit(unit);
}

}  // namespace chaintrue::bench

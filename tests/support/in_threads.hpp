// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs functions concurrently, one thread each; sequentially where there are no threads (WebAssembly).
#pragma once

#include <functional>
#include <vector>

#ifndef __EMSCRIPTEN__
#include <thread>
#endif

namespace chaintrue::testing_support {

inline void run_in_threads(const std::vector<std::function<void()>>& works) {
#ifdef __EMSCRIPTEN__
  for (const auto& work : works) work();
#else
  std::vector<std::thread> threads;
  for (const auto& work : works) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
#endif
}

}  // namespace chaintrue::testing_support

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers that are the same on every platform, unlike the distributions of <random>.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace chaintrue::testing_support {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }
  /// Box and Muller 1958.
  double normal() {
    const double u = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace chaintrue::testing_support

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Normal random numbers that are identical on every platform (Box and Muller 1958), unlike
/// std::normal_distribution.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace chaintrue::testing_support {

class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : engine_(seed) {}
  double operator()() {
    const double u = (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53;
    const double v = static_cast<double>(engine_() >> 11) * 0x1p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace chaintrue::testing_support

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers that are identical on every machine, unlike the standard's distributions.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>

namespace chaintrue::witness {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  /// In [0, 1).
  double unit() { return static_cast<double>(bits_() >> 11U) * 0x1p-53; }
  double between(double least, double most) { return least + (most - least) * unit(); }
  /// From least to most, inclusive.
  int whole(int least, int most) {
    return least + static_cast<int>(bits_() % static_cast<std::uint64_t>(most - least + 1));
  }
  bool one_in(int count) { return bits_() % static_cast<std::uint64_t>(count) == 0; }
  /// A decimal number with this many places.
  double decimal(double least, double most, int places) {
    const double scale = std::pow(10.0, places);
    return std::round(between(least, most) * scale) / scale;
  }
  std::string any(std::initializer_list<const char*> choices) {
    return *(choices.begin() + whole(0, static_cast<int>(choices.size()) - 1));
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace chaintrue::witness

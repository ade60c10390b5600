// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers of the hidden draws: counters scrambled by a mixing function (the finaliser of
/// MurmurHash3, variant 13 of D. Stafford), one stream for each purpose, so that an additional draw
/// in one place changes no number in another. Normals by the Box-Muller transform.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

namespace chaintrue::generator {

class Dice {
 public:
  Dice(std::uint64_t seed, std::string_view purpose) : key_(mix(seed + kStep)) {
    for (const char c : purpose) key_ = mix(key_ ^ (static_cast<unsigned char>(c) + kStep));
  }
  std::uint64_t bits() { return mix(key_ + kStep * ++count_); }
  /// Inside (0, 1).
  double uniform() { return (static_cast<double>(bits() >> 11) + 0.5) * 0x1p-53; }
  double uniform(double from, double to) { return from + (to - from) * uniform(); }
  double log_uniform(double from, double to) {
    return from * std::exp(uniform() * std::log(to / from));
  }
  /// 0 .. count-1.
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }
  double sign() { return (bits() >> 63) != 0 ? 1.0 : -1.0; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }
  /// Student's t with 4 degrees of freedom, of standard deviation 1.
  double heavy_tailed() {
    const double z = normal();
    // A chi-square of 4 degrees of freedom is twice the sum of two exponentials.
    const double chi2 = -2.0 * (std::log(uniform()) + std::log(uniform()));
    return z / std::sqrt(chi2 / 4.0) / std::numbers::sqrt2;
  }
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

}  // namespace chaintrue::generator

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random numbers that are identical on every machine and with every compiler.
///
/// xoshiro256++ (Blackman and Vigna, ACM Trans. Math. Softw. 47 (2021) 36), seeded by SplitMix64
/// from a seed and a stream; normals by Wichura's inverse of the normal distribution (AS 241,
/// PPND16, Appl. Statist. 37 (1988) 477, about 1e-16 relative). Only + - * / and square roots,
/// which IEEE 754 rounds identically everywhere; the logarithm of the tails is computed from those.
///
/// \code
///   Random random(seed, 3);  // stream 3: independent of the other streams
///   const double error_mm = 0.2 * random.normal();
/// \endcode
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace chaintrue::grid {

/// Cheap to make and to copy; not shared between threads.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);
  std::uint64_t bits();
  /// In (0, 1), a multiple of 2^-53 plus 2^-54: never 0, never 1.
  double uniform();
  double uniform(double from, double to);
  /// 0 .. count-1, equally likely. \throws std::invalid_argument for count 0.
  std::size_t below(std::size_t count);
  double normal();
  /// Student's t with 4 degrees of freedom, scaled to a standard deviation of 1: heavy tails.
  double heavy_tailed();
  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::array<std::uint64_t, 4> state_{};
};

/// The inverse of the normal distribution. \throws std::invalid_argument outside (0, 1).
double normal_quantile(double probability);
/// Natural logarithm of a positive normal number, within 2 ulp, from exactly rounded operations
/// alone.
double portable_log(double x);

}  // namespace chaintrue::grid

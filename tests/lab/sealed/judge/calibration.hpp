// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Stated probabilities against the frequency of true claims.
///
///   error = sum_b |sum_(i in b) p_i - right_b| / n        b: ten bins of p, each a tenth wide
///
/// Of n honest claims spread evenly over the bins chance alone makes about 0.8 sqrt(10 p (1 - p) / n).
///
/// Source: M. Naeini, G. Cooper and M. Hauskrecht, Proc. AAAI 29 (2015), 2901 (expected calibration error).
///
/// \code
///   Calibration calibration;
///   calibration.add(0.97, true);
///   print(calibration.error(), calibration.claims());
/// \endcode
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace chaintrue::sealed {

class Calibration {
 public:
  void add(double probability, bool right) {
    Bin& bin = bins_[std::min<std::size_t>(bins_.size() - 1,
                                           static_cast<std::size_t>(10.0 * probability))];
    bin.claimed += probability;
    bin.right += right ? 1 : 0;
    ++claims_;
  }
  int claims() const { return claims_; }
  /// 0 of none.
  double error() const {
    double sum = 0.0;
    for (const Bin& bin : bins_) sum += std::abs(bin.claimed - bin.right);
    return claims_ > 0 ? sum / claims_ : 0.0;
  }

 private:
  struct Bin {
    double claimed = 0.0;
    int right = 0;
  };
  std::array<Bin, 10> bins_{};
  int claims_ = 0;
};

}  // namespace chaintrue::sealed

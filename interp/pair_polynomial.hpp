// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two bicubic polynomials in one cell, evaluated together. Internal to interp.

#include <array>
#include <cstddef>

#include "interp/eigen.hpp"

namespace chaintrue::interp {

/// Values and gradients of two surfaces at one point.
struct PairGradient {
  std::array<double, 2> value, dx, dy;
};

/// The matrix that takes values at four places to the powers of the cubic through them.
Matrix4d powers_through(const Vector4d& places);

/// Immutable once both are set. The coefficients are interleaved: 256 bytes, of u^i v^j in surface k
/// at 8 i + 2 j + k.
class alignas(64) PairPolynomial {
 public:
  /// powers(i, j) is the coefficient of u^i v^j.
  void set(std::size_t surface, const Matrix4d& powers) {
    double* const c = c_.data() + surface;
    for (Index i = 0; i < 4; ++i) {
      for (Index j = 0; j < 4; ++j) c[8 * i + 2 * j] = powers(i, j);
    }
  }

  /// At u and v, which rise by `per_x` and `per_y` with each unit of x and y.
  [[nodiscard, gnu::always_inline]] PairGradient at(double u, double v, double per_x,
                                                    double per_y) const {
    // Horner's rule in u, for each power of v of both surfaces. The compiler vectorises these eight
    // identical computations.
    std::array<double, 8> p, slope;
#pragma GCC unroll 8
    for (std::size_t l = 0; l < 8; ++l) {
      const double a = c_[24 + l] * u + c_[16 + l];
      const double b = a * u + c_[8 + l];
      slope[l] = (c_[24 + l] * u + a) * u + b;
      p[l] = b * u + c_[l];
    }
    const double v2 = v * v;
    // Even powers of v in the first two numbers, odd powers in the last two.
    std::array<double, 4> f, f_slope;
    for (std::size_t l = 0; l < 4; ++l) {
      f[l] = p[l] + v2 * p[4 + l];
      f_slope[l] = slope[l] + v2 * slope[4 + l];
    }
    PairGradient out;
    for (std::size_t k = 0; k < 2; ++k) {
      out.value[k] = f[k] + v * f[2 + k];
      out.dx[k] = (f_slope[k] + v * f_slope[2 + k]) * per_x;
      out.dy[k] = ((2.0 * v * p[4 + k] + 3.0 * v2 * p[6 + k]) + p[2 + k]) * per_y;
    }
    return out;
  }

 private:
  std::array<double, 32> c_{};
};

}  // namespace chaintrue::interp

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A number with its exact derivatives: forward-mode differentiation for the closed formulas.
///
/// Dual<N> holds a value and its derivatives by N inputs; the functions here obey the chain rule
/// exactly, so that one template of a formula gives its value and its derivatives. Stateless,
/// thread safe.
///
/// \code
///   const auto x = Dual<2>::variable(3.0, 0), y = Dual<2>::variable(4.0, 1);
///   sqrt(x * x + y * y);   // value 5, derivatives {0.6, 0.8}
/// \endcode
#pragma once

#include <array>
#include <cmath>

namespace chaintrue::model {

template <int N>
struct Dual {
  double value = 0.0;
  std::array<double, N> d{};

  constexpr Dual() = default;
  // A plain number is a Dual without derivatives; formulas mix both.
  constexpr Dual(double plain) : value(plain) {}  // NOLINT(google-explicit-constructor)
  static constexpr Dual variable(double value, int index) {
    Dual result(value);
    result.d[static_cast<std::size_t>(index)] = 1.0;
    return result;
  }
  /// f(this), given f and f' at the value.
  [[nodiscard]] constexpr Dual chained(double f, double slope) const {
    Dual result(f);
    for (std::size_t i = 0; i < N; ++i) result.d[i] = slope * d[i];
    return result;
  }

  friend constexpr Dual operator+(const Dual& a, const Dual& b) {
    Dual result(a.value + b.value);
    for (std::size_t i = 0; i < N; ++i) result.d[i] = a.d[i] + b.d[i];
    return result;
  }
  friend constexpr Dual operator-(const Dual& a) { return a.chained(-a.value, -1.0); }
  friend constexpr Dual operator-(const Dual& a, const Dual& b) { return a + (-b); }
  friend constexpr Dual operator*(const Dual& a, const Dual& b) {
    Dual result(a.value * b.value);
    for (std::size_t i = 0; i < N; ++i) result.d[i] = a.d[i] * b.value + a.value * b.d[i];
    return result;
  }
  friend constexpr Dual operator/(const Dual& a, const Dual& b) {
    Dual result(a.value / b.value);
    for (std::size_t i = 0; i < N; ++i) result.d[i] = (a.d[i] - result.value * b.d[i]) / b.value;
    return result;
  }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return a.chained(root, 0.5 / root);
  }
  friend Dual sin(const Dual& a) { return a.chained(std::sin(a.value), std::cos(a.value)); }
  friend Dual cos(const Dual& a) { return a.chained(std::cos(a.value), -std::sin(a.value)); }
  friend Dual asin(const Dual& a) {
    return a.chained(std::asin(a.value), 1.0 / std::sqrt((1.0 - a.value) * (1.0 + a.value)));
  }
  friend Dual atan2(const Dual& y, const Dual& x) {
    const double square = x.value * x.value + y.value * y.value;
    Dual result(std::atan2(y.value, x.value));
    for (std::size_t i = 0; i < N; ++i) {
      result.d[i] = (x.value * y.d[i] - y.value * x.d[i]) / square;
    }
    return result;
  }
};

/// The value alone, for decisions inside a formula.
constexpr double plain(double value) { return value; }
template <int N>
constexpr double plain(const Dual<N>& dual) {
  return dual.value;
}

}  // namespace chaintrue::model

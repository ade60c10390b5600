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
  constexpr Dual chained(double f, double slope) const {
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
  friend Dual exp(const Dual& a) {
    const double power = std::exp(a.value);
    return a.chained(power, power);
  }
  friend Dual log(const Dual& a) { return a.chained(std::log(a.value), 1.0 / a.value); }
  /// The derivative at 0 is 0.
  friend Dual abs(const Dual& a) {
    const double sign = a.value > 0.0 ? 1.0 : a.value < 0.0 ? -1.0 : 0.0;
    return a.chained(std::abs(a.value), sign);
  }
  /// Returns a, with its derivatives, where the two are equal.
  friend constexpr Dual min(const Dual& a, const Dual& b) { return b.value < a.value ? b : a; }
  friend constexpr Dual max(const Dual& a, const Dual& b) { return b.value > a.value ? b : a; }
  /// a^b. Where b is a plain number, a may be negative or 0 as far as the power has a derivative
  /// there; otherwise a must be above 0.
  friend Dual pow(const Dual& a, const Dual& b) {
    const double power = std::pow(a.value, b.value);
    Dual result(power);
    for (std::size_t i = 0; i < N; ++i) {
      if (a.d[i] != 0.0 && b.value != 0.0)
        result.d[i] += b.value * std::pow(a.value, b.value - 1.0) * a.d[i];
      if (b.d[i] != 0.0) result.d[i] += power * std::log(a.value) * b.d[i];
    }
    return result;
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

/// The value and all derivatives are finite.
template <int N>
bool is_finite(const Dual<N>& dual) {
  for (const double slope : dual.d) {
    if (!std::isfinite(slope)) return false;
  }
  return std::isfinite(dual.value);
}

/// The value alone, for decisions inside a formula.
constexpr double plain(double value) { return value; }
template <int N>
constexpr double plain(const Dual<N>& dual) {
  return dual.value;
}

}  // namespace chaintrue::model

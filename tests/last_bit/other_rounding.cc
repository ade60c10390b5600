// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The C library's functions of double with another rounding, for LD_PRELOAD: computed by the same function of long
/// double and rounded to either of the two neighbours by a hash of the argument and of CHAINTRUE_ROUNDING (a whole
/// number). Exact results are unchanged. Libraries differ from each other by this much, and one library between
/// processors with and without fused multiplication: glibc 2.36 states errors below one unit in the last place for all of these
/// (glibc manual, "Known Maximum Errors in Math Functions").
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace {

/// The finaliser of MurmurHash3 (Appleby, public domain).
std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 33U;
  x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33U;
  x *= 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33U);
}

std::uint64_t seed() {
  static const std::uint64_t value = [] {
    const char* const text = std::getenv("CHAINTRUE_ROUNDING");
    return text == nullptr ? 0ULL : std::strtoull(text, nullptr, 10);
  }();
  return value;
}

double rounded(long double exact, double a, double b, std::uint64_t function) {
  const auto nearest = static_cast<double>(exact);
  if (!std::isfinite(nearest) || nearest == 0.0 || static_cast<long double>(nearest) == exact)
    return nearest;
  const std::uint64_t hash =
      mixed(std::bit_cast<std::uint64_t>(a) +
            mixed(std::bit_cast<std::uint64_t>(b) + mixed(100 * seed() + function)));
  if (hash % 2 == 0) return nearest;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return std::nextafter(nearest,
                        static_cast<long double>(nearest) < exact ? kInfinity : -kInfinity);
}

}  // namespace

#define CHAINTRUE_OF_ONE(name, number)                                    \
  extern "C" double name(double x) noexcept {                             \
    return rounded(name##l(static_cast<long double>(x)), x, 0.0, number); \
  }
#define CHAINTRUE_OF_TWO(name, number)                                                    \
  extern "C" double name(double x, double y) noexcept {                                   \
    return rounded(                                                                       \
        name##l(static_cast<long double>(x), static_cast<long double>(y)), x, y, number); \
  }
CHAINTRUE_OF_ONE(acos, 1)
CHAINTRUE_OF_ONE(asin, 2)
CHAINTRUE_OF_ONE(atan, 3)
CHAINTRUE_OF_ONE(atanh, 4)
CHAINTRUE_OF_ONE(cos, 5)
CHAINTRUE_OF_ONE(cosh, 6)
CHAINTRUE_OF_ONE(erf, 7)
CHAINTRUE_OF_ONE(erfc, 8)
CHAINTRUE_OF_ONE(exp, 9)
CHAINTRUE_OF_ONE(expm1, 10)
CHAINTRUE_OF_ONE(lgamma, 11)
CHAINTRUE_OF_ONE(log, 12)
CHAINTRUE_OF_ONE(log10, 13)
CHAINTRUE_OF_ONE(log1p, 14)
CHAINTRUE_OF_ONE(log2, 15)
CHAINTRUE_OF_ONE(sin, 16)
CHAINTRUE_OF_ONE(sinh, 17)
CHAINTRUE_OF_ONE(tan, 18)
CHAINTRUE_OF_ONE(tanh, 19)
CHAINTRUE_OF_TWO(atan2, 20)
CHAINTRUE_OF_TWO(hypot, 21)
CHAINTRUE_OF_TWO(pow, 22)

extern "C" void sincos(double x, double* sine, double* cosine) noexcept {
  *sine = sin(x);
  *cosine = cos(x);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/random.hpp"

#include <bit>
#include <cmath>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid {
namespace {

std::uint64_t split_mix(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

template <std::size_t Size>
double polynomial(const std::array<double, Size>& coefficients, double x) {
  double sum = 0.0;
  for (std::size_t i = Size; i > 0; --i) sum = sum * x + coefficients[i - 1];
  return sum;
}

// AS 241, PPND16: numerators and denominators of the rational approximations.
constexpr std::array<double, 8> kCentreTop = {3.3871328727963666080e0, 1.3314166789178437745e2,
                                              1.9715909503065514427e3, 1.3731693765509461125e4,
                                              4.5921953931549871457e4, 6.7265770927008700853e4,
                                              3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr std::array<double, 8> kCentreBottom = {1.0,
                                                 4.2313330701600911252e1,
                                                 6.8718700749205790830e2,
                                                 5.3941960214247511077e3,
                                                 2.1213794301586595867e4,
                                                 3.9307895800092710610e4,
                                                 2.8729085735721942674e4,
                                                 5.2264952788528545610e3};
constexpr std::array<double, 8> kTailTop = {1.42343711074968357734e0,  4.63033784615654529590e0,
                                            5.76949722146069140550e0,  3.64784832476320460504e0,
                                            1.27045825245236838258e0,  2.41780725177450611770e-1,
                                            2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr std::array<double, 8> kTailBottom = {1.0,
                                               2.05319162663775882187e0,
                                               1.67638483018380384940e0,
                                               6.89767334985100004550e-1,
                                               1.48103976427480074590e-1,
                                               1.51986665636164571966e-2,
                                               5.47593808499534494600e-4,
                                               1.05075007164441684324e-9};
constexpr std::array<double, 8> kFarTop = {6.65790464350110377720e0,  5.46378491116411436990e0,
                                           1.78482653991729133580e0,  2.96560571828504891230e-1,
                                           2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                           2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr std::array<double, 8> kFarBottom = {1.0,
                                              5.99832206555887937690e-1,
                                              1.36929880922735805310e-1,
                                              1.48753612908506148525e-2,
                                              7.86869131145613259100e-4,
                                              1.84631831751005468180e-5,
                                              1.42151175831644588870e-7,
                                              2.04426310338993978564e-15};

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t stream) {
  std::uint64_t mix = seed;
  // The stream is hashed separately, so that (1, 2) and (2, 1) are independent.
  std::uint64_t hashed = stream ^ split_mix(mix);
  for (std::uint64_t& word : state_) word = split_mix(hashed);
}

std::uint64_t Random::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17U;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Random::uniform() { return (as_double(bits() >> 11U) + 0.5) * 0x1.0p-53; }

double Random::uniform(double from, double to) { return from + (to - from) * uniform(); }

std::size_t Random::below(std::size_t count) {
  if (count == 0) throw std::invalid_argument("Random::below: count 0");
  // Rejects the last, incomplete run, so that all numbers are equally likely.
  const std::uint64_t n = count;
  const std::uint64_t limit = UINT64_MAX - UINT64_MAX % n;
  std::uint64_t drawn = bits();
  while (drawn >= limit) drawn = bits();
  return as_size(drawn % n);
}

double Random::normal() { return normal_quantile(uniform()); }

double Random::heavy_tailed() {
  const double z = normal();
  // -2 log(u1 u2) is chi-squared with 4 degrees of freedom; t = z / sqrt(chi2 / 4) has variance 2.
  const double chi2 = -2.0 * (portable_log(uniform()) + portable_log(uniform()));
  return z / std::sqrt(chi2 / 2.0);
}

double normal_quantile(double probability) {
  if (!(probability > 0.0 && probability < 1.0)) {
    throw precondition("normal_quantile: probability {}", probability);
  }
  const double q = probability - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * polynomial(kCentreTop, r) / polynomial(kCentreBottom, r);
  }
  const double r = std::sqrt(-portable_log(q < 0.0 ? probability : 1.0 - probability));
  const double z = r <= 5.0 ? polynomial(kTailTop, r - 1.6) / polynomial(kTailBottom, r - 1.6)
                            : polynomial(kFarTop, r - 5.0) / polynomial(kFarBottom, r - 5.0);
  return q < 0.0 ? -z : z;
}

double portable_log(double x) {
  if (!(std::isnormal(x) && x > 0.0)) {
    throw precondition("portable_log: argument {}", x);
  }
  // x = 2^e m with m in [1/sqrt 2, sqrt 2); log m = 2 atanh t, t = (m - 1) / (m + 1), |t| < 0.172:
  // 13 terms leave 2 t^27 / 27, below 1e-21.
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < 0.70710678118654752) {
    m *= 2.0;
    --e;
  }
  const double t = (m - 1.0) / (m + 1.0);
  const double t2 = t * t;
  double series = 0.0;
  for (int k = 25; k >= 3; k -= 2) series = (series + 1.0 / k) * t2;
  constexpr double kLn2 = 0.693147180559945309417;
  return e * kLn2 + 2.0 * t * (1.0 + series);
}

}  // namespace chaintrue::grid

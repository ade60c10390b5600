// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/statistics.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "grid/containers.hpp"

namespace chaintrue::grid {
namespace {

/// Tolerance of a multiple, as a share of the step: readings are rounded to a file's digits.
constexpr double kShareOfStep = 1e-4;
constexpr std::size_t kFewestReadings = 4;
constexpr double kInchMm = 25.4;
/// Steps of chosen places.
constexpr double kChosenMm[] = {5.0, kInchMm / 4.0};

bool are_multiples(const std::vector<double>& values, double step) {
  return all_of(values, [step](double value) {
    const double steps = value / step;
    return std::abs(steps - std::round(steps)) < kShareOfStep;
  });
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("the median of no values");
  sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

double rms(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / as_double(values.size()));
}

double rms(const std::vector<Vector2d>& values) { return rms_length(values) / std::sqrt(2.0); }

double rms_length(const std::vector<Vector2d>& values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const Vector2d& value : values) squares += value.squaredNorm();
  return std::sqrt(squares / as_double(values.size()));
}

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  if (high == kMinusInfinity) return high;
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

double log_sum(const std::vector<double>& terms) {
  double high = kMinusInfinity;
  for (const double term : terms) high = std::max(high, term);
  if (high == kMinusInfinity) return high;
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - high);
  return high + std::log(sum);
}

double rounding_sigma_mm(const std::vector<double>& readings_mm) {
  constexpr int kDecades = 6;
  if (readings_mm.size() < kFewestReadings) return 0.0;
  for (const double chosen : kChosenMm)
    if (are_multiples(readings_mm, chosen)) return 0.0;
  std::vector<double> steps{kInchMm / 16.0, kInchMm / 32.0, kInchMm / 64.0};
  for (const int decade : each_below(kDecades)) {
    for (const double digit : {1.0, 0.5, 0.2}) steps.push_back(digit * std::pow(10.0, -decade));
  }
  sort(steps, std::greater<>());
  const auto step = std::find_if(steps.begin(), steps.end(),
                                 [&](double one) { return are_multiples(readings_mm, one); });
  return step == steps.end() ? 0.0 : *step / std::sqrt(12.0);
}

}  // namespace chaintrue::grid

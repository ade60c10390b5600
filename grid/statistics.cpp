// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "grid/containers.hpp"

namespace chaintrue::grid {

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

double rms(const std::vector<Eigen::Vector2d>& values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const Eigen::Vector2d& value : values) squares += value.squaredNorm();
  return std::sqrt(squares / (2.0 * as_double(values.size())));
}

double rms_length(const std::vector<Eigen::Vector2d>& values) {
  if (values.empty()) return 0.0;
  double squares = 0.0;
  for (const Eigen::Vector2d& value : values) squares += value.squaredNorm();
  return std::sqrt(squares / as_double(values.size()));
}

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  if (high == -std::numeric_limits<double>::infinity()) return high;
  return high + std::log1p(std::exp(std::min(a, b) - high));
}

double log_sum(const std::vector<double>& terms) {
  double high = -std::numeric_limits<double>::infinity();
  for (const double term : terms) high = std::max(high, term);
  if (high == -std::numeric_limits<double>::infinity()) return high;
  double sum = 0.0;
  for (const double term : terms) sum += std::exp(term - high);
  return high + std::log(sum);
}

}  // namespace chaintrue::grid

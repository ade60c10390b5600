// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/periodogram.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "grid/linear_algebra.hpp"
#include "grid/precondition.hpp"
#include "grid/synthetic/random.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kPerSpan = 4.0;  // periods tried for each wave more over the span
constexpr std::size_t kFewest = 5;

using Pair = Eigen::Matrix<double, 2, Eigen::Dynamic>;

/// Cosine and sine of a period, made orthonormal to a constant and to each other; a wave that has
/// nothing left is 0.
Pair waves_at(const std::vector<double>& places_mm, double period_mm) {
  const auto n = static_cast<Eigen::Index>(places_mm.size());
  Pair pair(2, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    // From the first place: phases of long chains keep their digits.
    const double turns = (places_mm[static_cast<std::size_t>(i)] - places_mm.front()) / period_mm;
    const double phase = 2.0 * std::numbers::pi * (turns - std::floor(turns));
    pair(0, i) = std::cos(phase);
    pair(1, i) = std::sin(phase);
  }
  constexpr double kNothing = 1e-12;
  for (Eigen::Index k = 0; k < 2; ++k) {
    const double whole = pair.row(k).norm();
    pair.row(k).array() -= pair.row(k).mean();
    if (k == 1) pair.row(1) -= pair.row(1).dot(pair.row(0)) * pair.row(0);
    const double left = pair.row(k).norm();
    if (left > kNothing * std::max(whole, 1.0)) {
      pair.row(k) /= left;
    } else {
      pair.row(k).setZero();
    }
  }
  return pair;
}

/// About their mean, of length 1; 0 where all are equal.
Eigen::VectorXd about_mean(const std::vector<double>& values) {
  Eigen::VectorXd result =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  const double largest = result.cwiseAbs().maxCoeff();
  result.array() -= result.mean();
  const double length = result.norm();
  constexpr double kRounding = 1e-13;
  if (!(length > kRounding * largest)) return Eigen::VectorXd::Zero(result.size());
  return result / length;
}

void require_as_many(std::size_t values, std::size_t places) {
  if (values != places) {
    throw precondition("{} values for {} places", values, places);
  }
}

}  // namespace

Periodogram::Periodogram(std::vector<double> places_mm, double shortest_mm)
    : places_mm_(std::move(places_mm)) {
  if (places_mm_.size() < kFewest) {
    throw precondition("a periodogram of {} values: at least {}", places_mm_.size(), kFewest);
  }
  const auto [low, high] = std::minmax_element(places_mm_.begin(), places_mm_.end());
  const double span_mm = *high - *low;
  if (!(shortest_mm > 0.0) || !(span_mm > shortest_mm)) {
    throw precondition("periods from {} mm down to {} mm", span_mm, shortest_mm);
  }
  for (double per_span = 1.0; span_mm / per_span >= shortest_mm; per_span += 1.0 / kPerSpan) {
    periods_mm_.push_back(span_mm / per_span);
  }
  waves_.resize(2 * static_cast<Eigen::Index>(periods_mm_.size()),
                static_cast<Eigen::Index>(places_mm_.size()));
  for (std::size_t k = 0; k < periods_mm_.size(); ++k) {
    waves_.middleRows<2>(2 * static_cast<Eigen::Index>(k)) = waves_at(places_mm_, periods_mm_[k]);
  }
}

std::vector<double> Periodogram::power(const std::vector<double>& values) const {
  require_as_many(values.size(), places_mm_.size());
  const Eigen::VectorXd along = linear::product(waves_, about_mean(values));
  std::vector<double> result;
  for (Eigen::Index k = 0; k < along.size(); k += 2) {
    result.push_back(std::min(1.0, along.segment<2>(k).squaredNorm()));
  }
  return result;
}

double Periodogram::power_at(double period_mm, const std::vector<double>& values) const {
  require_as_many(values.size(), places_mm_.size());
  return std::min(1.0, (waves_at(places_mm_, period_mm) * about_mean(values)).squaredNorm());
}

double Periodogram::level(double chance, int draws, std::uint64_t seed) const {
  constexpr std::uint64_t kStream = 65;
  synthetic::Random random(seed, kStream);
  Eigen::MatrixXd z(waves_.cols(), draws);
  for (Eigen::Index draw = 0; draw < z.cols(); ++draw) {
    for (Eigen::Index i = 0; i < z.rows(); ++i) z(i, draw) = random.normal();
    z.col(draw).array() -= z.col(draw).mean();
    z.col(draw).normalize();
  }
  Eigen::ArrayXd largest = Eigen::ArrayXd::Zero(z.cols());
  constexpr Eigen::Index kRowsAtOnce = 128;  // rows at a time: what is held stays small
  for (Eigen::Index first = 0; first < waves_.rows(); first += kRowsAtOnce) {
    const Eigen::Index rows = std::min(kRowsAtOnce, waves_.rows() - first);
    const Eigen::ArrayXXd square = (waves_.middleRows(first, rows) * z).array().square();
    for (Eigen::Index k = 0; k + 1 < rows; k += 2) {
      largest = largest.max((square.row(k) + square.row(k + 1)).transpose());
    }
  }
  std::sort(largest.begin(), largest.end());
  // The data count as one draw.
  const auto above = static_cast<Eigen::Index>(std::floor(chance * (draws + 1.0)));
  return largest(std::clamp<Eigen::Index>(draws - above, 0, draws - 1));
}

double chance_at_one_period(double power, std::size_t values) {
  const double freedom = 0.5 * (static_cast<double>(values) - 3.0);
  return freedom > 0.0 ? std::pow(std::max(0.0, 1.0 - power), freedom) : 1.0;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Waves in values at uneven places: the residual of a chain along its length, where a sprocket
/// that runs out of true has the period of one turn and a link that is uneven that of one link.
///
/// The power at a period is the share of the values' square about their mean that a wave of that
/// period takes, its phase and the mean fitted with it: the generalised Lomb-Scargle periodogram
/// (M. Zechmeister and M. Kuerster, Astron. Astrophys. 496 (2009) 577, equations 4 to 13).
///
/// \code
///   const Periodogram waves(lengths_mm, 5.5);
///   const std::vector<double> power = waves.power(residuals_mm);   // by waves.periods_mm()
///   const double level = waves.level(0.01, 499, seed);  // noise passes it 1 time in 100
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace chaintrue::grid::diagnosis {

/// Immutable: safe from any thread.
class Periodogram {
 public:
  /// Periods from the whole span of the places down to `shortest_mm`, a quarter of a wave over the
  /// span from one to the next.
  /// \throws std::invalid_argument for fewer than 5 places, places of no span, or a shortest period
  /// that is not positive or longer than the span.
  Periodogram(std::vector<double> places_mm, double shortest_mm);

  /// Descending.
  [[nodiscard]] const std::vector<double>& periods_mm() const { return periods_mm_; }

  /// In 0 .. 1, at each period; all 0 for values that are all equal.
  /// \throws std::invalid_argument where there are not as many values as places.
  [[nodiscard]] std::vector<double> power(const std::vector<double>& values) const;
  /// At one period.
  [[nodiscard]] double power_at(double period_mm, const std::vector<double>& values) const;

  /// Largest power over all periods that so many draws of normal noise pass with this chance.
  [[nodiscard]] double level(double chance, int draws, std::uint64_t seed) const;

 private:
  std::vector<double> places_mm_;
  std::vector<double> periods_mm_;
  /// Two orthonormal waves a period, orthogonal to a constant: rows.
  Eigen::MatrixXd waves_;
};

/// Chance that normal noise of so many values has at least this power at a period given beforehand:
/// (1 - power)^((n - 3) / 2) (the same paper, equation 24).
[[nodiscard]] double chance_at_one_period(double power, std::size_t values);

}  // namespace chaintrue::grid::diagnosis

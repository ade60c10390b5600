// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The laws that are weighed: each variable with each shape and each way to enter, its place, scale or
/// period on a grid.
///
/// The grid of a wave is in waves over the span, a quarter of one from one to the next: between two of
/// them the phase is off by at most an eighth of a turn at either end, which costs less than a tenth of
/// the wave's square; leading waves get a finer grid. That of a wave with its second harmonic is an eighth
/// of a wave apart, for the same of the harmonic; it is weighed over x, over y, and over the length of the
/// chain or belt that it acts on, where something turns or repeats. Evenly spaced values mistake short waves
/// for long ones: no wave is weighed of which half is shorter than their spacing. A step stands at 48 places over the span, of
/// which those between the same two readings are one. Places of kinks: sixteen; scales: a factor of
/// 1.45 apart, neighbours of which have a collinearity of 0.99.
///
/// Priors: the share of a law halves with each parameter more, and is divided over the ways to enter,
/// directions and senses. A wave's period has a prior that is even in its logarithm. All shares together
/// are one, whatever the length of the list: laws that are listed twice have a half each.
///
///   const std::vector<LawCurve> curves = law_curves(system);
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/diagnosis/law_variables.hpp"
#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

struct LawCurve : LawTerm {
  LawShape shape = LawShape::linear;
  int towards = 0;
  double from = 0.0;
  double to = 0.0;
  /// Place and scale in units of the variable, of a wave waves over the span; one 0 where there is
  /// nothing to choose.
  std::vector<double> grid;
  std::vector<double> mass;  ///< prior of each, in all one
  double weight = 0.0;       ///< relative to those of other laws
  double share = 0.0;        ///< of all laws, in all one
  [[nodiscard]] double span() const { return to - from; }
  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// Where a step may stand, evenly over a range, in units of what it is a function of: the middle of each gap
/// between two of these values (sorted), with the share of the range that it takes.
struct StepPlaces {
  std::vector<double> at;
  std::vector<double> mass;
};
[[nodiscard]] StepPlaces step_places(const std::vector<double>& values, double from, double to);

/// Of this system's places.
[[nodiscard]] std::vector<LawCurve> law_curves(const RegressorSystem& system);
/// Shares in proportion to the weights.
void share_out(std::vector<LawCurve>& curves);

/// Amplitudes that enter linearly: two of a square and of a wave, four of a wave with its second
/// harmonic, else one.
[[nodiscard]] Eigen::Index columns_of(LawShape shape);
/// Whether there is a place, a scale or a period, and finer values of it mean something.
[[nodiscard]] bool is_continuous(LawShape shape);
/// Prior density of a point of the grid, but for a factor.
[[nodiscard]] double density_at(const LawCurve& curve, double at);

/// Whitened rows that a law's amplitudes add to, all rows by columns_of().
class LawColumns {
 public:
  explicit LawColumns(const RegressorSystem& system);
  /// At one point of a grid.
  [[nodiscard]] Eigen::MatrixXd of(const LawCurve& curve, double at) const;
  /// At several, one behind the other.
  [[nodiscard]] Eigen::MatrixXd of(const LawCurve& curve, const std::vector<double>& at) const;

 private:
  const RegressorSystem& system_;
};

}  // namespace chaintrue::grid::diagnosis

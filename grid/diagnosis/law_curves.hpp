// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The laws that are compared: each variable with each shape and each way to enter, its place,
/// scale or period on a grid.
///
/// The grid of a wave is in waves over the span, a quarter of one from one to the next: between two of
/// them the phase is off by at most an eighth of a turn at either end, which costs less than a tenth of
/// the wave's square; leading waves get a finer grid. That of a wave with its second harmonic is an eighth
/// of a wave apart, for the same of the harmonic; it is weighed over x, over y, and over the length of the
/// chain or belt that it acts on, where something turns or repeats. Evenly spaced values alias
/// short waves: no wave is tried whose half is shorter than their spacing. A step is tried at 48
/// places over the span; those between the same two readings count as one. Places of kinks:
/// sixteen; scales: a factor of 1.45 apart, neighbours of which have a collinearity of 0.99.
///
/// Priors: the share of a law halves with each parameter more, and is divided over the ways to enter,
/// directions and senses. A wave's period has a log-uniform prior. All shares together are one,
/// whatever the length of the list.
///
///   const std::vector<LawCurve> curves = law_curves(system);
#pragma once

#include <vector>

#include "grid/diagnosis/law.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

// The variables and entries of laws for the mechanism of a system: with two chains a law enters a
// chain or moves the tool; with four belts it enters a belt (where the tool should have been is
// unknown, so a movement of the tool cannot show).
//
// \code
//   for (const LawRows& own : law_rows(system, unit, {Coordinate::x, Enters::left, 0.0}))
//     rows += own.rows * f(own.v);
// \endcode

/// The variables of the system's mechanism, except Coordinate::across.
std::vector<Coordinate> law_variables(const RegressorSystem& system);

struct LawEntrance {
  Enters enters = Enters::left;
  double weight = 0.0;  ///< among all entries of a variable, of sum 1
};
/// A law in a chain's or belt's variable mostly acts on that chain or belt.
std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of);

/// A value of a law's variable, and what one millimetre of the law adds to the whitened rows of a
/// unit there.
struct LawRows {
  double v = 0.0;
  VectorXd rows;
};
/// One for each place of the unit, or two if the law moves the tool outwards; none at a visit
/// without a number for a law of the visits.
std::vector<LawRows> law_rows(const RegressorSystem& system, std::size_t unit, const LawTerm& term);

struct LawCurve : LawForm {
  /// Place and scale in units of the variable, for a wave waves over the span; a single 0 if there
  /// is no choice.
  std::vector<double> grid;
  std::vector<double> mass;  ///< prior of each, of sum 1
  double share = 0.0;        ///< among all laws, of sum 1
};

/// Where a step may lie, evenly over a range, in the unit of its variable: the middle of each gap
/// between two of these values (sorted), with the share of the range that it takes.
struct StepPlaces {
  std::vector<double> at;
  std::vector<double> mass;
};
StepPlaces step_places(const std::vector<double>& values, double from, double to);

/// For this system's places.
std::vector<LawCurve> law_curves(const RegressorSystem& system);
/// Divides the shares by their sum.
void share_out(std::vector<LawCurve>& curves);

/// Number of linear amplitudes: two for a square and a wave, four for a wave with its second
/// harmonic, else one.
Index columns_of(LawShape shape);
/// Whether there is a continuous place, scale or period to refine.
bool is_continuous(LawShape shape);
/// Prior density of a grid point, up to a factor.
double density_at(const LawCurve& curve, double at);

/// The factor of one amplitude of a law at one value of its variable; `at` as LawCurve::grid.
double basis_at(const LawForm& law, double at, Index column, double v);
/// Whitened rows that a law's amplitudes add to at some points of its grid, one after the other: all rows by columns_of().
MatrixXd law_columns(const RegressorSystem& system, const LawCurve& curve,
                     const std::vector<double>& at);

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The variables and entries of laws for the mechanism of a system: with two chains a law enters a
/// chain or moves the tool; with four belts it enters a belt (where the tool should have been is
/// unknown, so a movement of the tool cannot show).
///
/// \code
///   for (const LawRows& own : law_rows(system, unit, {Coordinate::x, Enters::left, 0.0}))
///     rows += own.rows * f(own.v);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/diagnosis/law.hpp"
#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

/// The variable of a law, and where it enters.
struct LawTerm {
  Coordinate of = Coordinate::x;
  Enters enters = Enters::left;
  double direction_rad = 0.0;  ///< of Coordinate::across and Enters::along
};

/// The variables of the system's mechanism, except Coordinate::across.
[[nodiscard]] std::vector<Coordinate> law_variables(const RegressorSystem& system);

struct LawEntrance {
  Enters enters = Enters::left;
  double weight = 0.0;  ///< among all entries of a variable, of sum 1
};
/// A law in a chain's or belt's variable mostly acts on that chain or belt.
[[nodiscard]] std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of);

/// The shortest period: shorter ones are implausible, or no marks show them.
[[nodiscard]] double shortest_wave(Coordinate of, Enters enters, double span);
/// Whether something rotates there, or consists of equal parts.
[[nodiscard]] bool may_repeat(Coordinate of, Enters enters);

/// Values of a law's variable at all places of a system that have one.
[[nodiscard]] std::vector<double> values_of_variable(const RegressorSystem& system,
                                                     Coordinate of,
                                                     double direction_rad);

/// A value of a law's variable, and what one millimetre of the law adds to the whitened rows of a
/// unit there.
struct LawRows {
  double v = 0.0;
  Eigen::VectorXd rows;
};
/// One for each place of the unit, or two if the law moves the tool outwards; none at a visit
/// without a number for a law of the visits.
[[nodiscard]] std::vector<LawRows> law_rows(const RegressorSystem& system,
                                            std::size_t unit,
                                            const LawTerm& term);

}  // namespace chaintrue::grid::diagnosis

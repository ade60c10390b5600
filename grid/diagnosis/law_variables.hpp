// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a law may be a function of and what it may enter, by the mechanism of a system: two chains, whose laws
/// enter a chain or move the tool, or four belts, whose laws enter a belt (where the tool should have been
/// is not known there, so that nothing shows what moves it).
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

/// What a law is a function of, and where it enters.
struct LawTerm {
  Coordinate of = Coordinate::x;
  Enters enters = Enters::left;
  double direction_rad = 0.0;  ///< of Coordinate::across and Enters::along
};

/// Those of the system's mechanism, but for Coordinate::across.
[[nodiscard]] std::vector<Coordinate> law_variables(const RegressorSystem& system);

struct LawEntrance {
  Enters enters = Enters::left;
  double weight = 0.0;  ///< of all entrances of a variable, in all one
};
/// A law of a chain or a belt mostly acts on that chain or belt.
[[nodiscard]] std::vector<LawEntrance> law_entrances(const RegressorSystem& system, Coordinate of);

/// Where waves end: shorter ones are not of such a thing, or no marks show them.
[[nodiscard]] double shortest_wave(Coordinate of, Enters enters, double span);
/// Something turns there, or is built of equal parts.
[[nodiscard]] bool may_repeat(Coordinate of, Enters enters);

/// Values of what a law is a function of, at all places of a system that have one.
[[nodiscard]] std::vector<double> values_of_variable(const RegressorSystem& system,
                                                     Coordinate of,
                                                     double direction_rad);

/// A value of what a law is a function of, and what one millimetre of the law adds to the rows of a unit
/// there, whitened.
struct LawRows {
  double v = 0.0;
  Eigen::VectorXd rows;
};
/// One for each place of the unit, two of what moves the tool outwards; none at a visit without a number, of
/// a law of these.
[[nodiscard]] std::vector<LawRows> law_rows(const RegressorSystem& system,
                                            std::size_t unit,
                                            const LawTerm& term);

}  // namespace chaintrue::grid::diagnosis

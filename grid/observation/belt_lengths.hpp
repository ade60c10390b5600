// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lengths of a mechanism that has more of them than a position has coordinates, four belts for one,
/// with the tool at a place whose position is known or is not.
///
///   l    lengths that count, m of them, one sigma each
///   f    what the mechanism makes of them at q                                m
///   J    d(f)/d(q)                                                            m x 2
///
/// A place that is known is a unit of m rows, y = l with covariance sigma^2 I + sigma_q^2 J J', as a
/// mark of two chains. Of one that is not known q is the position with the least |l - f|, and
/// columns Q span what is orthogonal to J:
///
///   y = 0,   predicted = -Q' (l - f),   A = Q' df/dtheta,   covariance sigma^2 I_(m-2)       (1)
///
/// What two lengths say is spent on the position; m - 2 rows remain and check the rest. A is the
/// derivative but for dQ, which is multiplied by what the lengths miss at q and is left out: the
/// least squares are the same, and passes converge as fast. Where fewer than three lengths count a
/// place has no rows and is no unit.
///
/// Source: G. Golub and V. Pereyra, The differentiation of pseudo-inverses and nonlinear least squares
/// problems whose variables separate, SIAM J. Numer. Anal. 10 (1973) 413; L. Kaufman, BIT 15 (1975)
/// 49, for A without dQ.
///
/// \code
///   const BeltLengthReadings readings(places, false, {.length_mm = 0.5}, 15.0);
///   const auto line = readings.linearise(View(mechanism), columns_of(readings));
/// \endcode
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "grid/observation/observation.hpp"

namespace chaintrue::grid::observation {

struct LengthsAtPlace {
  std::size_t index = 0;  ///< into the file's points
  std::string name;       ///< "3"
  Eigen::VectorXd lengths_mm;
  std::vector<bool> counting;  ///< of each length; empty: all
  model::MechanismVisit visit;
  /// Where the tool was, in the mechanism's frame; empty: nobody measured it.
  std::optional<model::ToolPosition> known = std::nullopt;
};

/// One sigma of a length, and of a known position on each axis.
struct BeltNoise {
  double length_mm = 1.0;
  double position_mm = 0.0;
};

class BeltLengthReadings final : public Observation {
 public:
  /// Sorts the places: by visit where the order is known, else by lengths.
  /// \throws std::invalid_argument for a sigma that is not positive.
  BeltLengthReadings(std::vector<LengthsAtPlace> places,
                     bool ordered,
                     BeltNoise noise,
                     double noise_dof);

  [[nodiscard]] const Kind& kind() const override { return belt_lengths; }
  [[nodiscard]] bool ordered() const override { return ordered_; }
  [[nodiscard]] double noise_dof() const override { return noise_dof_; }
  [[nodiscard]] bool may_slip() const override { return true; }
  [[nodiscard]] tl::expected<Eigen::VectorXd, Unreachable> predicted(
      const View& view) const override;
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;
  [[nodiscard]] std::string untestable(const model::effects::Effect& effect,
                                       model::effects::EffectSide side) const override;
  [[nodiscard]] std::string name_of(std::size_t unit) const override;

  /// Where a view puts the tool at a place: where it is known to be, or q of (1).
  [[nodiscard]] tl::expected<model::ToolPosition, model::MechanismFailure> position_of(
      const View& view, std::size_t place) const;
  /// In the order of places().
  [[nodiscard]] const std::vector<LengthsAtPlace>& readings() const { return readings_; }
  /// The unit's place.
  [[nodiscard]] std::size_t place_of(std::size_t unit) const { return place_of_unit_.at(unit); }
  /// A unit about a view: its part of predicted(), A and C, and what a mm more of each length at its
  /// place does to its rows.
  struct UnitLine {
    Eigen::VectorXd predicted;
    Eigen::MatrixXd by_parameter;
    Eigen::MatrixXd covariance;
    Eigen::MatrixXd by_length;   ///< rows x lengths; no rows without `with_parameters`
    Eigen::VectorXd lengths_mm;  ///< f at the place, all lengths
  };
  [[nodiscard]] tl::expected<UnitLine, Unreachable> line_of(const View& view,
                                                            std::size_t unit,
                                                            bool with_parameters) const;

 private:
  std::vector<LengthsAtPlace> readings_;
  std::vector<std::size_t> place_of_unit_;
  bool ordered_;
  BeltNoise noise_;
  double noise_dof_;
};

}  // namespace chaintrue::grid::observation

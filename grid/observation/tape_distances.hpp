// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tape distances between holes that the machine cut, and to the sheet's edges. Where the holes are
/// was not measured; it follows from what the controller paid out for them.
///
///   l_i   chain lengths that the controller paid out for hole i
///   q_i   where the machine puts the tool with them: f(q_i) = l_i
///   m_i   q_i on the sheet
///   d_k   |m_a - m_b|, or m_a's distance from an edge                                      (1)
///   V     tape^2 I + hole^2 B B' + size^2 w w' + zero^2 1 1', B = dd/dm                    (2)
///
/// A distance is a unit of one row with the tape's own noise. Nuisances, in this order: how much
/// wider and higher the sheet is (edges), the zero offset of the tape (all readings) unless it is
/// exact, and the shift of each hole in x and y (all its distances). The frame of the sheet matters
/// to edges alone: distances between holes do not move with it.
///
/// Adding c to the chains at a hole moves it by dm = -J^-1 c, so D_i = -dd/dm_i J^-1.
///
/// \code
///   const auto distances = TapeDistances::of(set);          // set.machine has the controller
///   const auto line = distances->linearise({ReadingModel(machine), {}}, columns_of(*distances));
///   if (line) whiten(distances->measured() - line->predicted, marginal_covariance(*line, ...));
/// \endcode
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/measured_holes.hpp"
#include "grid/observation/observation.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::observation {

/// (1) at given places, with its derivative.
struct DistanceGeometry {
  VectorXd predicted_mm;  ///< n
  MatrixXd by_mark;       ///< n x 2 N, x and y of each hole
  MatrixXd by_size;       ///< n x 2, by the sheet's excess width and height
};
DistanceGeometry distance_geometry(const MeasuredHoles& set, const std::vector<MarkPoint>& marks);

/// (2) in its parts: the tape's alone (a diagonal), the holes', that of the sheet's size and that
/// of the zero offset.
struct DistanceNoise {
  VectorXd tape_mm2;
  MatrixXd holes_mm2;
  MatrixXd size_mm2;
  MatrixXd tape_zero_mm2;
};
DistanceNoise distance_noise(const MeasuredHoles& set, const DistanceGeometry& geometry);

/// Read over true length, if the machine's effects include a tape error.
double tape_factor(const Machine& machine);

/// Sigma of exactly stated values, mm: no workshop reading is more accurate.
inline constexpr double kKnownNuisanceMm = 1e-6;

/// The prior of a sheet's placement if its edges were measured.
inline constexpr SheetPrior kSheetByEdges{50.0, 0.03};

/// Directions in which the measured edges determine the sheet's placement.
SheetPrior sheet_measured(const MeasuredHoles& set);

/// Offsets of a set's holes and distances among those of several sets.
struct NumberedFrom {
  std::size_t hole = 0;
  std::size_t distance = 0;
};

class TapeDistances final : public Observation {
 public:
  /// Sorts holes by place and distances by their holes. Fails with a sentence where a command is out
  /// of the controller's reach. \throws std::invalid_argument for a set without a machine.
  [[nodiscard]] static tl::expected<TapeDistances, std::string> of(const MeasuredHoles& set,
                                                                   NumberedFrom first = {});
  /// The same in the order of the set.
  [[nodiscard]] static tl::expected<TapeDistances, std::string> in_given_order(MeasuredHoles set);

  const Kind& kind() const override { return tape_distances; }
  /// measured() are the readings less the zero offset.
  Index nuisances_of_noise() const override { return 2 * std::ssize(places_); }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;

  std::string untestable(const Effect& effect, EffectSide side) const override;

  std::string name_of(std::size_t unit) const override;

  /// In the order of places() and units().
  const MeasuredHoles& set() const { return set_; }
  /// The holes' positions for a view, with the lengths paid out for them.
  [[nodiscard]] tl::expected<std::vector<ChainPlaceState>, Unreachable> placed(
      const View& view) const;

 private:
  explicit TapeDistances(MeasuredHoles set)
      : Observation(false, set.noise_dof), set_(std::move(set)) {}

  MeasuredHoles set_;
};

}  // namespace chaintrue::grid::observation

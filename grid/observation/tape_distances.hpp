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

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/containers.hpp"
#include "grid/eigen.hpp"
#include "grid/observation/measured_holes.hpp"
#include "grid/observation/observation.hpp"

namespace chaintrue::grid::observation {

/// (1) at given places, with its derivative.
struct DistanceGeometry {
  VectorXd predicted_mm;  ///< n
  MatrixXd by_mark;       ///< n x 2 N, x and y of each hole
  MatrixXd by_size;       ///< n x 2, by the sheet's excess width and height
};
DistanceGeometry distance_geometry(const MeasuredHoles& set,
                                   const std::vector<model::MarkPoint>& marks);

/// (2) in its parts: the tape's alone (a diagonal), the holes', that of the sheet's size and that
/// of the zero offset.
struct DistanceNoise {
  VectorXd tape_mm2;
  MatrixXd holes_mm2;
  MatrixXd size_mm2;
  MatrixXd tape_zero_mm2;
};
DistanceNoise distance_noise(const MeasuredHoles& set, const DistanceGeometry& geometry);

/// The one effect of the paper that a tape can have: its scale.
bool is_of_tape(const model::effects::Effect& effect, model::effects::EffectSide side);
/// Read over true length, if the machine's effects include a tape error.
double tape_factor(const model::Machine& machine);

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
      const View& view, const Columns& columns) const override {
    const std::vector<model::Setting> settings = settings_in(columns);
    auto states = placed(view);
    if (!states) return tl::unexpected(states.error());
    std::vector<model::MarkPoint> marks;
    for (const ChainPlaceState& state : *states) marks.push_back(state.mark);
    const double factor = tape_factor(view.chains().machine());
    const DistanceGeometry geometry = distance_geometry(set_, marks);
    const MatrixXd by_mark = factor * geometry.by_mark;
    Linearisation line = blank(std::ssize(settings));
    line.predicted = factor * geometry.predicted_mm;
    for (std::size_t i = 0; i < states->size(); ++i) {
      const ChainPlaceState& place = (*states)[i];
      // f(sheet(m), settings) = l holds: dm = -(df/dm)^-1 df/ds ds
      const Matrix2Xd lengths = place.by_length.asDiagonal() *
                                lengths_by_setting(view, place.reading, place.mark, settings);
      const Matrix2Xd marks_by_setting = -place.by_mark.inverse() * lengths;
      line.by_setting += by_mark.middleCols<2>(2 * as_index(i)) * marks_by_setting;
    }
    line.by_nuisance << factor * geometry.by_size, VectorXd::Ones(rows()), by_mark;
    for (Index k = 0; k < rows(); ++k) {
      const double sigma = sigma_of(set_, set_.distances[as_size(k)]);
      UnitState unit{MatrixXd::Constant(1, 1, sigma * sigma), {}};
      for (std::size_t i = 0; i < states->size(); ++i) {
        const RowVector2d own = by_mark.block<1, 2>(k, 2 * as_index(i));
        if (!own.isZero(0.0)) unit.places.push_back({i, -own * (*states)[i].by_mark.inverse()});
      }
      line.units.push_back(std::move(unit));
    }
    line.places = std::move(*states);
    return line;
  }

  std::string untestable(const model::effects::Effect& effect,
                         model::effects::EffectSide side) const override {
    if (effect.needs == model::effects::DataNeed::order) {
      return "the order in which the holes were cut is not in the file, and no chain was read";
    }
    if (effect.station == model::effects::Station::paper && !is_of_tape(effect, side)) {
      return "a tape has one scale in every direction, and no axes: print or place marks and read "
             "the chains there";
    }
    return "";
  }

  std::string name_of(std::size_t unit) const override {
    return "the distance " + words_of(set_, set_.distances.at(unit));
  }

  /// In the order of places() and units().
  const MeasuredHoles& set() const { return set_; }
  /// The holes' positions for a view, with the lengths paid out for them.
  [[nodiscard]] tl::expected<std::vector<ChainPlaceState>, Unreachable> placed(
      const View& view) const {
    // A correction changes by a thousandth of a hole's shift and the chains' scale is below 0.2 %:
    // each iteration gains at least two digits, starting within some mm.
    constexpr int kTurns = 6;
    constexpr double kConvergedMm = 1e-9;
    std::vector<ChainPlaceState> states;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const model::ChainLengths paid_out = places_[i].lengths;
      model::BedPoint start = model::identity_placement(places_[i].mark);
      model::ChainLengths own = paid_out;
      // The machine's lengths that equal the paid-out ones after correction at a mark.
      const auto correct = [&](model::MarkPoint mark) {
        const auto there = view.correction->at(mark, own, Matrix2d::Zero()).lengths;
        own = {paid_out.left_mm - (there.left_mm - own.left_mm),
               paid_out.right_mm - (there.right_mm - own.right_mm)};
      };
      if (view.correction != nullptr) correct(places_[i].mark);
      auto reading = view.chains().find(own, start);
      for (int turn = 1; reading && view.correction != nullptr && turn < kTurns; ++turn) {
        start = reading->pose.position;
        const model::ChainLengths before = own;
        correct(view.sheet.to_mark(start));
        if (std::abs(own.left_mm - before.left_mm) + std::abs(own.right_mm - before.right_mm) <
            kConvergedMm)
          break;
        reading = view.chains().find(own, start);
      }
      if (!reading) return tl::unexpected(model::mechanism_failure(reading.error()).at(i));
      ChainPlaceState state{*reading, view.sheet.to_mark(reading->pose.position),
                            reading->position_jacobian * view.sheet.rotation()};
      if (view.correction != nullptr) {
        const auto corrected = view.correction->at(state.mark, reading->lengths, state.by_mark);
        state.by_mark = corrected.by_mark;
        state.by_length = corrected.by_length;
      }
      states.push_back(std::move(state));
    }
    return states;
  }

 private:
  explicit TapeDistances(MeasuredHoles set)
      : Observation(false, set.noise_dof), set_(std::move(set)) {}

  void state_nuisances() {
    const Index of_holes = 2 * std::ssize(set_.holes);
    nuisance_sigma_.resize(3 + of_holes);
    nuisance_sigma_ << set_.sheet.size_sigma_mm, set_.sheet.size_sigma_mm,
        tape_zero_sigma_mm(set_.tape), VectorXd::Constant(of_holes, set_.hole_sigma_mm);
    nuisance_sigma_ = nuisance_sigma_.cwiseMax(kKnownNuisanceMm);
  }

  MeasuredHoles set_;
};

}  // namespace chaintrue::grid::observation

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All readings at one linearisation as rows by the unknowns, and the conversion of the unknowns to
/// settings and splines. Private to grid/estimation.
#pragma once

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/estimation/free_sheet.hpp"
#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/observed_subspace.hpp"
#include "grid/estimation/reading_shifts.hpp"
#include "grid/estimation/surface_correction.hpp"
#include "grid/estimation/unknowns.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "interp/measured_region.hpp"

namespace chaintrue::grid::estimation {

/// The iteration's state.
struct State {
  VectorXd settings;        ///< deviations of the machine's and the sheets'
  ResidualSurface surface;  ///< with the scales
};

class JointProblem {
 public:
  /// `input` must outlive the problem. `rejected` has an entry for each unit, or none.
  JointProblem(const EstimationInput& input, bool has_surface, RejectedReadings rejected = {})
      : input_(input),
        rejected_(std::move(rejected)),
        set_(observation_set(input.machine, input.observations, input.mechanism)),
        has_surface_(has_surface),
        basis_(basis_for(input, has_surface)) {
    const std::size_t lengths = set_.mechanism->lengths().size();
    if (has_surface && lengths != 2) {
      throw precondition("a surface corrects two lengths, not the {} of {}", lengths,
                         set_.mechanism->kind());
    }
    unknowns_.of_set = set_.stated_value.size();
    unknowns_.scales = lengths == 2 ? 2 : 0;
    places_move_ = !all_of(input.observations, [](const auto& observation) {
      return is_linear_in_correction(*observation);
    });
  }

  State stated() const {
    const VectorXd nothing = VectorXd::Zero(basis_.size());
    return {VectorXd::Zero(set_.setting_columns()), {basis_, {0.0, 0.0}, {nothing, nothing}}};
  }

  [[nodiscard]] EstimationFailure unreachable(const UnreachablePlace& failure) const {
    const observation::Observation& readings = *input_.observations[failure.place.observation];
    const observation::Place& there = readings.places()[failure.place.place];
    return {EstimationFailure::Reason::place_unreachable,
            fmt::format("{} {} at ({:.1f}, {:.1f}): {}", readings.kind().place, there.name,
                        there.mark.x_mm, there.mark.y_mm, failure.sentence())};
  }

  /// Fails if the machine has no pose at a place.
  tl::expected<void, EstimationFailure> linearise(const State& state) {
    const std::vector<SurfaceCorrection> corrections = corrections_of(state);
    const auto mechanism = mechanism_at(state.settings);
    std::vector<ObservedFrom> from;
    for (const auto k : each_index(set_.parts)) {
      from.push_back(
          {{mechanism, sheet_at(state.settings, k),
            is_about_surface(k) ? &corrections[k] : nullptr},
           state.settings(set_.columns_of(set_.parts[k]))});
    }
    const auto system = estimation::linearise(set_, from);
    if (!system) return tl::unexpected(unreachable(system.error()));
    std::vector<MarkPoint> marks;
    for (const SystemPlace& place : system->places)
      marks.push_back(corrections[place.observation].to_surface(place.state.mark));
    observe(std::move(marks));
    relate_values();
    fill_design(*system, state);
    eliminate_free_directions(*system, from, state);
    return {};
  }

  /// For each observation, with the state's surface. The state must outlive them.
  std::vector<SurfaceCorrection> corrections_of(const State& state) const {
    const SheetPlacement first = sheet_at(state.settings, 0);
    std::vector<SurfaceCorrection> corrections{SurfaceCorrection(state.surface)};
    for (std::size_t k = 1; k < set_.parts.size(); ++k)
      corrections.emplace_back(state.surface, first, sheet_at(state.settings, k));
    return corrections;
  }

  const EstimationInput& input() const { return input_; }
  const ObservationSet& set() const { return set_; }
  const Unknowns& unknowns() const { return unknowns_; }
  /// Number of a map's settings, the first unknowns: parameters, and those of the first sheet.
  Index settings() const {
    return set_.parts.front().sheet ? ObservationSet::sheet_column(1) : set_.parameters();
  }
  /// The mechanism and a sheet for deviations from what was stated.
  std::shared_ptr<const Mechanism> mechanism_at(const VectorXd& deviations) const {
    return set_.mechanism->with_values(set_.mechanism->values() +
                                       deviations.head(set_.parameters()));
  }
  SheetPlacement sheet_at(const VectorXd& deviations, std::size_t observation) const {
    const auto& sheet = set_.parts[observation].sheet;
    if (!sheet) return {};
    const Vector3d at = deviations.segment<3>(ObservationSet::sheet_column(*sheet));
    return {at.x(), at.y(), at.z()};
  }

  bool has_surface() const { return has_surface_; }
  /// Null without a surface.
  const ObservedSubspace* observed() const { return observed_ ? &*observed_ : nullptr; }
  /// Some places follow from the machine: they move with what is estimated.
  bool places_move() const { return places_move_; }
  /// Units that may be rejected, readings that cannot be outliers, and the whitened rows of both by
  /// all unknowns.
  const std::vector<SystemUnit>& units() const { return units_; }
  const std::vector<SystemUnit>& certain() const { return certain_; }
  const MatrixXd& design() const { return design_; }
  const VectorXd& response() const { return response_; }
  /// For a unit; none if the unit is an outlier as a whole.
  const Rows& rejected(std::size_t unit) const {
    static const Rows kNone;
    return rejected_.empty() ? kNone : rejected_.at(unit);
  }
  const RejectedReadings& rejected() const { return rejected_; }
  /// Counted rows minus the fit's effective parameters.
  double dof(const interp::PenalisedFit& fit) const {
    Index rows = 0;
    for (const auto u : each_index(units_)) rows += without_readings(units_[u], rejected(u)).cols();
    return as_double(rows) - fit.edf;
  }

  /// Marks of each observation's places, with a free sheet placed as its frame is defined.
  const std::vector<std::vector<MarkPoint>>& marks() const { return laid_marks_; }

  /// All columns of the set of a fit, including the free directions, then the scales and the
  /// coefficients of the splines; and their covariance, as far as the places observe the splines.
  VectorXd values(const interp::PenalisedFit& fit) const {
    return constant_ + to_values_ * fit.coefficients;
  }
  MatrixXd covariance(const interp::PenalisedFit& fit) const {
    return linear::carried(to_values_, fit.corrected_covariance);
  }
  /// The order of values(). Without a surface, its coefficients are 0.
  FitColumns columns() const { return {unknowns_.of_set, basis_.size()}; }

  /// The state that a fit of the problem leads to.
  State state_of(const interp::PenalisedFit& fit) const {
    const VectorXd all = values(fit);
    State state = stated();
    state.settings = all.head(set_.setting_columns());
    for (const Side side : kSides) {
      state.surface.scale[side] = all[columns().scale(side)];
      state.surface.coefficients[side] = all.segment(columns().spline(side), basis_.size());
    }
    return state;
  }

 private:
  /// Intervals slightly wider than the square that each place has to itself: with three more
  /// coefficients than intervals on each axis noise-free points can still be interpolated; the
  /// penalty makes excess ones harmless, and more than some 200 per surface would only cost time.
  /// The smoother surface is for accurate points, which resolve more.
  static interp::BsplineBasis basis_for(const EstimationInput& input, bool has_surface) {
    if (!has_surface) return {input.domain, 1, 1};
    if (input.intervals_x > 0 && input.intervals_y > 0)
      return {input.domain, input.intervals_x, input.intervals_y};
    std::vector<interp::PlanePoint> places;
    for (const auto& observation : input.observations) {
      for (const observation::Place& place : observation->places())
        places.push_back({place.mark.x_mm, place.mark.y_mm});
    }
    const double widening = input.bending_order == 2 ? 1.2 : 0.8;
    const double spacing_mm =
        widening * std::sqrt(interp::ConvexHull(places).area() / as_double(places.size()));
    const auto intervals = [spacing_mm](double length_mm, int most) {
      return std::clamp(static_cast<int>(std::ceil(length_mm / spacing_mm)), 3, most);
    };
    return {input.domain, intervals(input.domain.width(), 12), intervals(input.domain.height(), 8)};
  }

  /// Chain lengths at given marks are linear in the correction, so it can be omitted from the point
  /// of linearisation; the tool's position depends on the correction.
  static bool is_linear_in_correction(const observation::Observation& observation) {
    return observation.places().empty() || observation.kind().reads_chains;
  }
  /// An observation's rows are linearised about the state's surface.
  bool is_about_surface(std::size_t observation) const {
    return input_.fixed_weights || !is_linear_in_correction(*input_.observations[observation]);
  }

  /// The part of the surface that the places observe; computed once if they are fixed.
  void observe(std::vector<MarkPoint> places) {
    surface_marks_ = std::move(places);
    if (!has_surface_ || (observed_ && !places_move_)) return;
    observed_.emplace(basis_, input_.bending_order, surface_marks_);
    unknowns_.polynomials = observed_->polynomials.cols();
    unknowns_.penalised = observed_->penalised.cols();
  }

  /// The values that the unknowns lead to, linear in these.
  void relate_values() {
    constant_ = VectorXd::Zero(columns().total());
    to_values_ = MatrixXd::Zero(columns().total(), unknowns_.total());
    const Index plain = unknowns_.of_set + unknowns_.scales;
    to_values_.topLeftCorner(plain, plain).setIdentity();
    for (const Side side : kSides) {
      if (!has_surface_) break;
      auto spline = to_values_.middleRows(columns().spline(side), basis_.size());
      spline.middleCols(unknowns_.polynomial(side), unknowns_.polynomials) =
          observed_->polynomials;
      spline.middleCols(unknowns_.first_penalised_of(side), unknowns_.penalised) =
          observed_->penalised;
    }
  }

  /// e f + s at the state.
  Vector2d correction_at(std::size_t place, const SystemPlace& at, const State& state) const {
    const ChainLengths own = at.state.reading.lengths;
    const ChainLengths corrected =
        state.surface.apply(surface_marks_[place], own, Matrix2d::Zero()).lengths;
    return difference(corrected, own);
  }

  void fill_design(const LinearisedSystem& system, const State& state) {
    design_ = MatrixXd::Zero(system.response.size(), unknowns_.total());
    design_.leftCols(unknowns_.of_set) = system.by_setting;
    response_ = system.response;
    units_ = system.units;
    certain_ = system.certain;
    for (const auto* units : {&units_, &certain_}) {
      for (const SystemUnit& unit : *units) add_chain_columns(system, unit, state);
    }
  }

  /// Adds a chain's length and its surface at a place to rows, `by_chain` being their derivatives by
  /// the chain.
  template <class ByChain, class Rows>
  void add_chain(std::size_t place, const SystemPlace& at, Side side, const ByChain& by_chain,
                 Rows rows) const {
    rows.col(unknowns_.scale(side)) += by_chain * at.state.reading.lengths[side];
    if (!has_surface_) return;
    const auto row = as_index(place);
    rows.middleCols(unknowns_.polynomial(side), unknowns_.polynomials) +=
        by_chain * observed_->polynomial_rows.row(row);
    rows.middleCols(unknowns_.first_penalised_of(side), unknowns_.penalised) +=
        by_chain * observed_->penalised_rows.row(row);
  }

  /// The scales' and the surface's columns of a unit.
  void add_chain_columns(const LinearisedSystem& system, const SystemUnit& unit,
                         const State& state) {
    for (const observation::PlaceColumns& place : unit.places) {
      const SystemPlace& at = system.places[place.place];
      for (const Side side : kSides) {
        const VectorXd by_chain = place.by_chain.col(row_of(side));
        add_chain(place.place, at, side, by_chain, design_.middleRows(unit.first_row, unit.rows));
      }
      if (is_about_surface(unit.observation))
        response_.segment(unit.first_row, unit.rows) +=
            place.by_chain * correction_at(place.place, at, state);
    }
  }

  /// d(corrected lengths at a mark)/d(unknowns), 2 x total.
  MatrixXd lengths_by_unknown(std::size_t place, const SystemPlace& at,
                              const ObservedFrom& from) const {
    const ObservationPart& part = set_.parts[at.observation];
    MatrixXd rows = MatrixXd::Zero(2, unknowns_.total());
    rows(Eigen::all, set_.columns_of(part)) =
        at.state.by_length.asDiagonal() *
        observation::lengths_by_setting(
            from.view, at.state.reading, at.state.mark,
            observation::settings_in(observation::columns_of(*part.observation)));
    for (const Side side : kSides) {
      const Eigen::Matrix<double, 1, 1> one(1.0);
      add_chain(place, at, side, one, rows.middleRows<1>(row_of(side)));
    }
    return rows;
  }

  void eliminate_free_directions(const LinearisedSystem& system,
                                 const std::vector<ObservedFrom>& from, const State& state) {
    laid_marks_.clear();
    for (const auto k : each_index(set_.parts)) {
      const ObservationPart& part = set_.parts[k];
      PlacesOnSheet places;
      for (std::size_t i = 0; part.sheet && i < model::kSheetSettings.size(); ++i) {
        if (part.observation->sheet()->knows(model::kSheetSettings[i])) continue;
        places.free_rows.push_back(as_index(i));
        places.free_columns.push_back(ObservationSet::sheet_column(*part.sheet) + as_index(i));
      }
      const Index rows = 2 * std::ssize(part.observation->places());
      places.by_unknown = MatrixXd::Zero(rows, unknowns_.total());
      places.moved = VectorXd::Zero(rows);
      for (const auto p : each_index(system.places)) {
        const SystemPlace& at = system.places[p];
        if (at.observation != k) continue;
        places.commanded.push_back(part.observation->places()[at.place].mark);
        places.marks.push_back(at.state.mark);
        if (places.free_columns.empty()) continue;
        const Matrix2d to_mark = -at.state.by_mark.inverse();
        const auto row = 2 * as_index(at.place);
        const MatrixXd lengths = lengths_by_unknown(p, at, from[k]);
        places.by_unknown.middleRows<2>(row) = to_mark * lengths;
        places.moved.segment<2>(row) =
            to_mark * (lengths(Eigen::all, set_.columns_of(part)) * from[k].settings +
                       correction_at(p, at, state));
      }
      if (const ColumnSet& free = places.free_columns; !free.empty()) {
        const auto [constant, by_unknown] = places.lay();
        constant_(free) = constant;
        to_values_(free, Eigen::all) = by_unknown;
        const MatrixXd by_free = design_(Eigen::all, free);
        response_ -= by_free * constant;
        design_(Eigen::all, free).setZero();
        design_ += by_free * by_unknown;
      }
      laid_marks_.push_back(std::move(places.marks));
    }
  }

  const EstimationInput& input_;
  RejectedReadings rejected_;
  ObservationSet set_;
  Unknowns unknowns_;
  bool has_surface_;
  bool places_move_ = false;
  interp::BsplineBasis basis_;
  std::optional<ObservedSubspace> observed_;
  std::vector<MarkPoint> surface_marks_;  ///< of all places, in the first sheet's frame
  std::vector<std::vector<MarkPoint>> laid_marks_;
  std::vector<SystemUnit> units_, certain_;
  MatrixXd design_;
  VectorXd response_;
  VectorXd constant_;  ///< of the values, and their derivative by the unknowns
  MatrixXd to_values_;
};

}  // namespace chaintrue::grid::estimation

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings and priors as one penalised problem at one linearisation, and the conversion of its
/// unknowns to settings and splines. Private to grid/estimation.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/estimation/free_sheet.hpp"
#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/local_design.hpp"
#include "grid/estimation/observed_subspace.hpp"
#include "grid/estimation/reading_shifts.hpp"
#include "grid/estimation/surface_correction.hpp"
#include "grid/estimation/unknowns.hpp"

namespace chaintrue::grid::estimation {

/// The iteration's state.
struct State {
  Eigen::VectorXd settings;  ///< unknowns of machine and sheets; all others are 0
  ResidualSurface surface;   ///< with the scales
};

class JointProblem {
 public:
  /// `input` must outlive the problem. `rejected` has an entry for each unit, or none.
  JointProblem(const EstimationInput& input, bool has_surface, RejectedReadings rejected = {});

  [[nodiscard]] State stated() const;
  [[nodiscard]] EstimationFailure unreachable(const UnreachablePlace& failure) const;
  /// Fails if the machine has no pose at a place.
  tl::expected<void, EstimationFailure> linearise(const State& state);
  /// With a weight for each unit; 0 rejects it.
  [[nodiscard]] interp::PenalisedProblem weighted(const Eigen::VectorXd& weights) const;
  /// For each observation, with the state's surface. The state must outlive them.
  [[nodiscard]] std::vector<SurfaceCorrection> corrections_of(const State& state) const;
  /// The state that a fit of the problem leads to.
  [[nodiscard]] State state_of(const interp::PenalisedFit& fit) const;

  [[nodiscard]] const Unknowns& unknowns() const { return *unknowns_; }
  /// As above before linearisation, without a surface's.
  [[nodiscard]] const Unknowns& layout() const { return layout_; }
  [[nodiscard]] bool has_surface() const { return has_surface_; }
  /// Some places follow from the machine: they move with what is estimated.
  [[nodiscard]] bool places_move() const { return places_move_; }
  /// Units that may be rejected, and their whitened rows by all unknowns.
  [[nodiscard]] const std::vector<SystemUnit>& units() const { return units_; }
  [[nodiscard]] const Eigen::MatrixXd& design() const { return design_; }
  [[nodiscard]] const Eigen::VectorXd& response() const { return response_; }
  /// For a unit; none if the unit is an outlier as a whole.
  [[nodiscard]] const std::vector<Eigen::Index>& rejected(std::size_t unit) const;
  [[nodiscard]] const RejectedReadings& rejected() const { return rejected_; }
  /// Counted rows minus the fit's effective parameters.
  [[nodiscard]] double dof(const interp::PenalisedFit& fit) const;
  /// The local design for many readings under a surface; null if the dense one is as fast.
  [[nodiscard]] const LocalDesign* local() const { return local_ ? &*local_ : nullptr; }
  /// Marks of an observation's places, with a free sheet placed as its frame is defined.
  [[nodiscard]] const std::vector<model::MarkPoint>& marks(std::size_t observation) const {
    return laid_marks_[observation];
  }
  /// The part of a map's unknowns that the places observe, and the part that keeps its prior.
  [[nodiscard]] Eigen::MatrixXd map_covariance(const interp::PenalisedFit& fit,
                                               const FitColumns& columns) const;
  /// Covariance of all unknowns, including the free directions.
  [[nodiscard]] Eigen::VectorXd coefficients(const interp::PenalisedFit& fit) const;
  [[nodiscard]] Eigen::MatrixXd covariance(const interp::PenalisedFit& fit) const;

 private:
  void observe(std::vector<model::MarkPoint> places);
  void fill_design(const LinearisedSystem& system, const State& state);
  void add_chain_columns(const LinearisedSystem& system,
                         const SystemUnit& unit,
                         const State& state,
                         Eigen::MatrixXd& design,
                         Eigen::VectorXd& response) const;
  void eliminate_free_directions(const LinearisedSystem& system,
                                 const std::vector<ObservedFrom>& from,
                                 const State& state);
  [[nodiscard]] Eigen::MatrixXd lengths_by_unknown(std::size_t place,
                                                   const SystemPlace& at,
                                                   const observation::View& view) const;
  [[nodiscard]] Eigen::Vector2d correction_at(std::size_t place,
                                              const SystemPlace& at,
                                              const State& state) const;
  void add_rows(interp::PenalisedProblem& problem, const Eigen::VectorXd& weights) const;
  void add_settings_prior(interp::PenalisedProblem& problem) const;
  void add_nuisance_prior(interp::PenalisedProblem& problem) const;
  void add_surface_prior(interp::PenalisedProblem& problem, const Eigen::VectorXd& weights) const;

  const EstimationInput& input_;
  RejectedReadings rejected_;
  ObservationSet set_;
  Unknowns layout_;  ///< without a surface's columns, which the places decide
  bool has_surface_;
  bool places_move_ = false;
  interp::BsplineBasis basis_;
  std::optional<ObservedSubspace> observed_;
  std::optional<Unknowns> unknowns_;
  std::vector<model::MarkPoint> surface_marks_;  ///< of all places, in the first sheet's frame
  std::vector<std::vector<model::MarkPoint>> laid_marks_;
  std::vector<SystemUnit> units_;
  Eigen::MatrixXd design_;
  Eigen::VectorXd response_;
  std::optional<LocalDesign> local_;
  /// Rows of readings that cannot be outliers.
  Eigen::MatrixXd sure_design_;
  Eigen::VectorXd sure_response_;
  FreeDirections free_;
};

}  // namespace chaintrue::grid::estimation

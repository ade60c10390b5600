// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The passes of estimate() and their state. Private to grid/estimation.
///
/// estimate.cpp repeats linearise, solve and weigh until a pass changes nothing;
/// rejected_readings.cpp leaves out single readings; estimate_result.cpp makes the estimate from
/// the last pass.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/estimation/joint_problem.hpp"

namespace chaintrue::grid::estimation {

/// When the passes end.
struct ConvergenceRule {
  int most_passes;
  double step_sigmas;  ///< of the stated sigmas
  bool scales_count;
  int fewest_rounds;
};

class Estimator {
 public:
  explicit Estimator(const EstimationInput& input)
      : input_(input),
        problem_(std::make_unique<JointProblem>(input_, input_.surface == SurfaceUse::smoothed)),
        state_(problem_->stated()) {}

  tl::expected<Estimate, EstimationFailure> run();

 private:
  /// Choosing the smoothing costs some twenty times a solution.
  enum class Smoothing { choose, keep };
  using Fit = tl::expected<interp::PenalisedFit, EstimationFailure>;
  [[nodiscard]] Fit solve(const Eigen::VectorXd& weights,
                          Smoothing smoothing,
                          bool correct_covariance) const;
  tl::expected<void, EstimationFailure> approach();
  tl::expected<void, EstimationFailure> converge();
  void begin_weights();
  /// A reading and the number of its unit in the problem.
  struct Shift : ReadingShift {
    observation::UnitReading at;
  };
  /// Among the rejected readings, or among the others.
  [[nodiscard]] std::vector<Shift> shifts(bool of_rejected) const;
  [[nodiscard]] std::optional<Shift> worst_reading() const;
  [[nodiscard]] std::optional<Shift> best_rejected() const;
  [[nodiscard]] bool converge_without(RejectedReadings rejected);
  void reject_readings();
  [[nodiscard]] double step_to(const State& next, const ConvergenceRule& rule) const;
  [[nodiscard]] bool update_weights(int pass);
  [[nodiscard]] std::optional<std::size_t> worst_alone() const;
  tl::expected<void, EstimationFailure> choose_surface();
  [[nodiscard]] tl::expected<Estimate, EstimationFailure> result() const;
  void fill_units(Estimate& estimate) const;
  tl::expected<void, EstimationFailure> fill_observations(Estimate& estimate) const;
  void fill_covariances(Estimate& estimate) const;

  EstimationInput input_;
  std::unique_ptr<JointProblem> problem_;
  State state_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd distances_;
  interp::PenalisedFit fit_;
  std::vector<std::vector<model::MarkPoint>> as_stated_;
  bool converged_ = false;
  bool is_linearised_ = false;  ///< the problem is about the state
  double surface_log_evidence_ = 0.0;
};

}  // namespace chaintrue::grid::estimation

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The passes of estimate() and their state. Private to grid/estimation.
///
/// They repeat linearise, solve and weigh until a pass changes nothing. Then single readings that the
/// others contradict are left out one at a time, the worst first. The last pass makes the estimate.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/estimation/finished_fit.hpp"
#include "grid/failed.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

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

  tl::expected<Estimate, EstimationFailure> run() {
    if (auto done = approach(); !done) return failed(done);
    if (auto done = converge(); !done) return failed(done);
    if (input_.reading_limits) reject_readings();
    if (input_.surface == SurfaceUse::on_evidence) {
      if (auto done = choose_surface(); !done) return failed(done);
    }
    return result();
  }

 private:
  using Reason = EstimationFailure::Reason;

  /// A smaller change of a weight changes results by at most a few hundredths of a sigma.
  static constexpr double kConvergedWeight = 1e-2;
  /// Passes with soft weights only, so that several bad units cannot hide each other.
  static constexpr int kSoftRounds = 4;

  /// A step of 3e-3 stated sigmas changes no length by more than some 1e-3 mm. Where places follow
  /// from what is estimated, holes lie where the last step put them; distances converge more slowly, one
  /// of them being rejected at a time.
  static ConvergenceRule convergence_rule_of(const EstimationInput& input, bool places_move) {
    if (input.fixed_weights) return {12, 1e-6, true, 0};
    return places_move ? ConvergenceRule{40, 1e-3, true, kSoftRounds + 2}
                       : ConvergenceRule{25, 3e-3, false, kSoftRounds + 2};
  }

  static EstimationFailure failure_of(const interp::FitFailure& refusal) {
    return {refusal.reason == interp::FitFailure::Reason::rank_deficient ? Reason::rank_deficient
                                                                         : Reason::not_converged,
            refusal.sentence()};
  }

  /// Choosing the smoothing costs some twenty times a solution.
  enum class Smoothing { choose, keep };
  using Fit = tl::expected<interp::PenalisedFit, EstimationFailure>;
  Fit solve(const VectorXd& weights, Smoothing smoothing, bool correct_covariance) const {
    const interp::PenalisedProblem problem = weighted(*problem_, weights);
    interp::FitOptions options;
    options.correct_covariance = correct_covariance;
    options.prior = input_.noise_prior;
    auto fit = smoothing == Smoothing::choose
                   ? interp::fit_penalised(problem, options)
                   : interp::fit_with_smoothing(problem, fit_.lambda, fit_.sigma2);
    if (!fit) return tl::unexpected(failure_of(fit.error()));
    return *std::move(fit);
  }

  tl::expected<void, EstimationFailure> approach() {
    constexpr int kMostSteps = 100;
    constexpr double kLargestDamping = 1e12;
    // Relative reduction of the sum of squares: smaller steps are a small part of a sigma. The second
    // is for noise-free readings.
    constexpr double kNear = 1e-6;
    constexpr double kNearNothing = 1e-12;
    const bool is_known = problem_->set().stated_sigma.head(problem_->settings()).allFinite();
    const bool has_settings_alone =
        input_.surface == SurfaceUse::none && problem_->unknowns().total() == problem_->settings();
    if (is_known || !has_settings_alone) return {};
    if (auto done = problem_->linearise(state_); !done) return done;
    begin_weights();
    const auto square_at = [](const interp::PenalisedProblem& problem, const VectorXd& x) {
      const VectorXd off = x - problem.prior_mean;
      return (problem.response - linear::product(problem.design, x)).squaredNorm() +
             off.dot(linear::product(problem.prior_precision, off));
    };
    interp::PenalisedProblem now = weighted(*problem_, weights_);
    double square = square_at(now, state_.settings);
    double damping = 1e-4;
    is_linearised_ = true;
    for (int step = 0; step < kMostSteps && damping <= kLargestDamping; ++step) {
      const VectorXd downhill =
          now.design.transpose() * (now.response - now.design * state_.settings) +
          now.prior_precision * (now.prior_mean - state_.settings);
      MatrixXd normal = linear::gram(now.design);
      normal.diagonal() *= 1.0 + damping;
      normal += now.prior_precision;
      State next = state_;
      next.settings += linear::PivotedCholesky(normal).solve(downhill);
      is_linearised_ = next.settings.allFinite() && problem_->linearise(next).has_value();
      if (is_linearised_) {
        interp::PenalisedProblem there = weighted(*problem_, weights_);
        const double left = square_at(there, next.settings);
        is_linearised_ = left <= square;
        if (is_linearised_) {
          const bool is_near = square - left <= kNear * square + kNearNothing;
          state_ = std::move(next);
          now = std::move(there);
          square = left;
          damping = std::max(damping / 100.0, 1e-15);
          if (is_near) break;
          continue;
        }
      }
      damping *= 4.0;
    }
    return {};
  }

  tl::expected<void, EstimationFailure> converge() {
    ConvergenceRule rule = convergence_rule_of(input_, problem_->places_move());
    if (input_.most_passes > 0) rule.most_passes = input_.most_passes;
    converged_ = false;
    Smoothing smoothing = Smoothing::choose;
    for (int pass = 0; pass < rule.most_passes; ++pass) {
      WorkStep work = input_.step;
      work.pass = pass + 1;
      tell(input_.progress, work);
      // Once all but the smoothing has converged, the iteration that chooses it may be the last.
      const bool last = pass + 1 == rule.most_passes;
      const bool perhaps_last = converged_ || last || !problem_->has_surface();
      if (perhaps_last) smoothing = Smoothing::choose;
      if (!is_linearised_) {
        if (auto done = problem_->linearise(state_); !done) return failed(done);
      }
      is_linearised_ = false;
      begin_weights();
      if (as_stated_.empty()) as_stated_ = problem_->marks();
      Fit fit = solve(weights_, smoothing, perhaps_last && problem_->has_surface());
      if (!fit) return failed(fit);
      fit_ = *std::move(fit);
      State next = problem_->state_of(fit_);
      const double step = step_to(next, rule);
      state_ = std::move(next);
      const VectorXd solved_with = weights_;
      converged_ =
          !update_weights(pass) && step < rule.step_sigmas && pass + 1 >= rule.fewest_rounds;
      if (perhaps_last && (converged_ || last)) {
        // The reported units belong to the weights of the last solution.
        weights_ = solved_with;
        break;
      }
      // Otherwise chosen again only when the bad units are first rejected.
      smoothing = pass == kSoftRounds ? Smoothing::choose : Smoothing::keep;
    }
    return {};
  }

  void begin_weights() {
    if (weights_.size() > 0) return;
    const auto units = std::ssize(problem_->units());
    weights_ = input_.fixed_weights.value_or(VectorXd::Ones(units));
    distances_ = VectorXd::Zero(units);
  }

  /// The counted reading that the others contradict most, if they do.
  std::optional<Shift> worst_reading() const {
    std::optional<Shift> worst;
    // Readings that share one check deviate equally; the first of them is taken.
    constexpr double kSame = 1e-6;
    for (const Shift& one : shifts(*problem_, fit_, false)) {
      if (!worst || one.sigmas > (1.0 + kSame) * worst->sigmas) worst = one;
    }
    if (worst && worst->sigmas < input_.reading_limits->rejected_beyond) worst.reset();
    return worst;
  }

  /// The rejected reading that fits best, if it does.
  std::optional<Shift> best_rejected() const {
    std::optional<Shift> best;
    double least = input_.reading_limits->rejected_beyond;
    for (const Shift& one : shifts(*problem_, fit_, true)) {
      if (!(one.sigmas > 0.0 && one.sigmas < least)) continue;
      least = one.sigmas;
      best = one;
    }
    return best;
  }

  /// False, with nothing changed, if the fit without them fails.
  bool converge_without(RejectedReadings rejected) {
    std::vector<std::vector<observation::UnitReading>> of_observation(input_.observations.size());
    for (const auto u : each_index(rejected)) {
      const SystemUnit& unit = problem_->units()[u];
      for (const Index i : rejected[u]) of_observation[unit.observation].push_back({unit.unit, i});
    }
    const observation::Observations before = input_.observations;
    auto fit = fit_;
    auto state = state_;
    for (const auto k : each_index(before)) {
      if (auto other = before[k]->about_others(of_observation[k]))
        input_.observations[k] = std::move(other);
    }
    auto problem =
        std::exchange(problem_, std::make_unique<JointProblem>(input_, false, std::move(rejected)));
    is_linearised_ = false;
    if (converge()) return true;
    problem_ = std::move(problem);
    input_.observations = before;
    fit_ = std::move(fit);
    state_ = std::move(state);
    return false;
  }

  void reject_readings() {
    const ReadingLimits& limits = *input_.reading_limits;
    if (std::sqrt(fit_.sigma2) > limits.most_noise) return;
    Index readings = 0;
    for (const SystemUnit& unit : problem_->units()) readings += unit.by_reading.cols();
    const auto most = static_cast<std::size_t>(limits.most_share * as_double(readings));
    const auto of_now = [this] {
      RejectedReadings rejected = problem_->rejected();
      rejected.resize(problem_->units().size());
      return rejected;
    };
    for (std::size_t out = 0; out < most && problem_->dof(fit_) > 1.0; ++out) {
      const auto worst = worst_reading();
      if (!worst) break;
      RejectedReadings more = of_now();
      more[worst->at.unit].push_back(worst->at.reading);
      if (!converge_without(std::move(more))) break;
    }
    // A reading rejected while a worse one was still included may fit after all.
    for (std::size_t back = 0; back < most; ++back) {
      const auto best = best_rejected();
      if (!best) break;
      const RejectedReadings now = of_now();
      RejectedReadings fewer = now;
      std::erase(fewer[best->at.unit], best->at.reading);
      if (!converge_without(std::move(fewer))) break;
      if (!worst_reading()) continue;
      converge_without(now);
      break;
    }
  }

  double step_to(const State& next, const ConvergenceRule& rule) const {
    double step = 0.0;
    for (const Index i : each_below(problem_->settings())) {
      const double stated = problem_->set().stated_sigma[i];
      if (stated <= kKnownSigma) continue;
      // Without a prior the sigma from the readings sets the scale; for noise-free readings, a
      // micrometre.
      constexpr double kLeastSigma = 1e-3;
      const double sigma =
          std::isfinite(stated) ? stated : std::max(std::sqrt(fit_.covariance(i, i)), kLeastSigma);
      step = std::max(step, std::abs(next.settings[i] - state_.settings[i]) / sigma);
    }
    for (const Side side : kSides) {
      if (!rule.scales_count || problem_->unknowns().scales == 0) break;
      step = std::max(
          step, std::abs(next.surface.scale[side] - state_.surface.scale[side]) / kScaleSigma);
    }
    return step;
  }

  bool update_weights(int pass) {
    if (input_.fixed_weights) return false;
    const LeftOut left_out(*problem_, fit_, weights_);
    for (const Index u : each_below(distances_.size()))
      distances_[u] = left_out.distance(as_size(u));
    double change = 0.0;
    VectorXd next = weights_;
    for (const auto u : each_index(problem_->units())) {
      const UnitRule rule = rule_of(problem_->units()[u].rows);
      const auto at = as_index(u);
      if (rule.worst_first && weights_[at] == 0.0) continue;
      const bool bad =
          !rule.worst_first && pass >= kSoftRounds && distances_[at] > rule.rejected_beyond;
      next[at] =
          bad ? 0.0 : std::min(1.0, rule.full_weight_within / std::max(distances_[at], 1e-12));
      change = std::max(change, std::abs(next[at] - weights_[at]));
    }
    weights_ = std::move(next);
    if (pass >= kSoftRounds) {
      if (const auto worst = worst_alone()) {
        weights_[as_index(*worst)] = 0.0;
        return true;
      }
    }
    return change > kConvergedWeight;
  }

  std::optional<std::size_t> worst_alone() const {
    constexpr double kSuspect = 2.5;
    std::optional<std::size_t> worst;
    std::size_t candidates = 0;
    for (const auto u : each_index(problem_->units())) {
      const auto at = as_index(u);
      if (weights_[at] == 0.0 || !rule_of(problem_->units()[u].rows).worst_first) continue;
      ++candidates;
      if (distances_[at] <= kSuspect) continue;
      if (!worst || distances_[at] > distances_[as_index(*worst)]) worst = u;
    }
    if (!worst || candidates <= kFewestSingleRows) return std::nullopt;
    VectorXd without = weights_;
    without[as_index(*worst)] = 0.0;
    const Fit fit = solve(without, Smoothing::choose, false);
    if (!fit) return std::nullopt;
    const bool bad =
        LeftOut(*problem_, *fit, without).distance(*worst) > rule_of(1).rejected_beyond;
    return bad ? worst : std::nullopt;
  }

  tl::expected<void, EstimationFailure> choose_surface() {
    interp::FitOptions plain;
    plain.prior = interp::SmoothingPrior::none;
    plain.correct_covariance = false;
    // V without a surface; for unknown noise it includes the prior (reml.hpp).
    const bool unknown = input_.noise.knowledge == interp::NoiseKnowledge::unknown;
    const double without = fit_.minus_two_log_reml + (unknown ? std::log(fit_.sigma2) : 0.0);
    auto bent = std::make_unique<JointProblem>(input_, true);
    State state = bent->stated();
    state.settings = state_.settings;
    state.surface.scale = state_.surface.scale;
    if (auto done = bent->linearise(state); !done) return done;
    const auto with = interp::fit_penalised(weighted(*bent, weights_), plain);
    if (!with) return {};  // readings that do not determine a surface do not support one
    // The polynomials' prior, added to V as a constant.
    const double prior = 2.0 * as_double(bent->unknowns().polynomials) *
                         std::log(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
    surface_log_evidence_ = 0.5 * (without - (with->minus_two_log_reml - prior));
    if (surface_log_evidence_ < kSurfaceEvidence) return {};
    problem_ = std::move(bent);
    state_ = std::move(state);
    weights_.resize(0);
    return converge();
  }

  [[nodiscard]] tl::expected<Estimate, EstimationFailure> result() const {
    auto estimate =
        FinishedFit{*problem_, fit_, state_, weights_, distances_, as_stated_}.estimate();
    if (estimate) {
      estimate->surface_log_evidence = surface_log_evidence_;
      estimate->converged = converged_;
    }
    return estimate;
  }

  EstimationInput input_;
  std::unique_ptr<JointProblem> problem_;
  State state_;
  VectorXd weights_;
  VectorXd distances_;
  interp::PenalisedFit fit_;
  std::vector<std::vector<MarkPoint>> as_stated_;
  bool converged_ = false;
  bool is_linearised_ = false;  ///< the problem is about the state
  double surface_log_evidence_ = 0.0;
};

}  // namespace chaintrue::grid::estimation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/estimator.hpp"
#include "grid/estimation/left_out.hpp"
#include "grid/estimation/unknowns.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {
namespace {

using model::Side;
using Reason = EstimationFailure::Reason;

/// A smaller change of a weight changes results by at most a few hundredths of a sigma.
constexpr double kConvergedWeight = 1e-2;
/// Passes with soft weights only, so that several bad units cannot hide each other.
constexpr int kSoftRounds = 4;

/// Length that a vector of n standard normal numbers exceeds as seldom as one number exceeds z:
/// E. Wilson and M. Hilferty, The distribution of chi-square, Proc. Natl. Acad. Sci. 17 (1931) 684.
double chi(Eigen::Index n, double z) {
  const double part = 2.0 / (9.0 * as_double(n));
  return std::sqrt(as_double(n) * std::pow(1.0 - part + z * std::sqrt(part), 3));
}

/// The treatment of a unit by its distance.
struct UnitRule {
  double full_weight_within;  ///< 95 % of good units
  double rejected_beyond;
  bool worst_first;  ///< one at a time, against the others' prediction and noise
};

UnitRule rule_of(Eigen::Index rows) {
  if (rows == 1) return {1.96, kBadDistanceSigmas, true};
  if (rows == 2) return {2.4477, kBadPointDistance, false};
  // The same probabilities as for two rows: 5 % and 4e-5.
  return {chi(rows, 1.6449), chi(rows, 3.9444), false};
}

/// A step of 3e-3 stated sigmas changes no length by more than some 1e-3 mm. Where places follow
/// from what is estimated, holes lie where the last step put them; distances converge more slowly, one
/// of them being rejected at a time.
ConvergenceRule convergence_rule_of(const EstimationInput& input, bool places_move) {
  if (input.fixed_weights) return {12, 1e-6, true, 0};
  return places_move ? ConvergenceRule{40, 1e-3, true, kSoftRounds + 2}
                     : ConvergenceRule{25, 3e-3, false, kSoftRounds + 2};
}

EstimationFailure failure_of(const interp::FitFailure& refusal) {
  return {refusal.reason == interp::FitFailure::Reason::rank_deficient ? Reason::rank_deficient
                                                                       : Reason::not_converged,
          refusal.sentence()};
}

}  // namespace

Estimator::Fit Estimator::solve(const Eigen::VectorXd& weights,
                                Smoothing smoothing,
                                bool correct_covariance) const {
  const interp::PenalisedProblem problem = problem_->weighted(weights);
  interp::FitOptions options;
  options.correct_covariance = correct_covariance;
  options.prior = input_.noise_prior;
  auto fit = smoothing == Smoothing::choose
                 ? interp::fit_penalised(problem, options)
                 : interp::fit_with_smoothing(problem, fit_.lambda, fit_.sigma2);
  if (!fit) return tl::unexpected(failure_of(fit.error()));
  return *std::move(fit);
}

double Estimator::step_to(const State& next, const ConvergenceRule& rule) const {
  double step = 0.0;
  const Unknowns& unknowns = problem_->unknowns();
  for (Eigen::Index i = 0; i < unknowns.settings(); ++i) {
    if (unknowns.sigma(i) <= kKnownSigma) continue;
    // Without a prior the sigma from the readings sets the scale; for noise-free readings, a
    // micrometre.
    constexpr double kLeastSigma = 1e-3;
    const double sigma = std::isfinite(unknowns.sigma(i))
                             ? unknowns.sigma(i)
                             : std::max(std::sqrt(fit_.covariance(i, i)), kLeastSigma);
    step = std::max(step, std::abs(next.settings[i] - state_.settings[i]) / sigma);
  }
  for (const Side side : model::kSides) {
    if (!rule.scales_count || unknowns.scales() == 0) break;
    step = std::max(step,
                    std::abs(next.surface.scale[side] - state_.surface.scale[side]) / kScaleSigma);
  }
  return step;
}

/// The worst-fitting one-row unit, if it is too far from the prediction by the others.
std::optional<std::size_t> Estimator::worst_alone() const {
  constexpr double kSuspect = 2.5;
  std::optional<std::size_t> worst;
  std::size_t candidates = 0;
  for (std::size_t u = 0; u < problem_->units().size(); ++u) {
    const auto at = as_index(u);
    if (weights_[at] == 0.0 || !rule_of(problem_->units()[u].rows).worst_first) continue;
    ++candidates;
    if (distances_[at] <= kSuspect) continue;
    if (!worst || distances_[at] > distances_[as_index(*worst)]) worst = u;
  }
  if (!worst || candidates <= kFewestSingleRows) return std::nullopt;
  Eigen::VectorXd without = weights_;
  without[as_index(*worst)] = 0.0;
  const Fit fit = solve(without, Smoothing::choose, false);
  if (!fit) return std::nullopt;
  const bool bad = LeftOut(*problem_, *fit, without).distance(*worst) > rule_of(1).rejected_beyond;
  return bad ? worst : std::nullopt;
}

/// True if the weights changed enough to fit again.
bool Estimator::update_weights(int pass) {
  if (input_.fixed_weights) return false;
  LeftOut left_out(*problem_, fit_, weights_);
  left_out.prepare_units();
  for (Eigen::Index u = 0; u < distances_.size(); ++u)
    distances_[u] = left_out.distance(as_size(u));
  double change = 0.0;
  Eigen::VectorXd next = weights_;
  for (std::size_t u = 0; u < problem_->units().size(); ++u) {
    const UnitRule rule = rule_of(problem_->units()[u].rows);
    const auto at = as_index(u);
    if (rule.worst_first && weights_[at] == 0.0) continue;
    const bool bad =
        !rule.worst_first && pass >= kSoftRounds && distances_[at] > rule.rejected_beyond;
    next[at] = bad ? 0.0 : std::min(1.0, rule.full_weight_within / std::max(distances_[at], 1e-12));
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

void Estimator::begin_weights() {
  if (weights_.size() > 0) return;
  const auto units = std::ssize(problem_->units());
  weights_ = input_.fixed_weights.value_or(Eigen::VectorXd::Ones(units));
  distances_ = Eigen::VectorXd::Zero(units);
}

/// Settings without a prior may start far off: steps are damped until they reduce the sum of
/// squares (K. Madsen, H. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems
/// (2004), section 3.2), down to where the passes converge by themselves.
tl::expected<void, EstimationFailure> Estimator::approach() {
  constexpr int kMostSteps = 100;
  constexpr double kLargestDamping = 1e12;
  // Relative reduction of the sum of squares: smaller steps are a small part of a sigma. The second
  // is for noise-free readings.
  constexpr double kNear = 1e-6;
  constexpr double kNearNothing = 1e-12;
  const Unknowns& layout = problem_->layout();
  bool is_known = true;
  for (Eigen::Index i = 0; i < layout.settings(); ++i)
    is_known = is_known && std::isfinite(layout.sigma(i));
  const bool has_settings_alone =
      input_.surface == SurfaceUse::none && layout.total() == layout.settings();
  if (is_known || !has_settings_alone) return {};
  if (auto done = problem_->linearise(state_); !done) return done;
  begin_weights();
  const auto square_at = [](const interp::PenalisedProblem& problem, const Eigen::VectorXd& x) {
    const Eigen::VectorXd off = x - problem.prior_mean;
    return (problem.response - linear::product(problem.design, x)).squaredNorm() +
           off.dot(linear::product(problem.prior_precision, off));
  };
  interp::PenalisedProblem now = problem_->weighted(weights_);
  double square = square_at(now, state_.settings);
  double damping = 1e-4;
  is_linearised_ = true;
  for (int step = 0; step < kMostSteps && damping <= kLargestDamping; ++step) {
    Eigen::MatrixXd normal = now.gram + now.prior_precision;
    const Eigen::VectorXd downhill = now.moment +
                                     linear::product(now.prior_precision, now.prior_mean) -
                                     linear::product(normal, state_.settings);
    normal.diagonal() += damping * now.gram.diagonal();
    State next = state_;
    next.settings += linear::PivotedCholesky(normal).solve(downhill);
    is_linearised_ = next.settings.allFinite() && problem_->linearise(next).has_value();
    if (is_linearised_) {
      interp::PenalisedProblem there = problem_->weighted(weights_);
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

tl::expected<void, EstimationFailure> Estimator::converge() {
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
      if (auto done = problem_->linearise(state_); !done) return tl::unexpected(done.error());
    }
    is_linearised_ = false;
    begin_weights();
    if (as_stated_.empty()) {
      for (std::size_t k = 0; k < input_.observations.size(); ++k)
        as_stated_.push_back(problem_->marks(k));
    }
    Fit fit = solve(weights_, smoothing, perhaps_last && problem_->has_surface());
    if (!fit) return tl::unexpected(fit.error());
    fit_ = *std::move(fit);
    State next = problem_->state_of(fit_);
    const double step = step_to(next, rule);
    state_ = std::move(next);
    const Eigen::VectorXd solved_with = weights_;
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

/// A surface with the smoothness preferred by the readings, if they support one.
tl::expected<void, EstimationFailure> Estimator::choose_surface() {
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
  const auto with = interp::fit_penalised(bent->weighted(weights_), plain);
  if (!with) return {};  // readings that do not determine a surface do not support one
  // The polynomials' prior, added to V as a constant.
  const double prior = 2.0 * as_double(bent->unknowns().surface().polynomials) *
                       std::log(1.0 / (kFreePartSigmaMm * kFreePartSigmaMm));
  surface_log_evidence_ = 0.5 * (without - (with->minus_two_log_reml - prior));
  if (surface_log_evidence_ < kSurfaceEvidence) return {};
  problem_ = std::move(bent);
  state_ = std::move(state);
  weights_.resize(0);
  return converge();
}

tl::expected<Estimate, EstimationFailure> Estimator::run() {
  if (auto done = approach(); !done) return tl::unexpected(done.error());
  if (auto done = converge(); !done) return tl::unexpected(done.error());
  if (input_.reading_limits) reject_readings();
  if (input_.surface == SurfaceUse::on_evidence) {
    if (auto done = choose_surface(); !done) return tl::unexpected(done.error());
  }
  return result();
}

ParameterKnowledge stated_knowledge(const model::Machine& machine) {
  ParameterKnowledge knowledge{Eigen::VectorXd::Zero(kMachineUnknowns),
                               Eigen::MatrixXd::Zero(kMachineUnknowns, kMachineUnknowns)};
  for (Eigen::Index i = 0; i < kMachineSettingCount; ++i) {
    const double sigma =
        std::max(model::stated_sigma(machine, model::kMachineSettings[as_size(i)]), kKnownSigma);
    knowledge.covariance(i, i) = sigma * sigma;
  }
  knowledge.covariance(kMachineSettingCount, kMachineSettingCount) = knowledge.covariance(
      kMachineSettingCount + 1, kMachineSettingCount + 1) = kScaleSigma * kScaleSigma;
  return knowledge;
}

tl::expected<Estimate, EstimationFailure> estimate(const EstimationInput& input) {
  if (input.observations.empty()) throw std::invalid_argument("an estimate without an observation");
  return Estimator(input).run();
}

}  // namespace chaintrue::grid::estimation

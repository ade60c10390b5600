// SPDX-License-Identifier: GPL-3.0-or-later
// The minimiser of V over theta, and the posterior averaged about it. Notation as in reml.hpp and
// reml_likelihood.hpp.
#include "interp/reml.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "interp/linear_algebra.hpp"
#include "interp/reml_likelihood.hpp"
#include "interp/require.hpp"

namespace chaintrue::interp {

void PenalisedProblem::add_rows(const Eigen::Ref<const MatrixXd>& x,
                                const Eigen::Ref<const VectorXd>& y) {
  require(x.cols() == columns() && x.rows() == y.size(),
          "{} x {} design rows and {} responses for {} columns", x.rows(), x.cols(), y.size(),
          columns());
  design.conservativeResize(design.rows() + x.rows(), Eigen::NoChange);
  design.bottomRows(x.rows()) = x;
  response.conservativeResize(design.rows());
  response.tail(y.size()) = y;
  rows += x.rows();
}

void PenalisedProblem::add_products(Index count, const MatrixXd& products) {
  const MatrixXd root = linear::PivotedCholesky(products).root(0.0).transpose();
  add_rows(root.leftCols(columns()), root.rightCols(1));
  rows += count - root.rows();
}

namespace {

using namespace reml;

tl::unexpected<FitFailure> rank_deficient() {
  return tl::unexpected(FitFailure{
      FitFailure::Reason::rank_deficient,
      "the points do not determine the fit: some combination of its unknowns is left free"});
}

// A state on the way to the minimum.
struct Place {
  double slope() const { return derivatives.gradient.lpNorm<Eigen::Infinity>(); }

  State state;
  Derivatives derivatives;     // the gradient of the free unknowns only
  Theta free = Theta::Ones();  // 0 for one that is given or that V presses against a limit
};

// Fixed unknowns get a curvature of 1 and no coupling.
linear::SymmetricEigen curvatures(const Matrix2d& hessian, const Theta& free) {
  Matrix2d result = hessian.cwiseProduct(free * free.transpose());
  result.diagonal() += Theta::Ones() - free;
  return linear::SymmetricEigen(result);
}

// Newton's step with the Hessian's eigenvalues made positive, no longer than kLongestStep.
Theta newton_step(const Place& place) {
  constexpr double kLongestStep = 4.0;
  const auto parts = curvatures(place.derivatives.hessian, place.free);
  const VectorXd& values = parts.eigenvalues();
  const double floor = 1e-8 * std::max(1.0, values.lpNorm<Eigen::Infinity>());
  const VectorXd turned = parts.eigenvectors().transpose() * place.derivatives.gradient;
  const Theta step =
      parts.eigenvectors() * turned.cwiseQuotient(-values.cwiseAbs().cwiseMax(floor));
  return step * std::min(1.0, kLongestStep / step.lpNorm<Eigen::Infinity>());
}

class Search {
 public:
  explicit Search(const Likelihood& likelihood) : likelihood_(likelihood) {
    const PenalisedProblem& problem = likelihood.problem();
    if (likelihood.has_ridge()) {
      balance_ = std::log(problem.ridge.balance);
      low_[0] = balance_ - kHalfRange;
      high_[0] = balance_ + kHalfRange;
    }
    // Rows are whitened: ten digits below the assumed sigma is rounding.
    constexpr double kLeast = 1e-20;
    const double square = problem.response.squaredNorm();
    // The least too if there are no rows, which have no mean.
    most_noise_ = std::log(std::max(kLeast, square / static_cast<double>(problem.rows)));
    if (problem.noise.knowledge != NoiseKnowledge::exact) {
      // Noise below 1e-5 of the responses cannot be distinguished from the rounding of a leverage
      // near one.
      low_[1] = std::min(most_noise_ - kHalfRange, 0.0);
      high_[1] = std::max(most_noise_, 0.0) + 1.0;
    }
  }

  // A coarse scan, then Newton with a bounded step.
  tl::expected<Place, FitFailure> minimum() const {
    // V is of order one near its minimum; a gradient of 1e-7 moves theta by about 1e-7 of its sigma.
    constexpr double kLeastSlope = 1e-7;
    constexpr double kNegligible = 1e-10;  // of V
    constexpr double kNear = 1e-2;
    constexpr int kMostSteps = 100;
    const auto start = scan();
    if (!start) return rank_deficient();
    Place here = place_of(*start);
    bool goes_on = true;
    for (int count = 0; goes_on && here.slope() >= kLeastSlope; ++count) {
      if (count == kMostSteps) {
        return tl::unexpected(FitFailure{
            FitFailure::Reason::not_converged,
            fmt::format("the choice of smoothing did not settle in {} steps", kMostSteps)});
      }
      Theta step = newton_step(here);
      // V determines theta only to the square root of V's rounding, the gradient to its own: near the
      // minimum that counts too. Longer steps creep along a flat V or leave the minimum.
      const bool is_near = step.lpNorm<Eigen::Infinity>() <= kNear;
      goes_on = false;
      for (int halved = 0; halved < 20; ++halved, step *= 0.5) {
        const auto state = likelihood_.at(clamped(here.state.theta + step));
        if (!state) continue;
        Place there = place_of(*state);
        const double decrease = here.state.value - there.state.value;
        const bool refines = is_near && there.slope() < here.slope();
        if (!(decrease > 0.0 || refines)) continue;
        goes_on = decrease >= kNegligible || refines;
        here = std::move(there);
        break;
      }
    }
    return here;
  }

  // Points of the posterior with their weights, of sum 1: steps of one standard error outward from
  // the minimum while the density is above e^-4 of its peak, of lambda anew at each sigma2.
  std::vector<Node> posterior(const Place& minimum) const {
    constexpr double kNegligible = 4.0;
    const Theta steps = steps_about(minimum);
    std::vector<Node> nodes;
    double peak = -HUGE_VAL;  // densities are logarithms
    const auto along_lambda = [&](Theta& theta) {
      double best = -HUGE_VAL;
      outward(theta, 0, steps[0], [&](Theta& there) {
        const auto state = likelihood_.at(there);
        if (!state) return false;
        // The average always includes the prior, so that the posterior is proper; the fit includes it
        // on request.
        const double density = -0.5 * (state->value + likelihood_.left_out_slope().dot(there));
        if (density > best) {
          best = density;
          theta = there;
        }
        peak = std::max(peak, density);
        if (density < best - kNegligible) return false;
        nodes.push_back({*state, density});
        return true;
      });
      return best > peak - kNegligible;
    };
    outward(minimum.state.theta, 1, steps[1], along_lambda);
    std::erase_if(nodes, [&](const Node& node) { return node.weight <= peak - kNegligible; });
    double sum = 0.0;
    for (Node& node : nodes) {
      node.weight = std::exp(node.weight - peak);
      sum += node.weight;
    }
    for (Node& node : nodes) node.weight /= sum;
    return nodes;
  }

 private:
  // Ten decades either side of balance: beyond them the ridge (or the data) is below the other's
  // rounding.
  static constexpr double kHalfRange = 23.0;

  Theta clamped(const Theta& theta) const { return theta.cwiseMax(low_).cwiseMin(high_); }

  // Scans lambda over its range and, if sigma2 is unknown, sigma2 below the responses' variance.
  // Returns the best.
  std::optional<State> scan() const {
    const int steps = likelihood_.has_ridge() ? 5 : 0;
    const bool scans_noise = likelihood_.problem().noise.knowledge == NoiseKnowledge::unknown;
    std::optional<State> best;
    for (int i = 0; i < (scans_noise ? 4 : 1); ++i) {
      const double log_sigma2 = scans_noise ? most_noise_ - 5.0 * i : 0.0;
      for (int k = -steps; k <= steps; ++k) {
        auto state = likelihood_.at(clamped({balance_ + 3.0 * k - log_sigma2, log_sigma2}));
        if (state && (!best || state->value < best->value)) best = std::move(state);
      }
    }
    return best;
  }

  Place place_of(const State& state) const {
    Place place{state, likelihood_.derivatives(state)};
    for (Index i = 0; i < 2; ++i) {
      const double theta = state.theta[i];
      double& slope = place.derivatives.gradient[i];
      if (low_[i] == high_[i] || (theta <= low_[i] && slope > 0.0) ||
          (theta >= high_[i] && slope < 0.0)) {
        slope = place.free[i] = 0.0;
      }
    }
    return place;
  }

  // One standard error of each theta from the Hessian of V (twice the information), within the steps
  // that serve an average; the longest where lambda ends at a boundary.
  Theta steps_about(const Place& minimum) const {
    constexpr double kShortest = 0.2;
    constexpr double kLongest = 1.0;
    constexpr double kFlat = 1e-4;
    const Matrix2d& hessian = minimum.derivatives.hessian;
    // Far out V approaches its limit slowly: a flat gradient there is a boundary, not a minimum.
    const bool is_inside =
        minimum.free[0] != 0.0 && (hessian(0, 0) >= kFlat || minimum.state.theta[0] == balance_);
    const auto parts =
        curvatures(0.5 * hessian, {is_inside ? 1.0 : 0.0, low_[1] < high_[1] ? 1.0 : 0.0});
    // A flat direction would have an unbounded variance: ten decades of lambda are the limit.
    const VectorXd variance =
        parts.eigenvalues().cwiseMax(1.0 / (kHalfRange * kHalfRange)).cwiseInverse();
    const VectorXd square = parts.eigenvectors().cwiseAbs2() * variance;
    return square.cwiseSqrt().cwiseMax(kShortest).cwiseMin(kLongest);
  }

  // Visits `from`, then the places to either side as long as `visit` returns true. It may change
  // the other unknown for the places farther out.
  template <class Visit>
  void outward(Theta from, Index along, double step, const Visit& visit) const {
    for (const double way : {-step, step}) {
      Theta theta = from;
      for (int j = way < 0.0 ? 0 : 1;; ++j) {
        theta[along] = from[along] + way * j;
        if (theta[along] < low_[along] || theta[along] > high_[along] || !visit(theta)) break;
      }
    }
  }

  const Likelihood& likelihood_;
  double balance_ = 0.0;     // log lambda
  double most_noise_ = 0.0;  // log of the responses' mean square
  Theta low_ = Theta::Zero();
  Theta high_ = Theta::Zero();  // equal to low_ where there is nothing to search
};

PenalisedFit fit_at(const Likelihood& likelihood, const State& state) {
  const MatrixXd covariance = likelihood.covariance({{state, 1.0}}, state);
  return {.coefficients = likelihood.coefficients(state),
          .covariance = covariance,
          .corrected_covariance = covariance,
          .lambda = state.lambda(),
          .inverse_lambda = 1.0 / state.lambda(),
          .sigma2 = state.sigma2(),
          .edf = likelihood.edf(state),
          .minus_two_log_reml = state.value};
}

}  // namespace

tl::expected<PenalisedFit, FitFailure> fit_penalised(const PenalisedProblem& problem,
                                                     const FitOptions& options) {
  const Likelihood likelihood(problem, options.prior);
  if (likelihood.has_ridge() && !(problem.ridge.balance > 0.0)) return rank_deficient();
  const Search search(likelihood);
  const auto found = search.minimum();
  if (!found) return tl::unexpected(found.error());
  PenalisedFit fit = fit_at(likelihood, found->state);
  if (options.correct_covariance) {
    const auto nodes = search.posterior(*found);
    fit.corrected_covariance = likelihood.covariance(nodes, found->state);
    fit.inverse_lambda = 0.0;
    for (const Node& node : nodes) fit.inverse_lambda += node.weight / node.state.lambda();
  }
  return fit;
}

tl::expected<PenalisedFit, FitFailure> fit_with_smoothing(const PenalisedProblem& problem,
                                                          double lambda, double sigma2) {
  require(lambda > 0.0 && sigma2 > 0.0, "a fit with lambda {} and sigma2 {}; both are positive",
          lambda, sigma2);
  // At one lambda the ridge is a prior like any other, which spares the eigendecomposition where that
  // is accurate enough.
  const Ridge& ridge = problem.ridge;
  PenalisedProblem with_prior = problem;
  with_prior.ridge = {};
  with_prior.prior_precision.diagonal().tail(ridge.count).array() += lambda;
  for (const PenalisedProblem* one : {&std::as_const(with_prior), &problem}) {
    const Likelihood likelihood(*one, SmoothingPrior::none);
    auto state = likelihood.at({std::log(lambda), std::log(sigma2)});
    if (!state) continue;
    state->value -= static_cast<double>(ridge.count - one->ridge.count) * state->theta[0];
    return fit_at(likelihood, *state);
  }
  return rank_deficient();
}

tl::expected<VectorXd, FitFailure> held_out_residual(const Eigen::Ref<const VectorXd>& residual,
                                                     const Eigen::Ref<const MatrixXd>& spread,
                                                     double sigma2) {
  const Index m = residual.size();
  require(spread.rows() == m && spread.cols() == m,
          "{} held-out residuals with a spread of {} x {}", m, spread.rows(), spread.cols());
  const linear::Cholesky kept(MatrixXd::Identity(m, m) - spread / sigma2);
  // The rounding of the spread is about 1e-12.
  constexpr double kSmallestPivot = 1e-9;
  if (!kept.is_positive_definite() ||
      kept.lower().diagonal().array().square().minCoeff() < kSmallestPivot) {
    return tl::unexpected(FitFailure{FitFailure::Reason::rank_deficient,
                                     "the other points do not determine the fit without these"});
  }
  return kept.solve(residual);
}

}  // namespace chaintrue::interp

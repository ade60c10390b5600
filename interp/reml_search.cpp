// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "interp/linear_algebra.hpp"

namespace chaintrue::interp::reml {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Ten decades either side of balance: beyond them the ridge (or the data) is below the other's
// rounding.
constexpr double kHalfRange = 23.0;

Theta clamped(const Theta& theta, const Limits& limits) {
  return theta.cwiseMax(limits.low).cwiseMin(limits.high);
}

Limits limits_of(const Likelihood& likelihood) {
  Limits limits;
  if (likelihood.has_ridge()) {
    const double middle = std::log(likelihood.balance());
    limits.low[0] = middle - kHalfRange;
    limits.high[0] = middle + kHalfRange;
  }
  if (likelihood.noise() != NoiseKnowledge::exact) {
    // Noise below 1e-5 of the responses cannot be distinguished from the rounding of a leverage
    // near one.
    const double largest = std::log(likelihood.response_variance());
    limits.low[1] = std::min(largest - kHalfRange, 0.0);
    limits.high[1] = std::max(largest, 0.0) + 1.0;
  }
  return limits;
}

// Scans lambda over its range and, if sigma2 is unknown, sigma2 below the responses' variance; the
// best point starts the search.
std::optional<State> scan(const Likelihood& likelihood, const Limits& limits) {
  constexpr double kReach = 15.0;
  constexpr double kStep = 3.0;
  std::vector<double> log_sigma2 = {0.0};
  if (likelihood.noise() == NoiseKnowledge::unknown) {
    const double largest = std::log(likelihood.response_variance());
    log_sigma2 = {largest, largest - 5.0, largest - 10.0, largest - 15.0};
  }
  const double balance = 0.5 * (limits.low[0] + limits.high[0]);
  const double reach = likelihood.has_ridge() ? kReach : 0.0;
  std::optional<State> best;
  for (const double s : log_sigma2) {
    for (double offset = -reach; offset <= reach; offset += kStep) {
      auto state = likelihood.at(clamped({balance + offset - s, s}, limits));
      if (state && (!best || state->value < best->value)) best = std::move(state);
    }
  }
  return best;
}

// Fixed unknowns get a curvature of 1 and no coupling.
Matrix2d restricted(const Matrix2d& hessian, const Theta& free) {
  Matrix2d result = hessian.cwiseProduct(free * free.transpose());
  result.diagonal() += Theta::Ones() - free;
  return result;
}

// A state on the way to the minimum.
struct Place {
  Place(const Likelihood& likelihood, const Limits& limits, State at)
      : state(std::move(at)), derivatives(likelihood.derivatives(state)) {
    for (Index i = 0; i < 2; ++i) {
      double& slope = derivatives.gradient[i];
      if (limits.low[i] == limits.high[i] || (state.theta[i] <= limits.low[i] && slope > 0.0) ||
          (state.theta[i] >= limits.high[i] && slope < 0.0)) {
        slope = free[i] = 0.0;
      }
    }
  }
  double slope() const { return derivatives.gradient.lpNorm<Eigen::Infinity>(); }

  State state;
  Derivatives derivatives;     // the gradient of the free unknowns only
  Theta free = Theta::Ones();  // 0 for one that is given or that V presses against a limit
};

// Newton's step with the Hessian's eigenvalues made positive, no longer than kLongestStep.
Theta newton_step(const Place& place) {
  constexpr double kLongestStep = 4.0;
  const linear::SymmetricEigen solver(restricted(place.derivatives.hessian, place.free));
  const double floor = 1e-8 * std::max(1.0, solver.eigenvalues().lpNorm<Eigen::Infinity>());
  const VectorXd turned = solver.eigenvectors().transpose() * place.derivatives.gradient;
  const Theta step = -(solver.eigenvectors() *
                       turned.cwiseQuotient(solver.eigenvalues().cwiseAbs().cwiseMax(floor)));
  const double longest = step.lpNorm<Eigen::Infinity>();
  return longest > kLongestStep ? Theta(step * (kLongestStep / longest)) : step;
}

// Far out V approaches its limit slowly: a flat gradient there is a boundary, not a minimum.
bool ends_inside(double theta, double low, double high, double curvature) {
  constexpr double kFlat = 1e-4;
  return theta > low && theta < high && (curvature >= kFlat || theta == 0.5 * (low + high));
}

// One standard error of each theta from the Hessian of V (twice the information), within the steps
// that serve an average; the longest where lambda ends at a boundary.
Theta steps_of(const SearchResult& found) {
  constexpr double kShortest = 0.2;
  constexpr double kLongest = 1.0;
  const auto& [low, high] = found.limits;
  const Matrix2d& hessian = found.derivatives.hessian;
  const bool lambda_inside =
      low[0] < high[0] && ends_inside(found.state.theta[0], low[0], high[0], hessian(0, 0));
  const linear::SymmetricEigen solver(
      restricted(0.5 * hessian, {lambda_inside ? 1.0 : 0.0, low[1] < high[1] ? 1.0 : 0.0}));
  // A flat direction would have an unbounded variance: ten decades of lambda are the limit.
  const VectorXd variance =
      solver.eigenvalues().cwiseMax(1.0 / (kHalfRange * kHalfRange)).cwiseInverse();
  Theta sigma = (solver.eigenvectors().cwiseAbs2() * variance).cwiseSqrt();
  if (!lambda_inside) sigma[0] = kLongest;
  return sigma.cwiseMax(kShortest).cwiseMin(kLongest);
}

// Walks the posterior density.
class Walker {
 public:
  Walker(const Likelihood& likelihood, const SearchResult& found)
      : likelihood_(likelihood), found_(found), steps_(steps_of(found)) {}

  std::vector<Likelihood::Node> nodes() {
    outward(found_.state.theta, 1, [&](Theta& theta) {
      const Likelihood::Node best = along_lambda(theta);
      theta[0] = best.theta[0];
      return best.weight > peak_ - kNegligible;
    });
    return normalized();
  }

 private:
  static constexpr double kNegligible = 4.0;

  // Visits `from`, then the places to either side as long as `visit` returns true. It may change
  // the other unknown for the places farther out.
  template <class Visit>
  void outward(const Theta& from, Index along, const Visit& visit) const {
    constexpr int kMost = 60;
    for (const double direction : {-1.0, 1.0}) {
      Theta theta = from;
      for (int j = direction < 0.0 ? 0 : 1; j < kMost; ++j) {
        theta[along] = from[along] + direction * steps_[along] * j;
        if (theta[along] < found_.limits.low[along] || theta[along] > found_.limits.high[along] ||
            !visit(theta)) {
          break;
        }
      }
    }
  }

  // The node of the highest density. Weights are logarithms here.
  Likelihood::Node along_lambda(const Theta& from) {
    Likelihood::Node best{from, -kInfinity};
    outward(from, 0, [&](const Theta& theta) {
      const auto state = likelihood_.at(theta);
      if (!state) return false;
      // The average always includes the prior, so that the posterior is proper; the fit includes it
      // on request.
      const double missing = likelihood_.left_out_slope().dot(theta);
      const Likelihood::Node node{theta, -0.5 * (state->value + missing)};
      if (node.weight > best.weight) best = node;
      peak_ = std::max(peak_, node.weight);
      if (node.weight < best.weight - kNegligible) return false;
      nodes_.push_back(node);
      return true;
    });
    return best;
  }

  std::vector<Likelihood::Node> normalized() const {
    std::vector<Likelihood::Node> kept;
    double sum = 0.0;
    for (const Likelihood::Node& node : nodes_) {
      if (node.weight <= peak_ - kNegligible) continue;
      kept.push_back({node.theta, std::exp(node.weight - peak_)});
      sum += kept.back().weight;
    }
    for (Likelihood::Node& node : kept) node.weight /= sum;
    return kept;
  }

  const Likelihood& likelihood_;
  const SearchResult& found_;
  Theta steps_;
  double peak_ = -kInfinity;
  std::vector<Likelihood::Node> nodes_;
};

}  // namespace

tl::expected<SearchResult, FitReason> search(const Likelihood& likelihood) {
  // V is of order one near its minimum; a gradient of 1e-7 moves theta by about 1e-7 of its sigma.
  constexpr double kLeastSlope = 1e-7;
  constexpr double kNegligible = 1e-10;  // of V
  constexpr double kNear = 1e-2;
  const auto rank_deficient = tl::unexpected(FitReason::rank_deficient);
  if (likelihood.has_ridge() && !(likelihood.balance() > 0.0)) return rank_deficient;
  const Limits limits = limits_of(likelihood);
  auto start = scan(likelihood, limits);
  if (!start) return rank_deficient;
  Place here(likelihood, limits, *std::move(start));
  bool goes_on = true;
  for (int count = 0; goes_on && here.slope() >= kLeastSlope; ++count) {
    if (count == kMostSteps) return tl::unexpected(FitReason::not_converged);
    Theta step = newton_step(here);
    // V determines theta only to the square root of V's rounding, the gradient to its own: near the
    // minimum that counts too. Longer steps creep along a flat V or leave the minimum.
    const bool is_near = step.lpNorm<Eigen::Infinity>() <= kNear;
    goes_on = false;
    for (int halved = 0; halved < 20; ++halved, step *= 0.5) {
      auto state = likelihood.at(clamped(here.state.theta + step, limits));
      if (!state) continue;
      Place there(likelihood, limits, *std::move(state));
      const double decrease = here.state.value - there.state.value;
      const bool refines = is_near && there.slope() < here.slope();
      if (!(decrease > 0.0 || refines)) continue;
      goes_on = decrease >= kNegligible || refines;
      here = std::move(there);
      break;
    }
  }
  return SearchResult{limits, std::move(here.state), here.derivatives};
}

std::vector<Likelihood::Node> posterior_nodes(const Likelihood& likelihood,
                                              const SearchResult& found) {
  return Walker(likelihood, found).nodes();
}

}  // namespace chaintrue::interp::reml

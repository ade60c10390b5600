// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/taped_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::belts {

namespace {

/// Anchors and the logarithm of the scale.
Eigen::VectorXd frame_vector(const FrameState& state) {
  Eigen::VectorXd x(kFrameUnknowns);
  x << state.anchors, state.log_scale;
  return x;
}

/// r_b.
Eigen::VectorXd about_the_known(const KnownFrame& known,
                                const TapedRows& rows,
                                const FrameState& state) {
  return rows.residual_mm + rows.by_frame * (frame_vector(state) - frame_vector(known.state));
}

}  // namespace

TapedMarginal marginal(const KnownFrame& known, const TapedState& at) {
  TapedMarginal result;
  result.counting = at.counting;
  result.residual_mm = about_the_known(known, at.rows, at.frame);
  const linear::Cholesky covariance(taped_covariance(at.rows, at.noise, at.counting) +
                                    linear::carried(at.rows.by_frame, known.covariance));
  result.inverse = covariance.inverse();
  result.log_likelihood =
      -0.5 * (result.residual_mm.dot(linear::product(result.inverse, result.residual_mm)) +
              covariance.log_det());
  return result;
}

namespace {

/// The fewest degrees of freedom of any set's stated noise.
double noise_dof(const std::vector<BeltHoles>& sets) {
  double least = sets.front().set.noise_dof;
  for (const BeltHoles& set : sets) least = std::min(least, set.set.noise_dof);
  return least;
}

/// Log density of a scaled inverse chi square about one.
double log_prior(double factor, double dof) {
  return -dof * std::log(factor) - 0.5 * dof / (factor * factor);
}

double extent_mm(const std::vector<model::MarkPoint>& marks) {
  double widest = 0.0;
  for (const model::MarkPoint& a : marks) {
    for (const model::MarkPoint& b : marks)
      widest = std::max(widest, std::hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm));
  }
  return widest;
}

/// The likeliest noise on the grid, and the evidence summed over the grid.
struct Chosen {
  TapedNoise noise;
  double best = kMinusInfinity;
  std::vector<double> all;

  void see(const TapedNoise& candidate, double log_posterior) {
    all.push_back(log_posterior);
    if (log_posterior <= best) return;
    best = log_posterior;
    noise = candidate;
  }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (const double one : all) sum += std::exp(one - best);
    return best + std::log(sum / as_double(all.size()));
  }
};

TapedNoise likeliest_noise(const KnownFrame& known, TapedState at, double dof) {
  // A factor of 1.19 a step, from 0.6 to 4: with fifteen degrees of freedom one sigma is 1.2.
  constexpr double kStep = 0.175;
  constexpr int kFirst = -3;
  constexpr int kLast = 8;
  // From below a tape's resolution to the effect of belts that stretch by half a per cent.
  constexpr double kSizesMm[] = {0.2, 0.4, 0.8, 1.6, 3.2, 6.4};
  // Share of the distance between the outermost holes: below a quarter nine holes do not determine
  // it.
  constexpr double kReaches[] = {0.25, 0.5, 1.0};
  const double extent = extent_mm(at.rows.marks);
  Chosen without;
  Chosen with;
  for (int step = kFirst; step <= kLast; ++step) {
    const double factor = std::exp(kStep * step);
    const double prior = log_prior(factor, dof);
    const auto worth = [&](const TapedNoise& noise) {
      at.noise = noise;
      return prior + marginal(known, at).log_likelihood;
    };
    const TapedNoise none{factor, 0.0, 1.0};
    without.see(none, worth(none));
    for (const double size : kSizesMm) {
      for (const double reach : kReaches) {
        const TapedNoise smooth{factor, size, reach * extent};
        with.see(smooth, worth(smooth));
      }
    }
  }
  return with.mean() - without.mean() > estimation::kSurfaceEvidence ? with.noise : without.noise;
}

/// Moves the state to the minimum with fixed noise, by Gauss-Newton:
///
///   x = x_b + S_b J' (C + J S_b J')^-1 r_b                                                  (4)
///
/// False if it does not converge.
bool converge(const KnownFrame& known, const std::vector<BeltHoles>& sets, TapedState& state) {
  constexpr int kMostPasses = 20;
  // Step of the anchors, mm: a thousandth of the best tape's accuracy.
  constexpr double kConvergedMm = 1e-5;
  const Eigen::MatrixXd covariance = taped_covariance(state.rows, state.noise, state.counting);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const Eigen::MatrixXd& by_frame = state.rows.by_frame;
    const Eigen::MatrixXd gain = linear::product(known.covariance, linear::transposed(by_frame));
    const linear::PivotedCholesky whole(covariance + linear::product(by_frame, gain));
    const Eigen::VectorXd x =
        frame_vector(known.state) +
        linear::product(gain, whole.solve(about_the_known(known, state.rows, state.frame)));
    const double moved_mm =
        (x.head<kAnchorUnknowns>() - state.frame.anchors).lpNorm<Eigen::Infinity>();
    state.frame.anchors = x.head<kAnchorUnknowns>();
    state.frame.log_scale = x[kAnchorUnknowns];
    auto rows = taped_rows(sets, state.frame.anchors, state.frame.log_scale);
    if (!rows) return false;
    state.rows = *std::move(rows);
    if (moved_mm < kConvergedMm) return true;
  }
  return false;
}

/// The worst distance beyond kBadDistanceSigmas; empty if all fit.
std::optional<std::size_t> worst_of(const KnownFrame& known, const TapedState& state) {
  const TapedMarginal now = marginal(known, state);
  std::optional<std::size_t> worst;
  double most = estimation::kBadDistanceSigmas;
  for (std::size_t k = 0; k < state.counting.size(); ++k) {
    const auto row = as_index(k);
    const double sigmas = std::abs(now.left_out_mm(row)) / now.left_out_sigma_mm(row);
    if (!state.counting[k] || sigmas <= most) continue;
    most = sigmas;
    worst = k;
  }
  return worst;
}

}  // namespace

std::optional<TapedState> converged_state(const KnownFrame& known,
                                          const std::vector<BeltHoles>& sets) {
  auto rows = taped_rows(sets, known.state.anchors, known.state.log_scale);
  if (!rows) return std::nullopt;
  TapedState state{known.state, *std::move(rows), {}, {}};
  state.counting.assign(as_size(state.rows.residual_mm.size()), true);
  const double dof = noise_dof(sets);
  if (!converge(known, sets, state)) return std::nullopt;
  const auto most = static_cast<std::size_t>(as_double(state.counting.size()) / 3.0);
  for (std::size_t rejected = 0; rejected <= most; ++rejected) {
    state.noise = likeliest_noise(known, state, dof);
    if (!converge(known, sets, state)) return std::nullopt;
    const auto worst = worst_of(known, state);
    if (!worst) return state;
    state.counting[*worst] = false;
    if (!converge(known, sets, state)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid::belts

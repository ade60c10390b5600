// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/taped_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::belts {

TapedMarginal marginal(const HolesEstimate& frame,
                  const std::vector<BeltHoles>& sets,
                  const TapedState& at,
                  const TapedNoise& noise,
                  const std::vector<bool>& counting) {
  TapedMarginal result;
  result.counting = counting;
  result.residual_mm = frame.about_the_belts(at.rows, at.frame);
  const linear::Cholesky covariance(
      taped_covariance(sets, at.rows, noise, counting) +
      linear::carried(at.rows.by_frame, at.without_holes.covariance));
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

TapedNoise likeliest_noise(const HolesEstimate& frame,
                           const std::vector<BeltHoles>& sets,
                           const TapedState& at,
                           double dof) {
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
      return prior + marginal(frame, sets, at, noise, at.counting).log_likelihood;
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

/// Iterates with fixed noise; false if it does not converge.
bool converge(const HolesEstimate& frame, const std::vector<BeltHoles>& sets, TapedState& state) {
  const auto there = frame.converged(
      state.frame, taped_covariance(sets, state.rows, state.noise, state.counting));
  if (!there) return false;
  auto rows = taped_rows(sets, there->anchors, there->log_scale);
  if (!rows) return false;
  state.without_holes = frame.without_holes(*there);
  state.frame = *there;
  state.rows = *std::move(rows);
  return true;
}

/// The worst distance beyond kBadDistanceSigmas; empty if all fit.
std::optional<std::size_t> worst_of(const HolesEstimate& frame,
                                    const std::vector<BeltHoles>& sets,
                                    const TapedState& state) {
  const TapedMarginal now = marginal(frame, sets, state, state.noise, state.counting);
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

std::optional<TapedState> converged_state(const HolesEstimate& frame,
                                     const std::vector<BeltHoles>& sets) {
  const FrameState& first = frame.alone().state;
  auto rows = taped_rows(sets, first.anchors, first.log_scale);
  if (!rows) return std::nullopt;
  TapedState state{first, *std::move(rows), {}, {}, {}};
  state.counting.assign(as_size(state.rows.residual_mm.size()), true);
  const double dof = noise_dof(sets);
  if (!converge(frame, sets, state)) return std::nullopt;
  const auto most = static_cast<std::size_t>(as_double(state.counting.size()) / 3.0);
  for (std::size_t rejected = 0; rejected <= most; ++rejected) {
    state.noise = likeliest_noise(frame, sets, state, dof);
    if (!converge(frame, sets, state)) return std::nullopt;
    const auto worst = worst_of(frame, sets, state);
    if (!worst) return state;
    state.counting[*worst] = false;
    if (!converge(frame, sets, state)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid::belts

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_and_holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/failed.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::belts {
namespace {

/// The prior without the holes: x_b and S_b (6 x 6).
struct KnownFrame {
  FrameState state;
  MatrixXd covariance;
};

/// The state of the fit. The places of belts' points are not moved.
struct TapedState {
  FrameState frame;
  TapedRows rows;
  TapedNoise noise;
  Flags counting;
};

/// (2) and (3) about a state.
struct TapedMarginal {
  VectorXd residual_mm;  ///< r_b
  MatrixXd inverse;      ///< V^-1
  double log_likelihood = 0.0;
  Flags counting;

  double left_out_mm(Index k) const { return (inverse.row(k) * residual_mm)(0) / inverse(k, k); }
  /// The tape's variance plus that of the prediction, without what was added for rejection.
  double left_out_sigma_mm(Index k) const {
    const double added = counting[as_size(k)] ? 0.0 : kRejectedMm2;
    return std::sqrt(1.0 / inverse(k, k) - added);
  }
};

/// Anchors and the logarithm of the scale.
VectorXd frame_vector(const FrameState& state) {
  VectorXd x(kFrameUnknowns);
  x << state.anchors, state.log_scale;
  return x;
}

/// r_b.
VectorXd about_the_known(const KnownFrame& known, const TapedRows& rows, const FrameState& state) {
  return rows.residual_mm + rows.by_frame * (frame_vector(state) - frame_vector(known.state));
}

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

/// The fewest degrees of freedom of any set's stated noise.
double noise_dof(const std::vector<BeltHoles>& sets) {
  const auto dof = [](const BeltHoles& set) { return set.set.noise_dof; };
  return dof(*min_element(sets, ascending(dof)));
}

/// Log density of a scaled inverse chi square about one.
double log_prior(double factor, double dof) {
  return -dof * std::log(factor) - 0.5 * dof / (factor * factor);
}

double extent_mm(const std::vector<MarkPoint>& marks) {
  double widest = 0.0;
  for (const MarkPoint& a : marks) {
    for (const MarkPoint& b : marks) widest = std::max(widest, distance_mm(a, b));
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
  double mean() const { return log_sum(all) - std::log(as_double(all.size())); }
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
  const MatrixXd covariance = taped_covariance(state.rows, state.noise, state.counting);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const MatrixXd& by_frame = state.rows.by_frame;
    const MatrixXd gain = linear::product(known.covariance, linear::transposed(by_frame));
    const linear::PivotedCholesky whole(covariance + linear::product(by_frame, gain));
    const VectorXd x =
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
  for (const auto k : each_index(state.counting)) {
    const auto row = as_index(k);
    const double sigmas = std::abs(now.left_out_mm(row)) / now.left_out_sigma_mm(row);
    if (!state.counting[k] || sigmas <= most) continue;
    most = sigmas;
    worst = k;
  }
  return worst;
}

/// Empty if it does not converge, or if rejecting a third of the distances is not enough.
std::optional<TapedState> converged_state(const KnownFrame& known,
                                          const std::vector<BeltHoles>& sets) {
  auto rows = taped_rows(sets, known.state.anchors, known.state.log_scale);
  if (!rows) return std::nullopt;
  TapedState state{known.state, *std::move(rows), {}, {}};
  state.counting.assign(as_size(state.rows.residual_mm.size()), true);
  const double dof = noise_dof(sets);
  for (std::size_t rejected = 0; rejected <= state.counting.size() / 3; ++rejected) {
    if (!converge(known, sets, state)) return std::nullopt;
    state.noise = likeliest_noise(known, state, dof);
    if (!converge(known, sets, state)) return std::nullopt;
    const auto worst = worst_of(known, state);
    if (!worst) return state;
    state.counting[*worst] = false;
  }
  return std::nullopt;
}

}  // namespace
}  // namespace chaintrue::grid::belts

namespace chaintrue::grid {

namespace {

using belts::kFrameUnknowns;
using belts::KnownFrame;
using belts::TapedMarginal;
using belts::TapedState;

/// `frame` is the belts' own fit, and `fit` its report; both move to the state.
void fill_frame(const MeasuredBelts& measured, const KnownFrame& known, const TapedState& state,
                const MatrixXd& covariance, AnchorFit frame, BeltsFit& fit) {
  fit.machine = with_anchors(measured.machine, state.frame.anchors);
  fit.covariance_mm2 = covariance.topLeftCorner<5, 5>();
  for (const auto i : each_index(fit.coordinates)) {
    const auto row = as_index(i);
    AnchorCoordinate& coordinate = fit.coordinates[i];
    coordinate.fitted_mm = state.frame.anchors[row];
    coordinate.sigma_mm = std::sqrt(covariance(row, row));
    // The belts' share of its variance; the rest is the tape's.
    const double alone = known.covariance(row, row);
    for (const Belt belt : kBelts) coordinate.variance_share[belt] *= covariance(row, row) / alone;
  }
  fit.scale = scale_of(state.frame, covariance);
  if (measured.points.empty()) return;
  frame.state = state.frame;
  place_all(measured, frame);
  const FitDiagnostics view(measured, frame);
  const belts::FitResiduals& there = view.equations();
  for (const auto k : each_index(fit.places)) {
    fit.places[k].at = frame.state.places[k];
    for (const Belt belt : kBelts)
      fit.places[k].belts[belt].residual_mm = there.residual_mm[belts::row_of(k, belt)];
  }
  // The factor found from the uncorrected readings is kept after correcting for causes.
  if (fit.causes.empty())
    fit.rms_mm = rms(std::vector<double>(there.residual_mm.begin(), there.residual_mm.end()));
  fit.scale->residuals_mm = there.distance_residual_mm;
}

/// Covariance of x and, if present, of the displacement at its places; and the displacement.
MatrixXd posterior(const KnownFrame& known, const TapedState& state,
                   std::optional<DisplacementParts>& displacement) {
  const MatrixXd& g = state.rows.by_mark;
  const bool smooth = state.noise.size_mm > 0.0;
  const Index moved = smooth ? g.cols() : 0;
  MatrixXd prior = MatrixXd::Zero(kFrameUnknowns + moved, kFrameUnknowns + moved);
  prior.topLeftCorner<kFrameUnknowns, kFrameUnknowns>() = known.covariance;
  MatrixXd by_unknown(g.rows(), kFrameUnknowns + moved);
  by_unknown.leftCols<kFrameUnknowns>() = state.rows.by_frame;
  if (smooth) {
    const MatrixXd kernel =
        displacement_kernel(state.rows.marks, state.rows.marks, state.noise.reach_mm);
    for (const Index axis : {0, 1}) {
      const auto own = Eigen::seq(kFrameUnknowns + axis, Eigen::last, Eigen::fix<2>);
      prior(own, own) = state.noise.size_mm * state.noise.size_mm * kernel;
    }
    by_unknown.rightCols(moved) = g;
  }
  const TapedMarginal now = marginal(known, state);
  const MatrixXd cross = linear::product(prior, linear::transposed(by_unknown));
  if (smooth) {
    const VectorXd mean = linear::product(cross, linear::product(now.inverse, now.residual_mm));
    displacement = DisplacementParts{state.noise.size_mm, state.noise.reach_mm, state.rows.marks,
                                     mean.tail(moved)};
  }
  return prior - linear::carried(cross, now.inverse);
}

/// Placement of the first set's sheet by its edges.
std::optional<Vector3d> sheet_by_edges(const TapedState& state, const MeasuredHoles& first) {
  const observation::SheetPrior measured = observation::sheet_measured(first);
  if (!measured.knows_x || !measured.knows_y || !measured.knows_rotation) return std::nullopt;
  const MatrixXd c = taped_covariance(state.rows, state.noise, state.counting);
  const auto own = std::ssize(first.distances);
  const VectorXd weighed = linear::Cholesky(c).solve(state.rows.residual_mm).head(own);
  const Vector3d along = state.rows.by_sheet.topRows(own).transpose() * weighed;
  return observation::kSheetByEdges.sigma().cwiseAbs2().cwiseProduct(along);
}

void fill_distances(const KnownFrame& known, const std::vector<BeltHoles>& sets,
                    const TapedState& state, HolesWithBelts& found) {
  const TapedMarginal now = marginal(known, state);
  std::vector<double> left_out;
  Index row = 0;
  for (const auto s : each_index(sets)) {
    for (const HoleDistance& distance : sets[s].set.distances) {
      BeltTapedDistance one{s,
                            words_of(sets[s].set, distance),
                            length_of(sets[s].set, distance),
                            state.rows.residual_mm[row],
                            now.left_out_mm(row),
                            now.left_out_sigma_mm(row),
                            !state.counting[as_size(row)]};
      if (!one.rejected) left_out.push_back(one.left_out_mm);
      found.distances.push_back(std::move(one));
      ++row;
    }
  }
  found.left_out_rms_mm = rms(left_out);
  const MeasuredHoles& first = sets.front().set;
  for (const auto i : each_index(first.holes))
    found.holes.push_back({first.holes[i].name, first.holes[i].commanded, state.rows.marks[i]});
}

/// \throws std::invalid_argument if there is nothing to fit; fails for too many distances.
std::optional<BeltsFitFailure> refused(const MeasuredBelts& measured,
                                       const std::vector<BeltHoles>& sets) {
  using Reason = BeltsFitFailure::Reason;
  std::size_t count = 0;
  for (const BeltHoles& set : sets) count += set.set.distances.size();
  if (count == 0) throw precondition("{} sets of holes without a distance", sets.size());
  if (measured.points.empty() && !measured.machine.anchors_known)
    throw precondition("holes of a machine of which no anchor is known");
  if (count > kMostTapedByBelts) {
    return BeltsFitFailure{Reason::too_many_distances,
                           fmt::format("{} distances are too many for a fit with belts (at most "
                                       "{}): leave some out, evenly over the sheet",
                                       count, kMostTapedByBelts)};
  }
  return std::nullopt;
}

/// The anchors from the belts alone; a scale that they leave open has its prior.
KnownFrame known_frame(const BeltsByThemselves& alone) {
  MatrixXd covariance = MatrixXd::Zero(kFrameUnknowns, kFrameUnknowns);
  covariance(kAnchorUnknowns, kAnchorUnknowns) = kBeltScaleSigma * kBeltScaleSigma;
  covariance.topLeftCorner(alone.covariance.rows(), alone.covariance.cols()) = alone.covariance;
  return {alone.frame.state, std::move(covariance)};
}

}  // namespace

tl::expected<BeltsByThemselves, BeltsFitFailure> fit_by_themselves(const MeasuredBelts& measured) {
  if (measured.points.empty()) {
    BeltsByThemselves stated;
    stated.frame.state.anchors = anchors_of(measured.machine);
    stated.covariance =
        kStatedAnchorMm * kStatedAnchorMm * MatrixXd::Identity(kAnchorUnknowns, kAnchorUnknowns);
    stated.fit.machine = measured.machine;
    for (const auto i : each_index(stated.fit.coordinates)) {
      stated.fit.coordinates[i].name = belts::kCoordinateNames[i];
      stated.fit.coordinates[i].stated_mm = stated.frame.state.anchors[as_index(i)];
    }
    return stated;
  }
  auto fit = fit_belts(measured);
  if (!fit) return failed(fit);
  auto frame = belts::fit_anchors_robustly(measured);
  MatrixXd covariance = FitDiagnostics(measured, *frame).covariance();
  return BeltsByThemselves{*std::move(fit), *std::move(frame), std::move(covariance)};
}

tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_belts_and_holes(
    const MeasuredBelts& measured, const std::vector<BeltHoles>& sets, BeltsByThemselves alone) {
  if (auto failure = refused(measured, sets)) return tl::unexpected(*std::move(failure));
  const KnownFrame known = known_frame(alone);
  const auto state = belts::converged_state(known, sets);
  if (!state) {
    return failed(BeltsFitFailure::Reason::tape_contradicts,
                  "more than a third of the distances contradict the belts or each other: check "
                  "the anchors in force when the holes were cut, which holes the distances join, "
                  "and the tape's hook offset");
  }
  BeltsAndHolesFit fit{std::move(alone.fit), {}};
  fit.holes.covariance = posterior(known, *state, fit.holes.displacement);
  fit.holes.machine = sets.front().machine;
  fit.holes.noise_factor = state->noise.factor;
  fit.holes.sheet = sheet_by_edges(*state, sets.front().set);
  fill_distances(known, sets, *state, fit.holes);
  fill_frame(measured, known, *state, fit.holes.covariance, std::move(alone.frame), fit.belts);
  return fit;
}

tl::expected<BeltsAndHolesFit, BeltsFitFailure> fit_belts_and_holes(
    const MeasuredBelts& measured, const std::vector<BeltHoles>& sets) {
  return fit_by_themselves(measured).and_then([&](BeltsByThemselves alone) {
    return fit_belts_and_holes(measured, sets, std::move(alone));
  });
}

}  // namespace chaintrue::grid

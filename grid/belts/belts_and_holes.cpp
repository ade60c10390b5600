// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belts_and_holes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/belts/taped_state.hpp"
#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/precondition.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {

using model::Belt;
using model::kBelts;

namespace {

using belts::kAnchorUnknowns;
using belts::kFrameUnknowns;
using belts::KnownFrame;
using belts::TapedMarginal;
using belts::TapedState;

/// `frame` is the belts' own fit, and `fit` its report; both move to the state.
void fill_frame(const MeasuredBelts& measured,
                const KnownFrame& known,
                const TapedState& state,
                const Eigen::MatrixXd& covariance,
                belts::AnchorFit frame,
                BeltsFit& fit) {
  fit.machine = belts::with_anchors(measured.machine, state.frame.anchors);
  fit.covariance_mm2 = covariance.topLeftCorner<5, 5>();
  for (std::size_t i = 0; i < fit.coordinates.size(); ++i) {
    const auto row = as_index(i);
    AnchorCoordinate& coordinate = fit.coordinates[i];
    coordinate.fitted_mm = state.frame.anchors[row];
    coordinate.sigma_mm = std::sqrt(covariance(row, row));
    // The belts' share of its variance; the rest is the tape's.
    const double alone = known.covariance(row, row);
    for (const Belt belt : kBelts) coordinate.variance_share[belt] *= covariance(row, row) / alone;
  }
  BeltScale scale;
  scale.factor = std::exp(state.frame.log_scale);
  scale.sigma = scale.factor * std::sqrt(covariance(kAnchorUnknowns, kAnchorUnknowns));
  if (fit.scale) scale.residuals_mm = fit.scale->residuals_mm;
  fit.scale = std::move(scale);
  if (measured.points.empty()) return;
  frame.state = state.frame;
  belts::place_all(measured, frame);
  const belts::FitDiagnostics view(measured, frame);
  const belts::FitResiduals& there = view.equations();
  for (std::size_t k = 0; k < fit.places.size(); ++k) {
    fit.places[k].at = frame.state.places[k];
    for (const Belt belt : kBelts)
      fit.places[k].belts[belt].residual_mm = there.residual_mm[belts::row_of(k, belt)];
  }
  // The factor found from the uncorrected readings is kept after correcting for causes.
  if (fit.causes.empty())
    fit.rms_mm = rms(std::vector<double>(there.residual_mm.begin(), there.residual_mm.end()));
  if (!fit.scale || measured.distances.empty()) return;
  for (std::size_t i = 0; i < measured.distances.size(); ++i) {
    fit.scale->residuals_mm[i] =
        there.distance_residual[as_index(i)] * measured.distances[i].sigma_mm;
  }
}

/// Covariance of x and, if present, of the displacement at its places; and the displacement.
Eigen::MatrixXd posterior(const KnownFrame& known,
                          const TapedState& state,
                          std::optional<DisplacementParts>& displacement) {
  const Eigen::MatrixXd& g = state.rows.by_mark;
  const bool smooth = state.noise.size_mm > 0.0;
  const Eigen::Index moved = smooth ? g.cols() : 0;
  Eigen::MatrixXd prior = Eigen::MatrixXd::Zero(kFrameUnknowns + moved, kFrameUnknowns + moved);
  prior.topLeftCorner<kFrameUnknowns, kFrameUnknowns>() = known.covariance;
  Eigen::MatrixXd by_unknown(g.rows(), kFrameUnknowns + moved);
  by_unknown.leftCols<kFrameUnknowns>() = state.rows.by_frame;
  if (smooth) {
    const Eigen::MatrixXd kernel =
        displacement_kernel(state.rows.marks, state.rows.marks, state.noise.reach_mm);
    for (Eigen::Index i = 0; i < kernel.rows(); ++i) {
      for (Eigen::Index j = 0; j < kernel.cols(); ++j) {
        const double shared = state.noise.size_mm * state.noise.size_mm * kernel(i, j);
        prior.block<2, 2>(kFrameUnknowns + 2 * i, kFrameUnknowns + 2 * j) =
            shared * Eigen::Matrix2d::Identity();
      }
    }
    by_unknown.rightCols(moved) = g;
  }
  const TapedMarginal now = marginal(known, state);
  const Eigen::MatrixXd cross = linear::product(prior, linear::transposed(by_unknown));
  if (smooth) {
    const Eigen::VectorXd mean =
        linear::product(cross, linear::product(now.inverse, now.residual_mm));
    displacement = DisplacementParts{
        state.noise.size_mm, state.noise.reach_mm, state.rows.marks, mean.tail(moved)};
  }
  return prior - linear::carried(cross, now.inverse);
}

/// Placement of the first set's sheet by its edges.
std::optional<Eigen::Vector3d> sheet_by_edges(const TapedState& state, const MeasuredHoles& first) {
  const observation::SheetPrior measured = observation::sheet_measured(first);
  if (!measured.knows_x || !measured.knows_y || !measured.knows_rotation) return std::nullopt;
  const Eigen::MatrixXd c = belts::taped_covariance(state.rows, state.noise, state.counting);
  const auto own = std::ssize(first.distances);
  const Eigen::VectorXd weighed = linear::Cholesky(c).solve(state.rows.residual_mm).head(own);
  const Eigen::Vector3d along = state.rows.by_sheet.topRows(own).transpose() * weighed;
  return belts::sheet_variance().cwiseProduct(along);
}

void fill_distances(const KnownFrame& known,
                    const std::vector<BeltHoles>& sets,
                    const TapedState& state,
                    HolesWithBelts& found) {
  const TapedMarginal now = marginal(known, state);
  std::vector<double> left_out;
  Eigen::Index row = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
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
  for (std::size_t i = 0; i < first.holes.size(); ++i)
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
                                       count,
                                       kMostTapedByBelts)};
  }
  return std::nullopt;
}

/// The anchors from the belts alone; a scale that they leave open has its prior.
KnownFrame known_frame(const BeltsByThemselves& alone) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kFrameUnknowns, kFrameUnknowns);
  covariance(kAnchorUnknowns, kAnchorUnknowns) = kBeltScaleSigma * kBeltScaleSigma;
  covariance.topLeftCorner(alone.covariance.rows(), alone.covariance.cols()) = alone.covariance;
  return {alone.frame.state, std::move(covariance)};
}

}  // namespace

tl::expected<BeltsByThemselves, BeltsFitFailure> fit_by_themselves(const MeasuredBelts& measured) {
  if (measured.points.empty()) {
    BeltsByThemselves stated;
    stated.frame.state.anchors = belts::anchors_of(measured.machine);
    stated.covariance = kStatedAnchorMm * kStatedAnchorMm *
                        Eigen::MatrixXd::Identity(kAnchorUnknowns, kAnchorUnknowns);
    stated.fit.machine = measured.machine;
    for (std::size_t i = 0; i < stated.fit.coordinates.size(); ++i) {
      stated.fit.coordinates[i].name = belts::kCoordinateNames[i];
      stated.fit.coordinates[i].stated_mm = stated.frame.state.anchors[as_index(i)];
    }
    return stated;
  }
  auto fit = fit_belts(measured);
  if (!fit) return tl::unexpected(fit.error());
  auto frame = belts::fit_anchors_robustly(measured);
  Eigen::MatrixXd covariance = belts::FitDiagnostics(measured, *frame).covariance();
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/holes_estimate.hpp"

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/belts_and_holes.hpp"
#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"
#include "model/belts/belt_mechanism.hpp"

namespace chaintrue::grid::belts {
namespace {

Eigen::VectorXd frame_vector(const FrameState& state) {
  Eigen::VectorXd x(kFrameUnknowns);
  x << state.anchors, state.log_scale;
  return x;
}

}  // namespace

Eigen::MatrixXd taped_covariance(const std::vector<BeltHoles>& sets,
                                 const TapedRows& rows,
                                 const TapedNoise& noise,
                                 const std::vector<bool>& counting) {
  const Eigen::Index count = rows.residual_mm.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  Eigen::Index row = 0;
  Eigen::Index hole = 0;
  for (const BeltHoles& set : sets) {
    const auto own = std::ssize(set.set.distances);
    const auto holes = std::ssize(set.set.holes);
    HoleRows part;
    part.residual_mm = rows.residual_mm.segment(row, own);
    part.by_mark = rows.by_mark.block(row, 2 * hole, own, 2 * holes);
    part.by_size = rows.by_size.middleRows(row, own);
    part.by_sheet = rows.by_sheet.middleRows(row, own);
    covariance.block(row, row, own, own) = hole_covariance(set, part, noise.factor);
    row += own;
    hole += holes;
  }
  if (noise.size_mm > 0.0) {
    const Eigen::MatrixXd kernel = displacement_kernel(rows.marks, rows.marks, noise.reach_mm);
    for (const Eigen::Index axis : {0, 1}) {
      const Eigen::MatrixXd by_axis =
          rows.by_mark(Eigen::all, Eigen::seq(axis, Eigen::last, Eigen::fix<2>));
      covariance += noise.size_mm * noise.size_mm * linear::carried(by_axis, kernel);
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!counting[as_size(k)]) covariance(k, k) += kRejectedMm2;
  }
  return covariance;
}

HolesEstimate::HolesEstimate(const MeasuredBelts& belts,
                             const std::vector<BeltHoles>& sets,
                             AnchorFit alone,
                             KnownFrame known)
    : belts_(belts), sets_(sets), alone_(std::move(alone)), known_(std::move(known)) {}

WithoutHoles HolesEstimate::without_holes(const FrameState& state) const {
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(kFrameUnknowns, kFrameUnknowns);
  precision(kAnchorUnknowns, kAnchorUnknowns) = 1.0 / (kBeltScaleSigma * kBeltScaleSigma);
  WithoutHoles result;
  if (belts_.points.empty()) {
    precision.diagonal().head<kAnchorUnknowns>().setConstant(1.0 /
                                                             (kStatedAnchorMm * kStatedAnchorMm));
  } else {
    AnchorFit there = alone_;
    there.state = state;
    result.view.emplace(belts_, there);
    if (known_) {
      result.covariance = *known_;
      return result;
    }
    const Eigen::MatrixXd& own = result.view->precision();
    precision.topLeftCorner(own.rows(), own.cols()) += own;
  }
  result.covariance = linear::PivotedCholesky(precision).inverse();
  return result;
}

Eigen::VectorXd HolesEstimate::about_the_belts(const TapedRows& rows,
                                               const FrameState& state) const {
  return rows.residual_mm + rows.by_frame * (frame_vector(state) - frame_vector(alone_.state));
}

/// The same minimum by Gauss-Newton: S_b represents the belts, with six unknowns and no places.
///
///   x = x_b + S_b J' (C + J S_b J')^-1 r_b                                                  (4)
std::optional<FrameState> HolesEstimate::converged_about_known(
    FrameState state, const Eigen::MatrixXd& covariance) const {
  constexpr int kMostPasses = 20;
  // Step of the anchors, mm: a thousandth of the best tape's accuracy.
  constexpr double kConvergedMm = 1e-5;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const auto rows = taped_rows(sets_, state.anchors, state.log_scale);
    if (!rows) return std::nullopt;
    const Eigen::MatrixXd gain = linear::product(*known_, linear::transposed(rows->by_frame));
    const linear::PivotedCholesky whole(covariance + linear::product(rows->by_frame, gain));
    const Eigen::VectorXd change =
        linear::product(gain, whole.solve(about_the_belts(*rows, state)));
    const AnchorVector anchors = alone_.state.anchors + change.head<kAnchorUnknowns>();
    const double moved_mm = (anchors - state.anchors).lpNorm<Eigen::Infinity>();
    state.anchors = anchors;
    state.log_scale = alone_.state.log_scale + change[kAnchorUnknowns];
    if (!(moved_mm < kConvergedMm)) continue;
    AnchorFit fit = alone_;
    fit.state = state;
    place_all(belts_, fit);
    return fit.state;
  }
  return std::nullopt;
}

std::optional<FrameState> HolesEstimate::converged(const FrameState& state,
                                                   const Eigen::MatrixXd& covariance) const {
  if (known_) return converged_about_known(state, covariance);
  const bool has_points = !belts_.points.empty();
  estimation::EstimationInput input = anchor_input(belts_, alone_.counting, state.anchors);
  input.noise.knowledge = interp::NoiseKnowledge::exact;
  input.observations.clear();
  const auto readings = std::make_shared<const observation::BeltLengthReadings>(
      readings_of(belts_, alone_.counting, has_points ? alone_.residual_sigma_mm : 1.0));
  if (has_points) input.observations.push_back(readings);
  input.observations.push_back(std::make_shared<const HoleDistances>(sets_, covariance));
  Eigen::Index units = 0;
  for (const auto& own : input.observations) units += std::ssize(own->units());
  input.fixed_weights = Eigen::VectorXd::Ones(units);
  model::BeltMachine machine = belts_.machine;
  machine.anchors_known = !has_points;
  input.mechanism = model::make_belt_mechanism(
                        machine, kStatedAnchorMm, model::BeltScaleKnowledge{kBeltScaleSigma})
                        ->with_values(frame_vector(state));
  const auto estimate = estimation::estimate(input);
  if (!estimate || !estimate->converged) return std::nullopt;
  AnchorFit fit;
  fit.state.anchors = estimate->mechanism->values().head<kAnchorUnknowns>();
  fit.state.log_scale = estimate->mechanism->values()[kAnchorUnknowns];
  if (has_points) place_all(belts_, *readings, estimate->mechanism, fit);
  return fit.state;
}

}  // namespace chaintrue::grid::belts

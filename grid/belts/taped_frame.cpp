// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/taped_frame.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "grid/belts/belts_and_holes.hpp"

namespace chaintrue::grid::belts {
namespace {

Eigen::VectorXd frame_vector(const FrameState& state) {
  Eigen::VectorXd x(kFrameUnknowns);
  x << state.anchors, state.log_scale;
  return x;
}

}  // namespace

TapedFrame::TapedFrame(const MeasuredBelts& belts,
                       const std::vector<BeltHoles>& sets,
                       AnchorFit alone)
    : belts_(belts), sets_(sets), alone_(std::move(alone)) {
  if (belts.points.empty()) return;
  solver_.emplace(belts, alone_.counting, alone_.spread_mm);
  unknowns_ = std::max(unknowns_, solver_->unknowns());
}

std::optional<TapedRows> TapedFrame::rows(const FrameState& state) const {
  std::vector<HoleRows> parts;
  Eigen::Index distances = 0;
  Eigen::Index holes = 0;
  for (const BeltHoles& set : sets_) {
    auto part = hole_rows(set, state.anchors, state.log_scale);
    if (!part) return std::nullopt;
    distances += part->residual_mm.size();
    holes += static_cast<Eigen::Index>(part->marks.size());
    parts.push_back(*std::move(part));
  }
  TapedRows all{Eigen::VectorXd(distances),
                Eigen::MatrixXd(distances, kFrameUnknowns),
                Eigen::MatrixXd::Zero(distances, 2 * holes),
                Eigen::MatrixXd(distances, 2),
                Eigen::MatrixXd(distances, 3),
                {}};
  const model::FramePoint centre = model::centre_of(sets_.front().machine);
  const double factor = std::exp(state.log_scale);
  Eigen::Index row = 0;
  for (const HoleRows& part : parts) {
    const Eigen::Index count = part.residual_mm.size();
    all.residual_mm.segment(row, count) = part.residual_mm;
    all.by_frame.middleRows(row, count) = part.by_frame;
    all.by_mark.block(
        row, 2 * static_cast<Eigen::Index>(all.marks.size()), count, part.by_mark.cols()) =
        part.by_mark;
    all.by_size.middleRows(row, count) = part.by_size;
    all.by_sheet.middleRows(row, count) = part.by_sheet;
    for (const model::FramePoint& at : part.frame_places)
      all.marks.push_back({factor * (at.x_mm - centre.x_mm), factor * (at.y_mm - centre.y_mm)});
    row += count;
  }
  return all;
}

Eigen::MatrixXd TapedFrame::covariance(const TapedRows& rows,
                                       const TapedNoise& noise,
                                       const std::vector<bool>& counting) const {
  const Eigen::Index count = rows.residual_mm.size();
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  Eigen::Index row = 0;
  Eigen::Index hole = 0;
  for (const BeltHoles& set : sets_) {
    const auto own = static_cast<Eigen::Index>(set.set.distances.size());
    const auto holes = static_cast<Eigen::Index>(set.set.holes.size());
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
      covariance += noise.size_mm * noise.size_mm * by_axis * kernel * by_axis.transpose();
    }
  }
  for (Eigen::Index k = 0; k < count; ++k) {
    if (!counting[static_cast<std::size_t>(k)]) covariance(k, k) += kRejectedMm2;
  }
  return covariance;
}

TapedFrame::Normal TapedFrame::of_the_belts(const FrameState& state) const {
  Normal result;
  result.matrix = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
  result.gradient = Eigen::VectorXd::Zero(unknowns_);
  if (solver_) {
    const FrameEquations there = solver_->equations(state);
    result.cost = there.cost;
    result.belts = solver_->reduce(there, 0.0);
    const Eigen::Index own = solver_->unknowns();
    result.matrix.topLeftCorner(own, own) = result.belts->normal;
    result.gradient.head(own) = result.belts->gradient;
  } else {
    constexpr double kWeight = 1.0 / (kStatedAnchorMm * kStatedAnchorMm);
    const AnchorVector off = alone_.state.anchors - state.anchors;
    result.cost = kWeight * off.squaredNorm();
    result.matrix.diagonal().head<kAnchorUnknowns>().array() += kWeight;
    result.gradient.head<kAnchorUnknowns>() += kWeight * off;
  }
  constexpr double kScaleWeight = 1.0 / (kBeltScaleSigma * kBeltScaleSigma);
  result.cost += kScaleWeight * state.log_scale * state.log_scale;
  result.matrix(kAnchorUnknowns, kAnchorUnknowns) += kScaleWeight;
  result.gradient[kAnchorUnknowns] -= kScaleWeight * state.log_scale;
  return result;
}

std::optional<TapedFrame::Normal> TapedFrame::normal(const FrameState& state,
                                                     const Eigen::MatrixXd& inverse) const {
  const auto taped = rows(state);
  if (!taped) return std::nullopt;
  Normal result = of_the_belts(state);
  result.cost += taped->residual_mm.dot(inverse * taped->residual_mm);
  result.matrix.topLeftCorner<kFrameUnknowns, kFrameUnknowns>() +=
      taped->by_frame.transpose() * inverse * taped->by_frame;
  result.gradient.head<kFrameUnknowns>() +=
      taped->by_frame.transpose() * inverse * taped->residual_mm;
  return result;
}

FrameState TapedFrame::stepped(const FrameState& state,
                               const Normal& normal,
                               const Eigen::VectorXd& step) const {
  FrameState next = state;
  next.anchors += step.head<kAnchorUnknowns>();
  next.log_scale += step[kAnchorUnknowns];
  for (std::size_t k = 0; solver_ && k < next.places.size(); ++k) {
    if (!solver_->is_placed(k)) continue;
    const AnchorAdjustment::Eliminated& own = normal.belts->points[k];
    const Eigen::Vector2d move =
        solver_->is_taped(k)
            ? Eigen::Vector2d(step.segment<2>(solver_->place_column(k)))
            : Eigen::Vector2d(own.inverse * (own.gradient - own.cross.transpose() *
                                                                step.head(solver_->unknowns())));
    next.places[k].x_mm += move.x();
    next.places[k].y_mm += move.y();
  }
  return next;
}

std::optional<FrameState> TapedFrame::settled(FrameState state,
                                              const Eigen::MatrixXd& covariance) const {
  // From a frame that the belts know to a few centimetres Newton settles in four or five steps.
  constexpr int kMostSteps = 50;
  constexpr int kMostHalvings = 20;
  // Of the cost, which is about the number of readings; as in frame_solver.
  constexpr double kSettled = 1e-9;
  const Eigen::MatrixXd inverse =
      covariance.llt().solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  auto now = normal(state, inverse);
  for (int i = 0; now && i < kMostSteps; ++i) {
    Eigen::VectorXd step = now->matrix.ldlt().solve(now->gradient);
    if (!step.allFinite()) return std::nullopt;
    std::optional<Normal> there;
    FrameState next;
    for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
      next = stepped(state, *now, step);
      there = normal(next, inverse);
      if (there && there->cost <= now->cost * (1.0 + kSettled)) break;
      there.reset();
    }
    // Nothing lower: this is the bottom, to rounding.
    if (!there) return state;
    const bool is_settled = now->cost - there->cost <= kSettled * (1.0 + now->cost);
    state = std::move(next);
    now = std::move(there);
    if (is_settled) return state;
  }
  return std::nullopt;
}

Eigen::MatrixXd TapedFrame::covariance_without_holes(const FrameState& state) const {
  const Normal normal = of_the_belts(state);
  const Eigen::MatrixXd all =
      normal.matrix.ldlt().solve(Eigen::MatrixXd::Identity(unknowns_, unknowns_));
  return all.topLeftCorner<kFrameUnknowns, kFrameUnknowns>();
}

Eigen::VectorXd TapedFrame::about_the_belts(const TapedRows& rows, const FrameState& state) const {
  return rows.residual_mm + rows.by_frame * (frame_vector(state) - frame_vector(alone_.state));
}

}  // namespace chaintrue::grid::belts

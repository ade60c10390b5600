// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/frame_solver.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid::belts {

using model::Belt;
using model::FramePoint;
using model::kBelts;

namespace {

/// Column of the scale's logarithm.
constexpr Eigen::Index kScaleColumn = kAnchorUnknowns;

/// Columns of an anchor's x and y; -1: it is 0 by the choice of the frame.
std::pair<Eigen::Index, Eigen::Index> columns_of(Belt belt) {
  switch (belt) {
    case Belt::tl:
      return {0, 1};
    case Belt::tr:
      return {2, 3};
    case Belt::br:
      return {4, -1};
    case Belt::bl:
      break;
  }
  return {-1, -1};
}

/// What of a row of J_a is not 0: an anchor's coordinates, and those of a taped place.
struct SparseRow {
  std::array<Eigen::Index, 4> column{};
  std::array<double, 4> value{};
  std::size_t count = 0;

  void add(Eigen::Index at, double by) {
    column.at(count) = at;
    value.at(count++) = by;
  }
};

SparseRow sparse_row(Belt belt, const Eigen::RowVector2d& by_place, Eigen::Index place_column) {
  SparseRow row;
  const auto [x, y] = columns_of(belt);
  if (x >= 0) row.add(x, -by_place.x());
  if (y >= 0) row.add(y, -by_place.y());
  if (place_column >= 0) {
    row.add(place_column, by_place.x());
    row.add(place_column + 1, by_place.y());
  }
  return row;
}

/// An end of a distance, with its derivative by the frame's unknowns.
struct End {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  Eigen::Matrix2Xd by_frame;
};

void add_anchor(Belt belt, const Eigen::Matrix2d& by_anchor, Eigen::Matrix2Xd& by_frame) {
  const auto [x, y] = columns_of(belt);
  if (x >= 0) by_frame.col(x) += by_anchor.col(0);
  if (y >= 0) by_frame.col(y) += by_anchor.col(1);
}

Eigen::Vector2d vector_of(const model::Anchor& anchor) { return {anchor.x_mm, anchor.y_mm}; }

/// Where the machine puts the tool with the spans that its controller pays out for a command:
/// u_i . (dq - dA_i) = 0 for the upper belts, u_i from anchor i to the tool.
bool place_hole(const model::BeltMachine& stated,
                const model::BeltMachine& machine,
                const CutHole& hole,
                End& end) {
  const FramePoint meant = model::to_frame(stated, hole.commanded);
  const Eigen::Vector2d target(meant.x_mm, meant.y_mm);
  const Eigen::Vector2d tl = vector_of(machine.anchors.tl);
  const Eigen::Vector2d tr = vector_of(machine.anchors.tr);
  const auto place = model::crossing({tl.x(), tl.y()},
                                     (target - vector_of(stated.anchors.tl)).norm(),
                                     {tr.x(), tr.y()},
                                     (target - vector_of(stated.anchors.tr)).norm());
  if (!place) return false;
  end.at = {place->x_mm, place->y_mm};
  Eigen::Matrix2d ways;
  ways.row(0) = (end.at - tl).normalized();
  ways.row(1) = (end.at - tr).normalized();
  const Eigen::Matrix2d inverse = ways.inverse();
  add_anchor(Belt::tl, inverse.col(0) * ways.row(0), end.by_frame);
  add_anchor(Belt::tr, inverse.col(1) * ways.row(1), end.by_frame);
  return true;
}

}  // namespace

AnchorAdjustment::AnchorAdjustment(const MeasuredBelts& belts, Counting counting, double sigma_mm)
    : belts_(belts), counting_(std::move(counting)), sigma_mm_(sigma_mm) {
  if (counting_.size() != belts_.points.size() || !(sigma_mm_ > 0.0)) {
    throw std::logic_error(fmt::format("{} points, {} of which it is said what counts, with {} mm",
                                       belts_.points.size(),
                                       counting_.size(),
                                       sigma_mm_));
  }
  place_column_.assign(belts_.points.size(), -1);
  for (const auto& counts : counting_) is_placed_.push_back(readings_counting(counts) >= 2);
  if (fits_scale()) ++unknowns_;
  for (const BeltDistance& distance : belts_.distances) {
    for (const BeltEnd& end : {distance.from, distance.to}) {
      const auto* index = std::get_if<std::size_t>(&end);
      if (index == nullptr || place_column_.at(*index) >= 0) continue;
      place_column_[*index] = unknowns_;
      unknowns_ += 2;
    }
  }
}

Eigen::Index AnchorAdjustment::belt_degrees_of_freedom() const {
  Eigen::Index free = -kAnchorUnknowns;
  for (std::size_t k = 0; k < counting_.size(); ++k) {
    if (is_placed_[k]) free += readings_counting(counting_[k]) - 2;
  }
  return free;
}

Eigen::Index AnchorAdjustment::degrees_of_freedom() const {
  const auto distances = static_cast<Eigen::Index>(belts_.distances.size());
  return belt_degrees_of_freedom() + (distances > 0 ? distances - 1 : 0);
}

void AnchorAdjustment::add_belts(const FrameState& state, FrameEquations& equations) const {
  const model::BeltMachine machine = with_anchors(belts_.machine, state.anchors);
  for (std::size_t k = 0; k < belts_.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      const auto reading = model::reading_at(machine, belt, state.places[k]);
      const Eigen::Index row = row_of(k, belt);
      if (!reading) {
        if (counts(k, belt)) equations.cost = std::numeric_limits<double>::infinity();
        continue;
      }
      const double residual = belts_.points[k].lengths_mm[belt] - reading->length_mm;
      equations.residual[row] = residual;
      equations.by_place.row(row) = reading->by_place;
      if (counts(k, belt)) equations.belts_square_mm2 += residual * residual;
    }
  }
  equations.cost += equations.belts_square_mm2 / (sigma_mm_ * sigma_mm_);
}

void AnchorAdjustment::add_distances(const FrameState& state, FrameEquations& equations) const {
  const auto count = static_cast<Eigen::Index>(belts_.distances.size());
  equations.distance_residual = Eigen::VectorXd::Zero(count);
  equations.distance_by_frame = Eigen::MatrixXd::Zero(count, unknowns_);
  const model::BeltMachine machine = with_anchors(belts_.machine, state.anchors);
  const double factor = std::exp(state.log_scale);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BeltDistance& distance = belts_.distances[static_cast<std::size_t>(i)];
    const auto placed = [&](const BeltEnd& stated) {
      End end;
      end.by_frame = Eigen::Matrix2Xd::Zero(2, unknowns_);
      if (const auto* index = std::get_if<std::size_t>(&stated)) {
        end.at = {state.places[*index].x_mm, state.places[*index].y_mm};
        end.by_frame.middleCols<2>(place_column_[*index]).setIdentity();
      } else if (const auto* belt = std::get_if<Belt>(&stated)) {
        end.at = vector_of(machine.anchors[*belt]);
        add_anchor(*belt, Eigen::Matrix2d::Identity(), end.by_frame);
      } else if (!place_hole(belts_.machine, machine, std::get<CutHole>(stated), end)) {
        equations.cost = std::numeric_limits<double>::infinity();
      }
      return end;
    };
    const End from = placed(distance.from);
    const End to = placed(distance.to);
    const Eigen::Vector2d way = to.at - from.at;
    const double predicted = factor * way.norm();
    equations.distance_residual[i] = (distance.distance_mm - predicted) / distance.sigma_mm;
    equations.distance_by_frame.row(i) =
        factor / distance.sigma_mm * way.normalized().transpose() * (to.by_frame - from.by_frame);
    equations.distance_by_frame(i, kScaleColumn) += predicted / distance.sigma_mm;
  }
  equations.cost += equations.distance_residual.squaredNorm();
}

FrameEquations AnchorAdjustment::equations(const FrameState& state) const {
  FrameEquations equations;
  const auto rows = 4 * static_cast<Eigen::Index>(belts_.points.size());
  equations.residual = Eigen::VectorXd::Zero(rows);
  equations.by_place = Eigen::MatrixX2d::Zero(rows, 2);
  add_belts(state, equations);
  if (fits_scale()) add_distances(state, equations);
  return equations;
}

Eigen::VectorXd AnchorAdjustment::frame_row(const FrameEquations& at,
                                            std::size_t point,
                                            Belt belt) const {
  Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns_);
  const SparseRow own =
      sparse_row(belt, at.by_place.row(row_of(point, belt)), place_column_[point]);
  for (std::size_t i = 0; i < own.count; ++i) row[own.column[i]] = own.value[i];
  return row;
}

AnchorAdjustment::Eliminated AnchorAdjustment::eliminated(const FrameEquations& at,
                                                          std::size_t point,
                                                          double damping) const {
  const double weight = 1.0 / (sigma_mm_ * sigma_mm_);
  Eliminated result;
  result.cross = Eigen::MatrixX2d::Zero(unknowns_, 2);
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  for (const Belt belt : kBelts) {
    if (!counts(point, belt)) continue;
    const Eigen::Index row = row_of(point, belt);
    const Eigen::Vector2d by_place = at.by_place.row(row).transpose();
    normal += weight * by_place * by_place.transpose();
    const SparseRow own = sparse_row(belt, by_place.transpose(), place_column_[point]);
    for (std::size_t i = 0; i < own.count; ++i)
      result.cross.row(own.column[i]) += weight * own.value[i] * by_place.transpose();
    result.gradient += weight * at.residual[row] * by_place;
  }
  normal.diagonal() *= 1.0 + damping;
  result.inverse = normal.inverse();
  return result;
}

AnchorAdjustment::Reduced AnchorAdjustment::reduce(const FrameEquations& at, double damping) const {
  const double weight = 1.0 / (sigma_mm_ * sigma_mm_);
  Reduced reduced;
  reduced.normal = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
  reduced.gradient = Eigen::VectorXd::Zero(unknowns_);
  reduced.points.resize(belts_.points.size());
  if (fits_scale()) {
    reduced.normal += at.distance_by_frame.transpose() * at.distance_by_frame;
    reduced.gradient += at.distance_by_frame.transpose() * at.distance_residual;
  }
  for (std::size_t k = 0; k < belts_.points.size(); ++k) {
    for (const Belt belt : kBelts) {
      if (!counts(k, belt)) continue;
      const SparseRow own = sparse_row(belt, at.by_place.row(row_of(k, belt)), place_column_[k]);
      for (std::size_t i = 0; i < own.count; ++i) {
        for (std::size_t j = 0; j < own.count; ++j)
          reduced.normal(own.column[i], own.column[j]) += weight * own.value[i] * own.value[j];
        reduced.gradient[own.column[i]] += weight * at.residual[row_of(k, belt)] * own.value[i];
      }
    }
  }
  reduced.normal.diagonal() *= 1.0 + damping;
  for (std::size_t k = 0; k < belts_.points.size(); ++k) {
    if (!is_placed_[k] || is_taped(k)) continue;
    reduced.points[k] = eliminated(at, k, damping);
    const Eliminated& point = reduced.points[k];
    const Eigen::MatrixX2d gain = point.cross * point.inverse;
    reduced.normal -= gain * point.cross.transpose();
    reduced.gradient -= gain * point.gradient;
  }
  return reduced;
}

FrameState AnchorAdjustment::stepped(const FrameState& state,
                                     const Reduced& reduced,
                                     const Eigen::VectorXd& step) const {
  FrameState next = state;
  next.anchors += step.head<kAnchorUnknowns>();
  if (fits_scale()) next.log_scale += step[kScaleColumn];
  for (std::size_t k = 0; k < next.places.size(); ++k) {
    if (!is_placed_[k]) continue;
    const Eliminated& point = reduced.points[k];
    const Eigen::Vector2d move =
        is_taped(k)
            ? Eigen::Vector2d(step.segment<2>(place_column_[k]))
            : Eigen::Vector2d(point.inverse * (point.gradient - point.cross.transpose() * step));
    next.places[k].x_mm += move.x();
    next.places[k].y_mm += move.y();
  }
  return next;
}

bool AnchorAdjustment::solve(FrameState& state) const {
  // A frame begins within a metre of where it ends; of a thousand drawn ones the slowest took 40.
  constexpr int kMostSteps = 100;
  constexpr double kLargestDamping = 1e12;
  // Of the cost, which is about the number of checks: far below what the noise leaves uncertain. The
  // second is for lengths without noise.
  constexpr double kSettled = 1e-9;
  constexpr double kSettledAtNothing = 1e-12;
  FrameEquations now = equations(state);
  if (!std::isfinite(now.cost)) return false;
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    const Reduced reduced = reduce(now, damping);
    const Eigen::VectorXd move = reduced.normal.ldlt().solve(reduced.gradient);
    const FrameState next = stepped(state, reduced, move);
    const FrameEquations there = equations(next);
    if (move.allFinite() && there.cost <= now.cost) {
      const bool settled = now.cost - there.cost <= kSettled * now.cost + kSettledAtNothing;
      state = next;
      now = there;
      damping = std::max(damping / 10.0, 1e-15);
      if (settled) return true;
    } else {
      damping *= 4.0;
      // Nothing lower in any direction: this is the bottom, to rounding.
      if (damping > kLargestDamping) return true;
    }
  }
  return false;
}

}  // namespace chaintrue::grid::belts

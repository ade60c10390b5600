// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/straight_settings.hpp"

#include <cmath>
#include <vector>

#include "grid/chain_rows.hpp"
#include "grid/containers.hpp"
#include "grid/eigen.hpp"
#include "grid/map/controller_error.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::Side;

/// For a chain: its anchor and its count.
constexpr Index kX = 0, kY = 1, kCount = 2, kOfChain = 3;

/// (1) less the map, both chains, and its derivatives by both chains' unknowns.
struct Misfit {
  Vector2d residual_mm;
  Eigen::Matrix<double, 2, 2 * kOfChain> by_unknown =
      Eigen::Matrix<double, 2, 2 * kOfChain>::Zero();
};

Misfit misfit_at(const MeasuredPlace& place, model::ChainLengths at_origin,
                 const Eigen::Vector<double, 2 * kOfChain>& unknowns) {
  Misfit misfit;
  for (const Side side : model::kSides) {
    const Index row = row_of(side), from = kOfChain * row;
    const double x = unknowns[from + kX], y = unknowns[from + kY], count = unknowns[from + kCount];
    const double there = std::hypot(place.commanded.x_mm - x, place.commanded.y_mm - y);
    const double origin = std::hypot(x, y);
    misfit.residual_mm[row] = at_origin[side] + count * (there - origin) - place.lengths[side];
    misfit.by_unknown(row, from + kX) = count * ((x - place.commanded.x_mm) / there - x / origin);
    misfit.by_unknown(row, from + kY) = count * ((y - place.commanded.y_mm) / there - y / origin);
    misfit.by_unknown(row, from + kCount) = there - origin;
  }
  return misfit;
}

/// Both chains' unknowns from those that are free: level anchors share their y.
MatrixXd all_by_free(Anchors anchors) {
  if (anchors == Anchors::free) return MatrixXd::Identity(2 * kOfChain, 2 * kOfChain);
  MatrixXd all = MatrixXd::Zero(2 * kOfChain, 2 * kOfChain - 1);
  all(kX, 0) = all(kY, 1) = all(kCount, 2) = 1.0;
  all(kOfChain + kX, 3) = all(kOfChain + kCount, 4) = 1.0;
  all(kOfChain + kY, 1) = 1.0;
  return all;
}

VectorXd errors_with(const std::vector<MeasuredPlace>& places, model::ChainLengths at_origin,
                     const Eigen::Vector<double, 2 * kOfChain>& unknowns, MatrixXd* by_unknown) {
  VectorXd errors(2 * std::ssize(places));
  if (by_unknown != nullptr) by_unknown->resize(errors.size(), 2 * kOfChain);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Misfit misfit = misfit_at(places[i], at_origin, unknowns);
    const auto row = 2 * as_index(i);
    errors.segment<2>(row) = places[i].to_tool * misfit.residual_mm;
    if (by_unknown != nullptr)
      by_unknown->middleRows<2>(row) = places[i].to_tool * misfit.by_unknown;
  }
  return errors;
}

/// The origins of straight chains for the stated machine.
Eigen::Vector<double, 2 * kOfChain> start_of(const model::Machine& machine, Anchors anchors) {
  Eigen::Vector<double, 2 * kOfChain> start;
  start << machine.motors.left.x_mm, machine.motors.left.y_mm, 1.0, machine.motors.right.x_mm,
      machine.motors.right.y_mm, 1.0;
  if (anchors == Anchors::level)
    start[kY] = start[kOfChain + kY] = 0.5 * (start[kY] + start[kOfChain + kY]);
  return start;
}

}  // namespace

std::string_view sentence_of(StraightReason reason) {
  switch (reason) {
    case StraightReason::no_machine:
      return "this map was made without a machine, so its anchors are unknown: fit the points "
             "again with --machine, and without --surface direct";
    case StraightReason::no_origin:
      return "the map does not cover 0, 0, where such a controller is switched on";
    case StraightReason::not_converged:
      break;
  }
  return "no anchors with straight lines approximate this map";
}

tl::expected<StraightSettings, StraightFailure> straight_settings(const CompensationMap& map,
                                                                  Anchors anchors) {
  if (map.machine() == nullptr) return tl::unexpected(StraightReason::no_machine);
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::marks);
  const auto origin = map.lengths(model::MarkPoint{0.0, 0.0});
  if (!origin || places.empty()) return tl::unexpected(StraightReason::no_origin);
  const MatrixXd free = all_by_free(anchors);
  auto unknowns = start_of(*map.machine(), anchors);
  constexpr int kMostSteps = 50;
  // Far below the typed resolution, 1e-4 mm.
  constexpr double kConverged = 1e-7;
  bool converged = false;
  for (int step = 0; step < kMostSteps && !converged; ++step) {
    MatrixXd by_unknown;
    const VectorXd errors = errors_with(places, origin->lengths, unknowns, &by_unknown);
    const VectorXd change =
        linear::product(free, linear::least_squares(linear::product(by_unknown, free), -errors));
    if (!change.allFinite()) break;
    unknowns += change;
    converged = change.lpNorm<Eigen::Infinity>() < kConverged;
  }
  if (!converged) return tl::unexpected(StraightReason::not_converged);
  StraightSettings result;
  for (const Side side : model::kSides) {
    const Index from = kOfChain * row_of(side);
    result.anchors[side] = {unknowns[from + kX], unknowns[from + kY]};
    result.more_steps[side] = unknowns[from + kCount];
    result.longer_mm[side] =
        std::hypot(unknowns[from + kX], unknowns[from + kY]) - origin->lengths[side];
  }
  result.left_over =
      summary_of_errors(places, errors_with(places, origin->lengths, unknowns, nullptr));
  return result;
}

}  // namespace chaintrue::grid

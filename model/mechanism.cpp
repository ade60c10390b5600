// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mechanism.hpp"

#include <Eigen/Cholesky>

namespace chaintrue::model {

tl::expected<LengthsPrediction, MechanismFailure> predict(const Mechanism& mechanism,
                                                          const ToolPosition& position,
                                                          const MechanismVisit& visit,
                                                          const Eigen::VectorXd& values) {
  return mechanism.with_values(values)->predict(position, visit);
}

tl::expected<Eigen::VectorXd, MechanismFailure> added_by(const Mechanism& mechanism,
                                                         const AppliedEffect& effect,
                                                         const ToolPosition& mark,
                                                         const MechanismVisit& visit) {
  const auto with = mechanism.with_effects({effect});
  const auto there = with->predict(with->place_of_mark(mark), visit, Derivatives::by_position);
  if (!there) return tl::unexpected(there.error());
  const auto plain =
      mechanism.predict(mechanism.place_of_mark(mark), visit, Derivatives::by_position);
  if (!plain) return tl::unexpected(plain.error());
  return Eigen::VectorXd(there->lengths_mm - plain->lengths_mm);
}

tl::expected<ToolPosition, MechanismFailure> locate_by_newton(const Mechanism& mechanism,
                                                              const Eigen::VectorXd& lengths_mm,
                                                              const MechanismVisit& visit,
                                                              const ToolPosition& start,
                                                              const std::vector<bool>& counting) {
  // Where four lengths agree to a few millimetres Gauss-Newton converges linearly; the rate is the
  // ratio of the residuals to the lengths, some 1e-3 a step.
  constexpr int kMostSteps = 50;
  constexpr int kMostHalvings = 40;
  constexpr double kConvergedMm = 1e-9;
  // At the minimum the residuals decrease by no more than the lengths' rounding.
  constexpr double kRoundingMm = 1e-9;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(lengths_mm.size());
  for (std::size_t i = 0; i < counting.size(); ++i)
    weight[static_cast<Eigen::Index>(i)] = counting[i] ? 1.0 : 0.0;
  ToolPosition position = start;
  auto there = mechanism.predict(position, visit, Derivatives::by_position);
  if (!there) return tl::unexpected(there.error());
  const auto missing_at = [&](const LengthsPrediction& at) -> Eigen::VectorXd {
    return weight.cwiseProduct(lengths_mm - at.lengths_mm);
  };
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd missing = missing_at(*there);
    const Eigen::MatrixX2d slope = weight.asDiagonal() * there->by_position;
    const Eigen::Matrix2d normal = slope.transpose() * slope;
    Eigen::Vector2d move = normal.ldlt().solve(slope.transpose() * missing);
    if (!move.allFinite()) break;
    const bool is_converged = move.norm() < kConvergedMm;
    ToolPosition next;
    auto at_next = there;
    for (int halving = 0; halving < kMostHalvings; ++halving, move *= 0.5) {
      next = {position.x_mm + move.x(), position.y_mm + move.y()};
      at_next = mechanism.predict(next, visit, Derivatives::by_position);
      if (!at_next) continue;
      if (missing_at(*at_next).norm() <= missing.norm() + kRoundingMm) break;
    }
    if (!at_next) return tl::unexpected(at_next.error());
    position = next;
    there = std::move(at_next);
    if (is_converged) return position;
  }
  return tl::unexpected(
      MechanismFailure{"not_converged", "no position was found for these lengths"});
}

}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mechanism.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <stdexcept>

namespace chaintrue::model {

std::string_view name(Change what) {
  constexpr std::array<std::string_view, 10> kNames = {
      "nothing", "zero",   "tooth",     "pitch",   "zeros_and_pitch",
      "motors",  "anchor", "parameter", "unknown", "bad_point"};
  return kNames.at(static_cast<std::size_t>(what));
}

std::vector<MechanismChange> Mechanism::possible_changes() const {
  std::vector<MechanismChange> changes;
  MechanismChange all{Change::zero, "all", true, kChangePriors.both_zeros};
  std::vector<MechanismChange> others;
  for (std::size_t k = 0; k < parameters().size(); ++k) {
    const MechanismParameter& parameter = parameters()[k];
    MechanismChange one{parameter.set_by_zeroing ? Change::zero : Change::parameter,
                        std::string(parameter.name), parameter.set_by_zeroing};
    one.quantities.push_back({.kind = ChangedQuantity::Kind::parameter,
                              .parameter = k,
                              .sigma = parameter.prior_sigma.value_or(kParameterShiftSigma)});
    if (parameter.set_by_zeroing) all.quantities.push_back(one.quantities.front());
    (parameter.set_by_zeroing ? changes : others).push_back(std::move(one));
  }
  for (MechanismChange& zero : changes) {
    zero.prior =
        (kChangePriors.one_zero + kChangePriors.tooth) / static_cast<double>(changes.size());
  }
  if (changes.size() > 1) changes.push_back(std::move(all));
  for (MechanismChange& other : others) {
    other.prior = (kChangePriors.motors + kChangePriors.pitch) / static_cast<double>(others.size());
    changes.push_back(std::move(other));
  }
  return changes;
}

std::shared_ptr<const Mechanism> MechanismBase::with_values(const Eigen::VectorXd& values) const {
  if (values.size() != values_.size() || !values.allFinite()) {
    throw std::invalid_argument(fmt::format("{} values of {} parameters of {}, or not finite",
                                            values.size(), values_.size(), kind()));
  }
  return rebuild(values, applied_);
}

std::vector<MachineProblem> MechanismBase::problems_of_effects(
    const std::vector<AppliedEffect>& applied) const {
  std::vector<MachineProblem> problems = effects::problems_in(effects_, applied);
  for (std::size_t i = 0; problems.empty() && i < applied.size(); ++i) {
    const effects::Part part = effects::find_effect(effects_, applied[i].effect)->part;
    if (!has(part))
      problems.push_back({fmt::format("/{}/effect", i), applied[i].effect,
                          fmt::format("{} to act on", effects::name(part))});
  }
  for (MachineProblem& problem : problems) problem.parameter = "/effects" + problem.parameter;
  return problems;
}

std::shared_ptr<const Mechanism> MechanismBase::with_effects(
    const std::vector<AppliedEffect>& applied) const {
  require_none(problems_of_effects(applied));
  std::vector<AppliedEffect> all = applied_;
  all.insert(all.end(), applied.begin(), applied.end());
  return rebuild(values_, std::move(all));
}

void MechanismBase::require_all(const Eigen::VectorXd& lengths_mm) const {
  if (lengths_mm.size() != std::ssize(lengths()))
    throw std::invalid_argument(
        fmt::format("{} lengths of {} {}", lengths_mm.size(), lengths().size(), kind()));
}

tl::expected<ChainLengths, MechanismFailure> Mechanism::first_lengths(
    const ToolPosition& position) const {
  const auto at = predict(position, {}, Derivatives::by_position);
  if (!at) return tl::unexpected(at.error());
  return ChainLengths{at->lengths_mm[0], at->lengths_mm[1]};
}

tl::expected<ToolPosition, MechanismFailure> Mechanism::locate_by_first(
    ChainLengths lengths) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(this->lengths().size()));
  all.head<2>() << lengths.left_mm, lengths.right_mm;
  std::vector<bool> counting(static_cast<std::size_t>(all.size()), false);
  counting[0] = counting[1] = true;
  return locate_by_newton(*this, all, {}, extent().centre(), counting);
}

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
  // ratio of the residuals to the lengths, some 1e-3 a step. With a reading that is off by metres
  // each step overshoots, so the step is shortened by the rate seen in the last two.
  constexpr int kMostSteps = 200;
  constexpr double kOvershoots = -0.2;
  constexpr double kShortest = 0.05;
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
  double share = 1.0;
  Eigen::Vector2d last_move = Eigen::Vector2d::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::VectorXd missing = missing_at(*there);
    const Eigen::MatrixX2d slope = weight.asDiagonal() * there->by_position;
    const Eigen::Matrix2d normal = slope.transpose() * slope;
    Eigen::Vector2d move = normal.inverse() * (slope.transpose() * missing);
    if (!move.allFinite()) break;
    const bool is_converged = move.norm() < kConvergedMm;
    const double left = step > 0 ? move.dot(last_move) / last_move.squaredNorm() : 0.0;
    if (left < kOvershoots) share = std::max(kShortest, share / (1.0 - left));
    last_move = move;
    move *= share;
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
      MechanismReason{"not_converged", "no position was found for these lengths"});
}

}  // namespace chaintrue::model

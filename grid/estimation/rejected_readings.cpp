// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Single readings that the others contradict, left out one at a time, the worst first.
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/estimator.hpp"

namespace chaintrue::grid::estimation {

std::vector<Estimator::Shift> Estimator::shifts(bool of_rejected) const {
  std::vector<Shift> all;
  const Eigen::VectorXd residual = problem_->response() - problem_->design() * fit_.coefficients;
  const FittedRows rows{problem_->design(), residual, fit_, problem_->dof(fit_)};
  for (std::size_t u = 0; u < problem_->units().size(); ++u) {
    const SystemUnit& unit = problem_->units()[u];
    const std::vector<Eigen::Index>& rejected = problem_->rejected(u);
    std::vector<Eigen::Index> readings = rejected;
    if (!of_rejected) {
      readings = numbers_below<Eigen::Index>(unit.by_reading.cols());
      std::erase_if(readings, [&](Eigen::Index i) { return contains(rejected, i); });
    }
    for (const Eigen::Index i : readings) all.push_back({shift_of(rows, unit, rejected, i), {u, i}});
  }
  return all;
}

std::optional<Estimator::Shift> Estimator::worst_reading() const {
  std::optional<Shift> worst;
  // Readings that share one check deviate equally; the first of them is taken.
  constexpr double kSame = 1e-6;
  for (const Shift& one : shifts(false)) {
    if (!worst || one.sigmas > (1.0 + kSame) * worst->sigmas) worst = one;
  }
  return worst;
}

/// The rejected reading that fits best.
std::optional<Estimator::Shift> Estimator::best_rejected() const {
  std::optional<Shift> best;
  for (const Shift& one : shifts(true)) {
    if (one.sigmas > 0.0 && (!best || one.sigmas < best->sigmas)) best = one;
  }
  return best;
}

/// Fits again with these readings rejected; false and unchanged if that fails.
bool Estimator::converge_without(RejectedReadings rejected) {
  std::vector<std::vector<observation::UnitReading>> of_observation(input_.observations.size());
  for (std::size_t u = 0; u < rejected.size(); ++u) {
    const SystemUnit& unit = problem_->units()[u];
    for (const Eigen::Index i : rejected[u])
      of_observation[unit.observation].push_back({unit.unit, i});
  }
  const observation::Observations before = input_.observations;
  auto fit = fit_;
  auto state = state_;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (auto other = before[k]->about_others(of_observation[k]))
      input_.observations[k] = std::move(other);
  }
  auto problem =
      std::exchange(problem_, std::make_unique<JointProblem>(input_, false, std::move(rejected)));
  is_linearised_ = false;
  if (converge()) return true;
  problem_ = std::move(problem);
  input_.observations = before;
  fit_ = std::move(fit);
  state_ = std::move(state);
  return false;
}

void Estimator::reject_readings() {
  const ReadingLimits& limits = *input_.reading_limits;
  if (std::sqrt(fit_.sigma2) > limits.most_noise) return;
  Eigen::Index readings = 0;
  for (const SystemUnit& unit : problem_->units()) readings += unit.by_reading.cols();
  const auto most = static_cast<std::size_t>(limits.most_share * as_double(readings));
  const auto of_now = [this] {
    RejectedReadings rejected = problem_->rejected();
    rejected.resize(problem_->units().size());
    return rejected;
  };
  for (std::size_t out = 0; out < most && problem_->dof(fit_) > 1.0; ++out) {
    const auto worst = worst_reading();
    if (!worst || worst->sigmas < limits.rejected_beyond) break;
    RejectedReadings more = of_now();
    more[worst->at.unit].push_back(worst->at.reading);
    if (!converge_without(std::move(more))) break;
  }
  // A reading rejected while a worse one was still included may fit after all.
  for (std::size_t back = 0; back < most; ++back) {
    const auto best = best_rejected();
    if (!best || best->sigmas >= limits.rejected_beyond) break;
    const RejectedReadings now = of_now();
    RejectedReadings fewer = now;
    std::erase(fewer[best->at.unit], best->at.reading);
    if (!converge_without(std::move(fewer))) break;
    const auto worst = worst_reading();
    if (!worst || worst->sigmas < limits.rejected_beyond) continue;
    if (!converge_without(now)) break;
    break;
  }
}

}  // namespace chaintrue::grid::estimation

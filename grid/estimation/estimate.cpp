// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid/estimation/estimator.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::estimation {

ParameterKnowledge stated_knowledge(const Machine& machine) {
  ParameterKnowledge knowledge{VectorXd::Zero(kMachineUnknowns),
                               MatrixXd::Zero(kMachineUnknowns, kMachineUnknowns)};
  for (const Index i : each_below(kMachineSettingCount)) {
    const double sigma =
        std::max(model::stated_sigma(machine, kMachineSettings[as_size(i)]), kKnownSigma);
    knowledge.covariance(i, i) = sigma * sigma;
  }
  knowledge.covariance(kMachineSettingCount, kMachineSettingCount) = knowledge.covariance(
      kMachineSettingCount + 1, kMachineSettingCount + 1) = kScaleSigma * kScaleSigma;
  return knowledge;
}

tl::expected<Estimate, EstimationFailure> estimate(const EstimationInput& input) {
  if (input.observations.empty()) throw std::invalid_argument("an estimate without an observation");
  return Estimator(input).run();
}

std::string words_of(const std::array<SessionZero, 2>& zeros) {
  // Sigmas, 1 in 16 000 for each chain: a warning makes somebody inspect the chains.
  constexpr double kSpokenOf = 4.0;
  std::string words;
  for (const Side side : kSides) {
    const SessionZero& zero = zeros[as_size(row_of(side))];
    if (!(std::abs(zero.mm) > kSpokenOf * zero.sigma_mm)) continue;
    words += fmt::format("{}{} chain {:.1f} +- {:.1f} mm {}", words.empty() ? "" : ", ",
                         side == Side::left ? "left" : "right", std::abs(zero.mm), zero.sigma_mm,
                         zero.mm > 0.0 ? "more" : "less");
  }
  return words;
}

}  // namespace chaintrue::grid::estimation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressor_system.hpp"

#include <cmath>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Where nothing is stated of a parameter, in its own unit: a metre is as good as nothing.
constexpr double kOpenSigma = 1000.0;

/// For each observation one whitening in place of its units' own, of the mean variance of a row.
std::vector<double> common_sigmas(const RegressorSystem& system, std::size_t parts) {
  std::vector<double> variance(parts, 0.0);
  std::vector<double> rows(parts, 0.0);
  for (const auto* units : {&system.units, &system.certain}) {
    for (const SystemUnit& unit : *units) {
      variance[unit.observation] += unit.whitening.inverse().squaredNorm();
      rows[unit.observation] += static_cast<double>(unit.rows);
    }
  }
  for (std::size_t k = 0; k < parts; ++k) variance[k] = std::sqrt(variance[k] / rows[k]);
  return variance;
}

void whiten_by(const std::vector<double>& sigma, SystemUnit& unit, RegressorSystem& system) {
  const double own = sigma[unit.observation];
  const Eigen::MatrixXd change = unit.whitening.inverse() / own;
  const auto rows = Eigen::seqN(unit.first_row, unit.rows);
  system.e(rows) = (change * system.e(rows)).eval();
  system.by_setting(rows, Eigen::all) = (change * system.by_setting(rows, Eigen::all)).eval();
  for (observation::PlaceColumns& place : unit.places)
    place.by_chain = (change * place.by_chain).eval();
  unit.whitening =
      estimation::UnitWhitening(Eigen::MatrixXd::Identity(unit.rows, unit.rows) * own * own);
}

}  // namespace

tl::expected<RegressorSystem, observation::Unreachable> linearise(const ObservationSet& set,
                                                                  const State& state,
                                                                  const Steps& steps) {
  std::vector<estimation::ObservedFrom> from;
  for (const ObservationPart& part : set.parts) {
    const auto settings = std::ssize(set.columns_of(part));
    from.push_back({state.view(part), Eigen::VectorXd::Zero(settings)});
  }
  auto line = estimation::linearise(set, from, estimation::Prediction::visit_by_visit);
  if (!line) {
    const estimation::PlaceOfObservation& where = line.error().place;
    return tl::unexpected(line.error().at(set.parts[where.observation].first_place + where.place));
  }
  RegressorSystem system;
  static_cast<estimation::LinearisedSystem&>(system) = *std::move(line);
  system.setting = setting_values(set, state);
  system.expected_change = set.stated_value - system.setting;
  system.sigma = set.stated_sigma.unaryExpr(
      [](double sigma) { return std::isfinite(sigma) ? sigma : kOpenSigma; });
  // Of each effect the shares of its sides, places and numbers add up to one.
  system.prior.shares = static_cast<double>(
      state.mechanism ? state.mechanism->effects().size()
                      : model::effects::effects_of(state.machine).size());
  system.noise_dof = set.noise_dof;
  system.limits.fewest_groups = set.fewest_units;
  if (!steps.whiten) {
    const std::vector<double> sigma = common_sigmas(system, set.parts.size());
    for (auto* units : {&system.units, &system.certain}) {
      for (SystemUnit& unit : *units) whiten_by(sigma, unit, system);
    }
  }
  return system;
}

}  // namespace chaintrue::grid::diagnosis

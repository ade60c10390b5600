// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressor_system.hpp"

#include <cmath>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Sigma of a parameter without a stated one, in its unit: a metre is practically no prior.
constexpr double kOpenSigma = 1000.0;

}  // namespace

tl::expected<RegressorSystem, observation::Unreachable> linearise(const ObservationSet& set,
                                                                  const State& state) {
  std::vector<estimation::ObservedFrom> from;
  for (const ObservationPart& part : set.parts) {
    const auto settings = std::ssize(set.columns_of(part));
    from.push_back({state.view(part), VectorXd::Zero(settings)});
  }
  auto line = estimation::linearise(set, from, estimation::Prediction::visit_by_visit);
  if (!line) {
    const estimation::PlaceOfObservation& where = line.error().place;
    return tl::unexpected(line.error().at(set.parts[where.observation].first_place + where.place));
  }
  RegressorSystem system;
  static_cast<estimation::LinearisedSystem&>(system) = *std::move(line);
  for (const SystemUnit& unit : system.units) system.groups.push_back({unit.first_row, unit.rows});
  system.setting = setting_values(set, state);
  system.expected_change = set.stated_value - system.setting;
  system.sigma = set.stated_sigma.unaryExpr(
      [](double sigma) { return std::isfinite(sigma) ? sigma : kOpenSigma; });
  // The shares of an effect's sides, places and numbers sum to one.
  system.prior.shares =
      static_cast<double>(state.mechanism ? state.mechanism->effects().size()
                                          : model::effects::effects_of(state.machine).size());
  system.noise_dof = set.noise_dof;
  system.limits.fewest_groups = set.fewest_units;
  return system;
}

}  // namespace chaintrue::grid::diagnosis

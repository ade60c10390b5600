// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_settings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/map/map_for_settings.hpp"

namespace chaintrue::grid {
namespace {

/// (1)
double chi_squared(const Check& check) {
  double sum = 0.0;
  for (const CheckResidual& one : check.residuals)
    sum += std::pow(one.residual_mm / one.sigma_mm, 2);
  return sum;
}

double rms_mm(const Check& check) {
  double sum = 0.0;
  for (const CheckResidual& one : check.residuals) sum += one.residual_mm * one.residual_mm;
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(check.residuals.size(), 1)));
}

}  // namespace

std::optional<ChangedSettings> changed_settings(const CompensationMap& map,
                                                const Measured& measured,
                                                const model::Controller& others,
                                                const Check& found) {
  if (found.is_valid_as_it_is() || map.machine() == nullptr) return std::nullopt;
  auto check = check_map(map_for_settings(map, others, ""), commanded_with(measured, others));
  if (!check || !check->is_valid_as_it_is() ||
      chi_squared(*check) > chi_squared(found) - kFarBetter)
    return std::nullopt;
  ChangedSettings result{*std::move(check), rms_mm(found), 0.0};
  result.with_these_mm = rms_mm(result.check);
  result.check.settings_have_changed = true;
  return result;
}

}  // namespace chaintrue::grid

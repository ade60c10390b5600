// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_settings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

using Settings = model::ControllerSettings;
using Number = std::optional<double> Settings::*;

/// Those that export types in.
std::vector<Number> differing_numbers(const Settings& a, const Settings& b) {
  std::vector<Number> numbers = {&Settings::motor_spacing_mm,
                                 &Settings::motor_offset_y_mm,
                                 &Settings::rotation_radius_mm,
                                 &Settings::sled_width_mm,
                                 &Settings::sled_height_mm,
                                 &Settings::sled_cg_mm,
                                 &Settings::chain_sag_correction,
                                 &Settings::left_chain_tolerance_percent,
                                 &Settings::right_chain_tolerance_percent,
                                 &Settings::top_beam_tilt_deg};
  std::erase_if(numbers, [&](Number one) { return a.*one == b.*one; });
  return numbers;
}

}  // namespace

std::optional<ChangedSettings> changed_settings(const CompensationMap& map,
                                                const Measured& measured,
                                                const model::ControllerSettings& others,
                                                const Check& found) {
  if (found.is_valid_as_it_is() || map.machine() == nullptr) return std::nullopt;
  const model::Controller& own = map.machine()->controller;
  const std::vector<Number> numbers = differing_numbers(own.settings, others);
  const unsigned all = (1U << numbers.size()) - 1U;
  double least = chi_squared(found) - kFarBetter;
  std::optional<ChangedSettings> result;
  for (unsigned part = all; part > 0; --part) {
    model::Controller now = own;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if ((part >> k & 1U) != 0) now.settings.*numbers[k] = others.*numbers[k];
    }
    auto check = check_map(map_for_settings(map, now, ""), commanded_with(measured, now));
    if (!check || !check->is_valid_as_it_is()) continue;
    const double own_score = chi_squared(*check) + (part == all ? 0.0 : 2.0 * std::log(all - 1.0));
    if (own_score > least) continue;
    least = own_score;
    result = ChangedSettings{*std::move(check), now.settings, part == all, rms_mm(found), 0.0};
  }
  if (!result) return std::nullopt;
  result->with_these_mm = rms_mm(result->check);
  result->check.settings_have_changed = true;
  return result;
}

}  // namespace chaintrue::grid

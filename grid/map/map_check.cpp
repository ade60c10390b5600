// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "grid/map/check_evidence.hpp"
#include "grid/map/check_readings.hpp"
#include "grid/map/map_for_settings.hpp"

namespace chaintrue::grid {
namespace {

std::string chain_words(const std::string& side) {
  return side == "both" ? std::string("both chains") : fmt::format("the {} chain", side);
}

std::string words_of_chains(const CheckHypothesis& h) {
  if (h.what == model::Change::zero && h.side == "both") {
    return fmt::format("the zeros have shifted, the left by {:+.2f} mm and the right by {:+.2f} mm",
                       h.added(0).value, h.added(1).value);
  }
  if (h.what == model::Change::zero) {
    return fmt::format("the zero of {} has shifted by {:+.2f} mm", chain_words(h.side), h.size());
  }
  if (h.what == model::Change::tooth) {
    return fmt::format("{} skipped {} {}: it reads {:.2f} mm too {}", chain_words(h.side),
                       std::abs(h.count) == 1 ? "one" : "two",
                       std::abs(h.count) == 1 ? "tooth" : "teeth", std::abs(h.size()),
                       h.count > 0 ? "much" : "little");
  }
  if (h.what == model::Change::pitch || h.what == model::Change::zeros_and_pitch) {
    const double growth = h.elongation(h.side == "right" ? 1 : 0).value;
    return fmt::format("the links of {} have grown by {:.3f} %{}", chain_words(h.side),
                       100.0 * growth,
                       h.what == model::Change::pitch ? "" : ", and the zeros have shifted");
  }
  return "a motor has moved";
}

/// A Maslow's firmware stores no zeros: they follow from where the chains are set.
bool sets_chains(const CompensationMap& map) {
  if (map.machine() == nullptr) return false;
  const model::ControllerKind kind = map.machine()->controller.kind;
  return kind == model::ControllerKind::maslow_classic || kind == model::ControllerKind::holey;
}

CheckWords words_of_map(bool sets_chains) {
  return {"the map",
          "points",
          "The map is still valid",
          "The map is valid after re-zeroing",
          "The map must be measured again",
          words_of_chains,
          [sets_chains](const Check& check) {
            return fmt::format("{}New zeros: left {:.2f} mm, right {:.2f} mm.",
                               sets_chains ? "Set the chain lengths again, with both sprockets' "
                                             "teeth at 12 o'clock (Actions, Set Chain Length), "
                                             "and check again. No number in the settings corrects "
                                             "this. "
                                           : "",
                               check.new_zero_mm[0], check.new_zero_mm[1]);
          }};
}

}  // namespace

tl::expected<Check, CheckFailure> check_map(const CompensationMap& map, const Measured& measured,
                                            const Progress& progress) {
  return check_readings(map, measured, progress).map([&](const CheckReadings& readings) {
    tell(progress, {"what may have changed", 2, 2});
    return judged(readings, words_of_map(sets_chains(map)));
  });
}

namespace {

/// (1)
double chi_squared(const Check& check) {
  double sum = 0.0;
  for (const CheckResidual& one : check.residuals)
    sum += std::pow(one.residual_mm / one.sigma_mm, 2);
  return sum;
}

double rms_mm(const Check& check) {
  return rms(mapped(check.residuals, &CheckResidual::residual_mm));
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
    for (const auto k : each_index(numbers)) {
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

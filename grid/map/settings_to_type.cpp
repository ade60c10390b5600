// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/settings_to_type.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <vector>

#include "grid/linear_algebra.hpp"
#include "grid/map/controller_error.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

using model::ControllerSettings;
using model::Machine;

/// A setting that may change: how far it usually is from the truth, and a step to differentiate by.
struct FreeSetting {
  std::optional<double> ControllerSettings::*value;
  double sigma;
  double step;
};

/// Those that the controller has; it may lack what was never typed in.
std::vector<FreeSetting> free_settings(const Machine& machine) {
  using S = ControllerSettings;
  const double motor_mm = machine.uncertainty.motor_position_mm;
  const double spacing_mm = machine.motors.right.x_mm - machine.motors.left.x_mm;
  const double pitch_percent =
      100.0 * model::effects::find_effect("chain_pitch_error")->parameters.front().prior_sigma;
  // Owners' calibrations ended between 20 and 35 where the chain's weight makes 6 to 8.
  constexpr double kSagSigma = 10.0;
  const std::vector<FreeSetting> all = {
      {&S::motor_spacing_mm, std::sqrt(2.0) * motor_mm, 0.1},
      {&S::motor_offset_y_mm, motor_mm / std::sqrt(2.0), 0.1},
      {&S::top_beam_tilt_deg,
       std::sqrt(2.0) * motor_mm / spacing_mm * 180.0 / std::numbers::pi,
       1e-3},
      {&S::rotation_radius_mm, machine.uncertainty.ring_radius_mm, 0.1},
      {&S::chain_sag_correction, kSagSigma, 0.1},
      {&S::left_chain_tolerance_percent, pitch_percent, 1e-3},
      {&S::right_chain_tolerance_percent, pitch_percent, 1e-3},
  };
  std::vector<FreeSetting> present;
  for (const FreeSetting& setting : all) {
    const bool written = (machine.controller.settings.*setting.value).has_value();
    // What is known exactly does not move.
    if (written && setting.sigma > 0.0) present.push_back(setting);
  }
  return present;
}

/// One step of Gauss and Newton from `now`; `weight` is of an error's square relative to the priors'.
std::optional<ControllerSettings> improved(const Machine& machine,
                                           const ControllerSettings& now,
                                           const std::vector<FreeSetting>& free,
                                           const std::vector<MeasuredPlace>& places,
                                           double weight) {
  const auto errors = controller_errors(machine, now, places);
  if (!errors) return std::nullopt;
  const auto unknowns = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd by_setting(errors->size(), unknowns);
  Eigen::VectorXd prior_pull(unknowns);  // of the settings in force, in sigmas
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const FreeSetting& setting = free[static_cast<std::size_t>(k)];
    ControllerSettings more = now;
    ControllerSettings less = now;
    *(more.*setting.value) += setting.step;
    *(less.*setting.value) -= setting.step;
    const auto up = controller_errors(machine, more, places);
    const auto down = controller_errors(machine, less, places);
    if (!up || !down) return std::nullopt;
    by_setting.col(k) = (*up - *down) * (setting.sigma / (2.0 * setting.step));
    prior_pull[k] =
        (*(now.*setting.value) - *(machine.controller.settings.*setting.value)) / setting.sigma;
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(unknowns, unknowns);
  linear::add_gram(normal, weight, by_setting);
  const Eigen::VectorXd right =
      -weight * linear::product(linear::transposed(by_setting), *errors) - prior_pull;
  const Eigen::VectorXd step = linear::Cholesky(std::move(normal)).solve(right);
  ControllerSettings better = now;
  for (Eigen::Index k = 0; k < unknowns; ++k) {
    const FreeSetting& setting = free[static_cast<std::size_t>(k)];
    *(better.*setting.value) += setting.sigma * step[k];
  }
  return better;
}

/// To the digits that are typed.
void round_to_type(const std::vector<FreeSetting>& free,
                   const ControllerSettings& in_force,
                   ControllerSettings& settings) {
  constexpr double kPerUnit = 1e4;
  const auto rounded = [](double value) { return std::round(value * kPerUnit) / kPerUnit; };
  for (const FreeSetting& setting : free) {
    double& value = *(settings.*setting.value);
    const double now = *(in_force.*setting.value);
    value = rounded(value) == rounded(now) ? now : rounded(value);
  }
}

std::size_t good_points(const CompensationMap& map) {
  const auto& points = map.contents().points;
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [](const MapPoint& p) { return !p.bad; }));
}

tl::unexpected<SettingsFailure> failure(SettingsFailure::Reason reason, const char* sentence) {
  return tl::unexpected(SettingsFailure{reason, sentence});
}

}  // namespace

tl::expected<SettingsToType, SettingsFailure> settings_to_type(const CompensationMap& map) {
  const Machine* machine = map.machine();
  if (machine == nullptr) {
    return failure(SettingsFailure::Reason::no_machine,
                   "this map was made without a machine, so there are no settings to mend: fit the "
                   "points again with --machine, and without --surface direct");
  }
  const model::ControllerKind kind = machine->controller.kind;
  const bool maslow =
      kind == model::ControllerKind::maslow_classic || kind == model::ControllerKind::holey;
  const std::vector<MeasuredPlace> places = measured_places(map, MapFrame::bed);
  const auto before = controller_errors(*machine, machine->controller.settings, places);
  if (!maslow || !std::holds_alternative<model::Ring>(machine->attachment) || !before ||
      places.empty()) {
    return failure(SettingsFailure::Reason::another_controller,
                   "the map's machine has no controller of a Maslow with a ring, whose settings "
                   "could be fitted to the map: compensate the G-code with the map");
  }
  const std::vector<FreeSetting> free = free_settings(*machine);
  SettingsToType result;
  result.settings = machine->controller.settings;
  result.as_it_is = result.typed = summary_of_errors(*before);
  result.points = good_points(map);
  // Places tell no more than the points that they come from; below a twentieth of a millimetre no
  // bed is cut.
  constexpr double kFinestMm = 0.05;
  const double sigma_mm = std::max(map.contents().accuracy.expected_tool.rms_mm, kFinestMm);
  const double weight = static_cast<double>(std::max<std::size_t>(result.points, 1)) /
                        static_cast<double>(places.size()) / (sigma_mm * sigma_mm);
  // An error no larger than the map's own may be the map's.
  constexpr double kBeyondTheMap = 2.0;
  if (result.as_it_is.rms_mm < kBeyondTheMap * map.contents().accuracy.expected_tool.rms_mm)
    return result;
  ControllerSettings settings = result.settings;
  // The formulas bend little over some millimetres: the third step is below what is typed.
  constexpr int kSteps = 4;
  for (int step = 0; step < kSteps; ++step) {
    const auto better = improved(*machine, settings, free, places, weight);
    if (!better) return result;
    settings = *better;
  }
  round_to_type(free, machine->controller.settings, settings);
  const auto after = controller_errors(*machine, settings, places);
  // A tenth of the error is not worth a new set of numbers.
  constexpr double kWorthTyping = 0.9;
  if (!after || summary_of_errors(*after).rms_mm > kWorthTyping * result.as_it_is.rms_mm) return result;
  result.settings = settings;
  result.typed = summary_of_errors(*after);
  result.worth_typing = true;
  return result;
}

}  // namespace chaintrue::grid

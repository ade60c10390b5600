// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/settings_to_type.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/mechanism_map.hpp"
#include "interp/linear_algebra.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using model::ControllerSettings;

/// The machine with which settings are compared.
struct Truth {
  Machine machine;  ///< as calibrated, with the controller in force
  /// Such a machine in the frame of the bed.
  std::function<std::vector<MeasuredPlace>(const Machine&)> places;
  double sigma_mm = 0.0;   ///< rms of its uncertainty
  std::size_t points = 0;  ///< points behind it; 0: it is exact
};

/// A setting that may change: its usual error, and the digits that are typed.
struct FreeSetting {
  std::optional<double> ControllerSettings::*value;
  double sigma;
  double per_unit = 1e4;
};

double usual_size(const char* effect) {
  return model::effects::find_effect(effect)->parameters.front().prior_sigma;
}

bool is_holey(const Machine& machine) {
  return machine.controller.kind == model::ControllerKind::holey;
}

/// The settings that the firmware has; it may lack some that were never entered.
std::vector<FreeSetting> free_settings(const Machine& machine) {
  using S = ControllerSettings;
  const double motor_mm = machine.uncertainty.motor_position_mm;
  const double spacing_mm = machine.motors.right.x_mm - machine.motors.left.x_mm;
  const double pitch_percent = 100.0 * usual_size("chain_pitch_error");
  // Owners' calibrations ended between 20 and 35 where the chain's weight makes 6 to 8.
  constexpr double kSagSigma = 10.0;
  // Brackets are measured as a ring is, a centre of gravity by balancing the sled on an edge.
  constexpr double kBracketSigmaMm = 1.0, kBalanceSigmaMm = 5.0;
  std::vector<FreeSetting> all = {
      {&S::motor_spacing_mm, std::sqrt(2.0) * motor_mm},
      {&S::motor_offset_y_mm, motor_mm / std::sqrt(2.0)},
  };
  if (std::holds_alternative<model::Ring>(machine.attachment)) {
    all.insert(all.end(), {{&S::rotation_radius_mm, machine.uncertainty.ring_radius_mm},
                           {&S::chain_sag_correction, kSagSigma},
                           {&S::left_chain_tolerance_percent, pitch_percent},
                           {&S::right_chain_tolerance_percent, pitch_percent}});
  } else {
    // The firmware's quadrilateral has neither sag nor tolerances.
    all.insert(all.end(), {{&S::sled_width_mm, kBracketSigmaMm},
                           {&S::sled_height_mm, kBracketSigmaMm},
                           {&S::sled_cg_mm, kBalanceSigmaMm}});
  }
  if (is_holey(machine)) {
    const double tilt_deg = std::sqrt(2.0) * motor_mm / spacing_mm * 180.0 / std::numbers::pi;
    all.push_back({&S::top_beam_tilt_deg, tilt_deg});
    all.push_back({&S::chain_elongation_per_n, usual_size("chain_stretch"), 1e9});
  }
  std::erase_if(all, [&](const FreeSetting& setting) {
    const bool written = (machine.controller.settings.*setting.value).has_value();
    // Exactly known values are fixed.
    return !written || !(setting.sigma > 0.0);
  });
  return all;
}

/// The errors with such settings.
std::optional<VectorXd> errors_with(const Machine& machine, const ControllerSettings& settings,
                                    const std::vector<MeasuredPlace>& places) {
  Machine with_settings = machine;
  with_settings.controller.settings = settings;
  return controller_errors(paid_out_by(with_settings), places);
}

/// The settings in force, each changed by a number of its usual errors.
ControllerSettings changed_by(const VectorXd& sigmas, const std::vector<FreeSetting>& free,
                              ControllerSettings settings) {
  for (const auto k : each_index(free))
    *(settings.*free[k].value) += free[k].sigma * sigmas[as_index(k)];
  return settings;
}

/// To the digits that are typed.
void round_to_type(const std::vector<FreeSetting>& free, const ControllerSettings& in_force,
                   ControllerSettings& settings) {
  for (const FreeSetting& setting : free) {
    const auto rounded = [&](double value) {
      return std::round(value * setting.per_unit) / setting.per_unit;
    };
    double& value = *(settings.*setting.value);
    const double now = *(in_force.*setting.value);
    value = rounded(value) == rounded(now) ? now : rounded(value);
  }
}

/// Over the area, without its uncertainty.
double rms_of(const std::vector<MeasuredPlace>& places, const VectorXd& errors) {
  double squares_mm2 = 0.0;
  int within = 0;
  for (const auto i : each_index(places)) {
    if (places[i].is_on_edge) continue;
    squares_mm2 += errors.segment<2>(2 * as_index(i)).squaredNorm();
    ++within;
  }
  return std::sqrt(squares_mm2 / std::max(within, 1));
}

/// Settings and the error of the tool with them, root mean square over the area.
struct TypedSettings {
  ControllerSettings settings;
  VectorXd errors_mm;
  double rms_mm;
};

/// The best settings, rounded; empty if the controller cannot go to a place with any intermediate
/// ones.
std::optional<TypedSettings> best_settings(const Truth& truth,
                                           const std::vector<MeasuredPlace>& places) {
  const std::vector<FreeSetting> free = free_settings(truth.machine);
  // No cut is more accurate than a twentieth of a millimetre, and places carry no more information
  // than the points that they come from.
  constexpr double kFinestMm = 0.05;
  const double sigma_mm = std::max(truth.sigma_mm, kFinestMm);
  const double told = truth.points == 0 ? 1.0 : as_double(truth.points) / as_double(places.size());
  const double weight = told / (sigma_mm * sigma_mm);
  const ControllerSettings& in_force = truth.machine.controller.settings;
  const ErrorsAt errors_at = [&](const VectorXd& sigmas) {
    return errors_with(truth.machine, changed_by(sigmas, free, in_force), places);
  };
  VectorXd sigmas = VectorXd::Zero(std::ssize(free));
  // Gauss-Newton steps. The formulas are nearly linear over some millimetres: the third step is
  // below the typed resolution.
  constexpr int kSteps = 4;
  for (int step = 0; step < kSteps; ++step) {
    const auto line = linearised(errors_at, sigmas);
    if (!line) return std::nullopt;
    MatrixXd normal = MatrixXd::Identity(sigmas.size(), sigmas.size());
    linear::add_gram(normal, weight, line->by_value);
    const VectorXd pull = weight * linear::inner(line->by_value, line->errors) + sigmas;
    sigmas -= linear::Cholesky(std::move(normal)).solve(pull);
  }
  ControllerSettings settings = changed_by(sigmas, free, in_force);
  round_to_type(free, in_force, settings);
  const auto errors = errors_with(truth.machine, settings, places);
  if (!errors) return std::nullopt;
  return TypedSettings{settings, *errors, rms_of(places, *errors)};
}

Machine without_effect(Machine machine, const std::string& effect) {
  std::erase_if(machine.effects, [&](const auto& applied) { return applied.effect == effect; });
  return machine;
}

/// The machine without each property for which its firmware has no setting.
std::vector<std::pair<std::string, Machine>> machines_without(const Machine& machine) {
  std::vector<std::pair<std::string, Machine>> without;
  if (!is_holey(machine)) {
    Machine level = machine;
    level.motors.left.y_mm = level.motors.right.y_mm =
        0.5 * (machine.motors.left.y_mm + machine.motors.right.y_mm);
    without.emplace_back("top_beam_tilt", level);
    Machine stiff = without_effect(machine, "chain_stretch");
    stiff.chain.compliance_per_n = 0.0;
    without.emplace_back("chain_stretch", stiff);
  }
  for (const AppliedEffect& applied : machine.effects) {
    const std::string& id = applied.effect;
    const bool is_known = id == "ring_radius" || id == "chain_pitch_error" || id == "chain_sag" ||
                          id == "chain_stretch" || id.starts_with("sled_");
    if (!is_known) without.emplace_back(id, without_effect(machine, id));
  }
  return without;
}

std::vector<Lacking> lacking_of(const Truth& truth, double left_mm) {
  // Smaller improvements by typing in settings are irrelevant.
  constexpr double kWorthSayingMm = 0.05;
  std::vector<Lacking> lacking;
  for (const auto& [what, machine] : machines_without(truth.machine)) {
    const std::vector<MeasuredPlace> places = truth.places(machine);
    if (places.empty()) continue;
    const auto best = best_settings(truth, places);
    if (!best || best->rms_mm >= left_mm) continue;
    const double costs_mm = std::sqrt(left_mm * left_mm - best->rms_mm * best->rms_mm);
    if (costs_mm >= kWorthSayingMm) lacking.push_back({what, costs_mm});
  }
  return lacking;
}

tl::expected<SettingsToType, SettingsFailure> settings_for(const Truth& truth) {
  const model::ControllerKind kind = truth.machine.controller.kind;
  const bool maslow =
      kind == model::ControllerKind::maslow_classic || kind == model::ControllerKind::holey;
  const std::vector<MeasuredPlace> places = truth.places(truth.machine);
  const ControllerSettings& in_force = truth.machine.controller.settings;
  const auto before = errors_with(truth.machine, in_force, places);
  if (!maslow || !before || places.empty()) {
    return failed(SettingsFailure::Reason::another_controller,
                  "the map's machine has no Maslow controller, so there are no settings to fit: "
                  "compensate the G-code with the map");
  }
  SettingsToType result;
  result.settings = in_force;
  result.as_it_is = result.typed = summary_of_errors(places, *before);
  result.points = truth.points;
  // An error below the map's own may be the map's; a gain of a tenth is not worth new numbers.
  constexpr double kBeyondTheMap = 2.0;
  constexpr double kWorthTyping = 0.9;
  double left_mm = rms_of(places, *before);
  if (left_mm >= kBeyondTheMap * truth.sigma_mm) {
    const auto best = best_settings(truth, places);
    if (best && best->rms_mm <= kWorthTyping * left_mm) {
      result.settings = best->settings;
      result.typed = summary_of_errors(places, best->errors_mm);
      result.worth_typing = true;
      left_mm = best->rms_mm;
    }
  }
  result.lacking = lacking_of(truth, left_mm);
  return result;
}

/// The map of another machine with the same surface.
CompensationMap map_of(const CompensationMap& map, const Machine& machine) {
  MapContents contents = map.contents();
  std::get<ModelSurface>(contents.surface).machine = machine;
  return CompensationMap(std::move(contents));
}

}  // namespace

std::optional<ErrorsLine> linearised(const ErrorsAt& errors_at, const VectorXd& values) {
  constexpr double kStep = 0.01;
  const auto errors = errors_at(values);
  if (!errors) return std::nullopt;
  ErrorsLine line{*errors, MatrixXd(errors->size(), values.size())};
  for (const Index k : each_below(values.size())) {
    const VectorXd step = kStep * VectorXd::Unit(values.size(), k);
    const auto up = errors_at(values + step), down = errors_at(values - step);
    if (!up || !down) return std::nullopt;
    line.by_value.col(k) = (*up - *down) / (2.0 * kStep);
  }
  return line;
}

tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const CompensationMap& map, const std::optional<model::Controller>& now) {
  if (map.machine() == nullptr) {
    return failed(SettingsFailure::Reason::no_machine,
                  "this map was made without a machine, so it has no settings to improve: fit the "
                  "points again with --machine, and without --surface direct");
  }
  Truth truth;
  truth.machine = *map.machine();
  if (now) truth.machine.controller = *now;
  truth.places = [&map](const Machine& machine) {
    return measured_places(map_of(map, machine), MapFrame::bed);
  };
  truth.sigma_mm = map.contents().accuracy.expected_tool.rms_mm;
  const auto& points = map.contents().points;
  truth.points = points.size() - count_where(points, &MapPoint::bad);
  return settings_for(truth);
}

tl::expected<SettingsToType, SettingsFailure> settings_to_type(const Machine& machine,
                                                               const std::vector<BedPoint>& hull) {
  Truth truth;
  truth.machine = machine;
  truth.places = [&hull](const Machine& one) {
    const auto mechanism = model::make_chain_mechanism(one);
    const auto parameters = std::ssize(mechanism->parameters());
    const FittedMechanism exact{mechanism, MatrixXd::Zero(parameters, parameters)};
    return measured_places(MechanismMap::of(exact, hull), hull);
  };
  return settings_for(truth);
}

}  // namespace chaintrue::grid

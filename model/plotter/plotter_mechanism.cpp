// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_mechanism.hpp"

#include <cmath>
#include <numbers>

#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::model {
namespace {

constexpr std::array<std::string_view, 2> kCordLengths = {"left", "right"};

/// The settings in force, in the order of PlotterParameter.
template <class Machine>
auto settings_of(Machine& machine) {
  return std::array{&machine.pin_spacing_mm,         &machine.pin_rise_mm,
                    &machine.zero_mm.left_mm,        &machine.zero_mm.right_mm,
                    &machine.scale_mm_per_m.left_mm, &machine.scale_mm_per_m.right_mm};
}

Eigen::VectorXd values_of(const PlotterMachine& machine) {
  Eigen::VectorXd values(kPlotterParameters);
  Eigen::Index i = 0;
  for (const double* setting : settings_of(machine)) values[i++] = *setting;
  return values;
}

std::vector<MechanismParameter> stated_parameters(const PlotterMachine& machine) {
  const PlotterUncertainty& sigma = machine.uncertainty;
  const Eigen::VectorXd v = values_of(machine);
  return {{"pin_spacing_mm", "mm", v[kPinSpacing], sigma.pin_spacing_mm},
          {"pin_rise_mm", "mm", v[kPinRise], sigma.pin_rise_mm},
          {"zero_left_mm", "mm", v[kZeroLeft], sigma.zero_mm, true},
          {"zero_right_mm", "mm", v[kZeroRight], sigma.zero_mm, true},
          {"scale_left_mm_per_m", "mm_per_m", v[kScaleLeft], sigma.scale_mm_per_m},
          {"scale_right_mm_per_m", "mm_per_m", v[kScaleRight], sigma.scale_mm_per_m}};
}

}  // namespace

std::shared_ptr<const PlotterMechanism> make_plotter_mechanism(const PlotterMachine& machine) {
  return std::make_shared<const PlotterMechanism>(machine);
}

PlotterMechanism::PlotterMechanism(const PlotterMachine& machine)
    : PlotterMechanism(machine, stated_parameters(machine), {}) {}

PlotterMechanism::PlotterMechanism(PlotterMachine machine,
                                   std::vector<MechanismParameter> parameters,
                                   std::vector<AppliedEffect> applied)
    : MechanismBase("plotter", kCordLengths, plotter::plotter_effects(), std::move(parameters),
                    values_of(machine), std::move(applied)),
      machine_(std::move(machine)),
      statics_(plotter::statics_of(machine_)),
      acting_(effects::resolve(plotter::plotter_effects(), this->applied())) {
  require_none(problems_of(machine_));
}

MechanismExtent PlotterMechanism::extent() const {
  const DrawingArea& area = machine_.area;
  return {area.left_mm, area.right_mm, area.bottom_mm, area.top_mm};
}

std::shared_ptr<const Mechanism> PlotterMechanism::rebuild(
    const Eigen::VectorXd& values, std::vector<AppliedEffect> applied) const {
  PlotterMachine changed = machine_;
  Eigen::Index i = 0;
  for (double* setting : settings_of(changed)) *setting = values[i++];
  return std::shared_ptr<const Mechanism>(
      new PlotterMechanism(std::move(changed), stated(), std::move(applied)));
}

bool PlotterMechanism::has(effects::Part part) const {
  return (part != effects::Part::body || !is_point(machine_.gondola)) &&
         (part != effects::Part::pulley || machine_.pulley_radius_mm > 0.0);
}

tl::expected<LengthsPrediction, MechanismFailure> PlotterMechanism::predict(
    const ToolPosition& position, const MechanismVisit& visit, Derivatives wanted) const {
  PerSide<double> direction{1.0, 1.0};
  if (!visit.direction.empty()) direction = {visit.direction.at(0), visit.direction.at(1)};
  plotter::Statics statics = statics_;
  for (const effects::ActingEffect& own : acting_) {
    if (own.effect->alter_cords != nullptr)
      own.effect->alter_cords(statics, own.side, direction, own.values);
  }
  const auto cords = plotter::cords_at(
      statics, {position.x_mm, position.y_mm, machine_.pin_spacing_mm, machine_.pin_rise_mm});
  if (!cords) return tl::unexpected(mechanism_failure(cords.error()));
  const bool all = wanted == Derivatives::by_position_and_parameter;
  LengthsPrediction result;
  result.lengths_mm.resize(2);
  result.by_position.resize(2, 2);
  result.by_parameter = Eigen::MatrixXd::Zero(2, all ? +kPlotterParameters : 0);
  for (const Side side : kSides) {
    const Eigen::Index row = side == Side::left ? 0 : 1;
    const plotter::Number& cord = (*cords)[side].length_mm;
    const effects::LengthState state{.length_mm = effects::variable(cord.value, effects::kLength),
                                     .turn_mm = 2.0 * std::numbers::pi * machine_.pulley_radius_mm,
                                     .tooth_mm = machine_.cord.tooth_mm,
                                     .direction = direction[side],
                                     .order = visit.order};
    effects::Number sum = state.length_mm;
    for (const effects::ActingEffect& own : acting_) {
      if (own.effect->add != nullptr && effects::acts_on(own.side, side))
        sum = sum + own.effect->add(state, own.values);
    }
    const plotter::Number counted = cord.chained(sum.value, sum.d[effects::kLength]);
    const double scale = 1.0 + 1e-3 * machine_.scale_mm_per_m[side];
    result.lengths_mm[row] = counted.value * scale + machine_.zero_mm[side];  // (1)
    for (const Eigen::Index axis : {0, 1})
      result.by_position(row, axis) = counted.d[static_cast<std::size_t>(axis)] * scale;
    if (!all) continue;
    result.by_parameter(row, kPinSpacing) = counted.d[2] * scale;
    result.by_parameter(row, kPinRise) = counted.d[3] * scale;
    result.by_parameter(row, kZeroLeft + row) = 1.0;
    result.by_parameter(row, kScaleLeft + row) = 1e-3 * counted.value;
  }
  return result;
}

tl::expected<ToolPosition, MechanismFailure> PlotterMechanism::straight_place(
    ChainLengths lengths) const {
  const double narrower = 0.5 * machine_.gondola.spacing_mm;
  const double half = 0.5 * machine_.pin_spacing_mm - narrower;
  PerSide<double> level{};
  for (const Side side : kSides) {
    const double own =
        (lengths[side] - machine_.zero_mm[side]) / (1.0 + 1e-3 * machine_.scale_mm_per_m[side]);
    // At most a quarter turn is on the pulley.
    level[side] = std::max(own - (machine_.motors == MotorPlace::wall
                                      ? 0.25 * std::numbers::pi * machine_.pulley_radius_mm
                                      : 0.0),
                           std::abs(machine_.gondola.standoff_mm));
  }
  // Circles about the pins, moved together by the gondola's width.
  const double x = (level.left * level.left - level.right * level.right) / (4.0 * half);
  const double square = level.left * level.left - (x + half) * (x + half);
  if (!(square > 0.0)) return tl::unexpected(named(PlotterReason::cords_do_not_meet));
  const double low = -0.5 * std::abs(machine_.pin_rise_mm) - 1e-3 * half;
  return ToolPosition{std::clamp(x, -0.99 * half, 0.99 * half),
                      std::min(low, -std::sqrt(square) - machine_.gondola.pen_below_mm)};
}

tl::expected<ToolPosition, MechanismFailure> PlotterMechanism::locate(
    const Eigen::VectorXd& lengths_mm, const MechanismVisit& visit) const {
  require_all(lengths_mm);
  const auto start = straight_place({lengths_mm[0], lengths_mm[1]});
  if (!start) return tl::unexpected(start.error());
  return locate_by_newton(*this, lengths_mm, visit, *start);
}

tl::expected<ToolPosition, MechanismFailure> PlotterMechanism::locate_by_first(
    ChainLengths lengths) const {
  return locate(Eigen::Vector2d(lengths.left_mm, lengths.right_mm), {});
}

}  // namespace chaintrue::model

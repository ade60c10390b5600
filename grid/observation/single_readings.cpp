// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/single_readings.hpp"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <variant>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::observation {
namespace {

using model::Machine;

/// The first parameter of an effect, summed over the machine's own that act on the side.
double summed_size(const Machine& machine, std::string_view effect, const std::string& side) {
  double sum = 0.0;
  for (const model::AppliedEffect& applied : machine.effects) {
    if (applied.effect != effect) continue;
    if (!side.empty() && applied.side != "both" && applied.side != side) continue;
    sum += applied.parameters.begin()->second;
  }
  return sum;
}

using Predict = double (*)(const Machine&, const ExtraReading&);

const std::map<ReadingOf, Predict>& predictions() {
  static const std::map<ReadingOf, Predict> kPredictions = {
      {ReadingOf::motor_spacing,
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.x_mm - m.motors.left.x_mm;
       }},
      {ReadingOf::beam_rise,
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.y_mm - m.motors.left.y_mm;
       }},
      {ReadingOf::ring_radius,
       [](const Machine& m, const ExtraReading&) {
         const auto* ring = std::get_if<model::Ring>(&m.attachment);
         return (ring != nullptr ? ring->radius_mm : 0.0) + summed_size(m, "ring_radius", "");
       }},
      {ReadingOf::link_pitch,
       [](const Machine& m, const ExtraReading& r) {
         return m.sprocket.pitch_mm * (1.0 + summed_size(m, "chain_pitch_error", r.side));
       }},
      {ReadingOf::chain_mass,
       [](const Machine& m, const ExtraReading&) {
         return m.chain.mass_kg_per_m * (1.0 + summed_size(m, "chain_sag", ""));
       }},
      {ReadingOf::tape_error,
       [](const Machine& m, const ExtraReading& r) {
         return 1000.0 * summed_size(m, "tape_scale", r.side);
       }},
  };
  return kPredictions;
}

}  // namespace

const Kind single_readings{"single_readings", "reading", "readings", "", false};

bool is_predictable(const Machine& machine, const ExtraReading& reading) {
  if (predictions().find(reading.what) == predictions().end()) return false;
  return reading.what != ReadingOf::ring_radius ||
         std::holds_alternative<model::Ring>(machine.attachment);
}

double predicted_reading(const Machine& machine, const ExtraReading& reading) {
  return predictions().at(reading.what)(machine, reading);
}

SingleReadings::SingleReadings(std::vector<ExtraReading> readings)
    : Observation(false, kInfinity, false), readings_(std::move(readings)) {
  sort(readings_, [](const ExtraReading& a, const ExtraReading& b) {
    return std::tie(a.what, a.side, a.value, a.sigma) < std::tie(b.what, b.side, b.value, b.sigma);
  });
  measured_.resize(std::ssize(readings_));
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    if (!(readings_[k].sigma > 0.0)) {
      throw precondition("a reading of {} with sigma {}; it must be positive",
                         name(readings_[k].what),
                         readings_[k].sigma);
    }
    measured_(as_index(k)) = readings_[k].value;
    units_.push_back({as_index(k), 1, k});
  }
}

tl::expected<Linearisation, Unreachable> SingleReadings::linearise(const View& view,
                                                                   const Columns& columns) const {
  const std::vector<model::Setting> settings = settings_in(columns);
  const Machine& machine = view.chains().machine();
  Linearisation line;
  line.predicted.resize(rows());
  for (std::size_t k = 0; k < readings_.size(); ++k)
    line.predicted[as_index(k)] = predicted_reading(machine, readings_[k]);
  line.by_setting = Eigen::MatrixXd::Zero(rows(), std::ssize(settings));
  line.by_nuisance.resize(rows(), 0);
  for (std::size_t s = 0; s < settings.size(); ++s) {
    if (model::is_of_sheet(settings[s])) continue;
    const Machine moved =
        model::with_setting(machine, settings[s], model::stated_value(machine, settings[s]) + 1.0);
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      line.by_setting(as_index(k), as_index(s)) =
          predicted_reading(moved, readings_[k]) - predicted_reading(machine, readings_[k]);
    }
  }
  for (const ExtraReading& reading : readings_) {
    line.units.push_back({Eigen::MatrixXd::Constant(1, 1, reading.sigma * reading.sigma), {}});
  }
  return line;
}

std::string SingleReadings::untestable(const model::effects::Effect& effect,
                                       model::effects::EffectSide /*side*/) const {
  return fmt::format("readings of the machine's parts alone do not show {}", effect.id);
}

std::string SingleReadings::name_of(std::size_t unit) const {
  const ExtraReading& reading = readings_.at(unit);
  return reading.side.empty()
             ? fmt::format("the reading of {}", name(reading.what))
             : fmt::format("the reading of {} ({})", name(reading.what), reading.side);
}

}  // namespace chaintrue::grid::observation

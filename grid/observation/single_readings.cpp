// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/single_readings.hpp"

#include <map>
#include <variant>

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

}  // namespace chaintrue::grid::observation

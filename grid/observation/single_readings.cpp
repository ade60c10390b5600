// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/single_readings.hpp"

#include <cmath>
#include <stdexcept>
#include <variant>

#include "grid/observation/length_points.hpp"

namespace chaintrue::grid {
namespace {

/// Replaces those of the same name and side.
void replace_effect(Machine& machine, const AppliedEffect& by) {
  std::erase_if(machine.effects, [&](const AppliedEffect& applied) {
    return applied.effect == by.effect && applied.side == by.side;
  });
  machine.effects.push_back(by);
}

void take_ring_radius(Machine& machine, const ExtraReading& reading) {
  auto* ring = std::get_if<model::Ring>(&machine.attachment);
  if (ring == nullptr) return;
  const double stated = 1.0 / std::pow(machine.uncertainty.ring_radius_mm, 2);
  const double read = 1.0 / std::pow(reading.sigma, 2);
  ring->radius_mm = (stated * ring->radius_mm + read * reading.value) / (stated + read);
}

/// A reading replaces an elongation that was stated for the same chain.
void take_link_pitch(Machine& machine, const ExtraReading& reading) {
  replace_effect(machine, {"chain_pitch_error",
                           reading.side,
                           {{"elongation", reading.value / machine.sprocket.pitch_mm - 1.0}}});
}

/// A measured tape error replaces a stated one.
void take_tape_error(Machine& machine, const ExtraReading& reading) {
  const std::string side = reading.side.empty() ? "both" : reading.side;
  replace_effect(machine, {"tape_scale", side, {{"scale", 1e-3 * reading.value}}});
}

/// The first parameter of an effect, summed over the machine's own that act on the side.
double summed_size(const Machine& machine, std::string_view effect, const std::string& side) {
  double sum = 0.0;
  for (const AppliedEffect& applied : machine.effects) {
    if (applied.effect != effect) continue;
    if (!side.empty() && applied.side != "both" && applied.side != side) continue;
    sum += applied.parameters.begin()->second;
  }
  return sum;
}

struct ReadingKind {
  std::string_view name;
  /// Puts a reading into the machine; null for what its settings predict.
  void (*take)(Machine&, const ExtraReading&);
  /// Predicts the reading; null if no machine can.
  double (*predict)(const Machine&, const ExtraReading&);
};

const ReadingKind& reading_kind(ReadingOf what) {
  /// In the order of ReadingOf.
  static constexpr ReadingKind kReadingKinds[] = {
      {"beam_rise_mm", nullptr,
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.y_mm - m.motors.left.y_mm;
       }},
      {"chain_mass_kg_per_m",
       [](Machine& m, const ExtraReading& r) { m.chain.mass_kg_per_m = r.value; },
       [](const Machine& m, const ExtraReading&) {
         return m.chain.mass_kg_per_m * (1.0 + summed_size(m, "chain_sag", ""));
       }},
      {"link_pitch_mm", take_link_pitch,
       [](const Machine& m, const ExtraReading& r) {
         return m.sprocket.pitch_mm * (1.0 + summed_size(m, "chain_pitch_error", r.side));
       }},
      {"motor_spacing_mm", nullptr,
       [](const Machine& m, const ExtraReading&) {
         return m.motors.right.x_mm - m.motors.left.x_mm;
       }},
      {"ring_radius_mm", take_ring_radius,
       [](const Machine& m, const ExtraReading&) {
         const auto* ring = std::get_if<model::Ring>(&m.attachment);
         return (ring != nullptr ? ring->radius_mm : 0.0) + summed_size(m, "ring_radius", "");
       }},
      {"sled_mass_kg", [](Machine& m, const ExtraReading& r) { m.sled.mass_kg = r.value; },
       nullptr},
      {"tape_error_mm_per_m", take_tape_error,
       [](const Machine& m, const ExtraReading& r) {
         return 1000.0 * summed_size(m, "tape_scale", r.side);
       }},
  };
  return kReadingKinds[as_size(what)];
}

/// Readings of one quantity are combined, weighted by their sigmas, in the order of the first.
std::vector<ExtraReading> combined(const std::vector<ExtraReading>& readings) {
  std::vector<ExtraReading> result;
  for (const ExtraReading& reading : readings) {
    auto* same = find_where(result, [&](const ExtraReading& other) {
      return other.what == reading.what && other.side == reading.side;
    });
    if (same == nullptr) {
      result.push_back(reading);
      continue;
    }
    const double before = 1.0 / (same->sigma * same->sigma);
    const double more = 1.0 / (reading.sigma * reading.sigma);
    same->value = (before * same->value + more * reading.value) / (before + more);
    same->sigma = 1.0 / std::sqrt(before + more);
  }
  return result;
}

}  // namespace

std::string_view name(ReadingOf what) { return reading_kind(what).name; }

Machine with_readings(Machine machine, const std::vector<ExtraReading>& readings) {
  for (const ExtraReading& reading : combined(readings)) {
    if (reading_kind(reading.what).take != nullptr)
      reading_kind(reading.what).take(machine, reading);
  }
  return machine;
}

std::vector<ExtraReading> setting_readings(const std::vector<ExtraReading>& readings) {
  std::vector<ExtraReading> result = readings;
  std::erase_if(result,
                [](const ExtraReading& one) { return reading_kind(one.what).take != nullptr; });
  return result;
}

namespace observation {

const Kind single_readings{"single_readings", "reading", "readings", "", false};

bool is_predictable(const Machine& machine, const ExtraReading& reading) {
  if (reading_kind(reading.what).predict == nullptr) return false;
  return reading.what != ReadingOf::ring_radius ||
         std::holds_alternative<model::Ring>(machine.attachment);
}

double predicted_reading(const Machine& machine, const ExtraReading& reading) {
  const ReadingKind& own = reading_kind(reading.what);
  if (own.predict == nullptr)
    throw std::out_of_range("no machine predicts a reading of " + std::string(own.name));
  return own.predict(machine, reading);
}

}  // namespace observation
}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings of the machine itself: the motors' spacing with a tape, the beam's rise with a level,
/// a link's pitch with a caliper, a chain's mass on a scale, another tape against the one at hand.
/// Each is a careful single measurement with a stated sigma: one row each, none is rejected.
///
/// They are linear in the settings.
#pragma once

#include <fmt/format.h>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/observation/observation.hpp"
#include "grid/precondition.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::observation {

/// A machine predicts it: motor_spacing_mm, beam_rise_mm, ring_radius_mm (on a ring), link_pitch_mm,
/// chain_mass_kg_per_m, tape_error_mm_per_m.
bool is_predictable(const Machine& machine, const ExtraReading& reading);

/// The machine's prediction, with its effects, of what one would measure.
/// \throws std::out_of_range for a reading that no machine predicts.
double predicted_reading(const Machine& machine, const ExtraReading& reading);

class SingleReadings final : public Observation {
 public:
  /// Sorted by what is read. \throws std::invalid_argument for a sigma that is not positive.
  explicit SingleReadings(std::vector<ExtraReading> readings)
      : Observation(false, kInfinity, false), readings_(std::move(readings)) {
    sort(readings_, [](const ExtraReading& a, const ExtraReading& b) {
      return std::tie(a.what, a.side, a.value, a.sigma) <
             std::tie(b.what, b.side, b.value, b.sigma);
    });
    measured_.resize(std::ssize(readings_));
    for (const auto k : each_index(readings_)) {
      if (!(readings_[k].sigma > 0.0)) {
        throw precondition("a reading of {} with sigma {}; it must be positive",
                           name(readings_[k].what), readings_[k].sigma);
      }
      measured_(as_index(k)) = readings_[k].value;
      units_.push_back({as_index(k), 1, k});
    }
  }

  const Kind& kind() const override { return single_readings; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override {
    const std::vector<Setting> settings = settings_in(columns);
    const Machine& machine = view.chains().machine();
    Linearisation line = blank(std::ssize(settings));
    for (const auto k : each_index(readings_))
      line.predicted[as_index(k)] = predicted_reading(machine, readings_[k]);
    for (const auto s : each_index(settings)) {
      if (is_of_sheet(settings[s])) continue;
      const Machine moved =
          with_setting(machine, settings[s], stated_value(machine, settings[s]) + 1.0);
      for (const auto k : each_index(readings_)) {
        line.by_setting(as_index(k), as_index(s)) =
            predicted_reading(moved, readings_[k]) - predicted_reading(machine, readings_[k]);
      }
    }
    for (const ExtraReading& reading : readings_) {
      line.units.push_back({MatrixXd::Constant(1, 1, reading.sigma * reading.sigma), {}});
    }
    return line;
  }

  std::string untestable(const Effect& effect, EffectSide) const override {
    return fmt::format("readings of the machine's parts alone do not show {}", effect.id);
  }

  std::string name_of(std::size_t unit) const override {
    const ExtraReading& reading = readings_.at(unit);
    return reading.side.empty()
               ? fmt::format("the reading of {}", name(reading.what))
               : fmt::format("the reading of {} ({})", name(reading.what), reading.side);
  }

  const std::vector<ExtraReading>& readings() const { return readings_; }

 private:
  std::vector<ExtraReading> readings_;
};

}  // namespace chaintrue::grid::observation

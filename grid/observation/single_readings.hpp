// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Readings of the machine itself: the motors' spacing with a tape, the beam's rise with a level,
/// a link's pitch with a caliper, a chain's mass on a scale, another tape against the one at hand.
/// Each is a careful single measurement with a stated sigma: one row each, none is rejected.
///
/// They are linear in the settings.
#pragma once

#include "grid/observation/measured_grid.hpp"
#include "grid/observation/observation.hpp"

namespace chaintrue::grid::observation {

/// A machine predicts it: motor_spacing_mm, beam_rise_mm, ring_radius_mm (on a ring), link_pitch_mm,
/// chain_mass_kg_per_m, tape_error_mm_per_m.
[[nodiscard]] bool is_predictable(const model::Machine& machine, const ExtraReading& reading);

/// The machine's prediction, with its effects, of what one would measure.
/// \throws std::out_of_range for a reading that no machine predicts.
[[nodiscard]] double predicted_reading(const model::Machine& machine, const ExtraReading& reading);

class SingleReadings final : public Observation {
 public:
  /// Sorted by what is read. \throws std::invalid_argument for a sigma that is not positive.
  explicit SingleReadings(std::vector<ExtraReading> readings);

  [[nodiscard]] const Kind& kind() const override { return single_readings; }
  [[nodiscard]] tl::expected<Linearisation, Unreachable> linearise(
      const View& view, const Columns& columns) const override;
  [[nodiscard]] std::string untestable(const model::effects::Effect& effect,
                                       model::effects::EffectSide side) const override;
  [[nodiscard]] std::string name_of(std::size_t unit) const override;

  [[nodiscard]] const std::vector<ExtraReading>& readings() const { return readings_; }

 private:
  std::vector<ExtraReading> readings_;
};

}  // namespace chaintrue::grid::observation

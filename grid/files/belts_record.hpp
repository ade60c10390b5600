// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tables of a chaintrue_belts file, for the formats that hold one or its machine. Private to
/// grid/files.
#pragma once

#include "grid/belts/belts_and_holes.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/belts/measured_belts.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

inline constexpr Range kBeltLengthMm{"mm", 1.0, 20000.0};
inline constexpr Range kBeltDistanceMm{"mm", 1.0, 20000.0};

/// Includes the checks of model::problems_of.
[[nodiscard]] Record<model::BeltMachine> belt_machine_record();

[[nodiscard]] const Record<MeasuredBelts>& belts_record();

template <class V>
[[nodiscard]] Record<model::PerBelt<V>> per_belt_record(const Value<V>& value) {
  return Record<model::PerBelt<V>>("a value for each belt")
      .required("tl", "Top left.", &model::PerBelt<V>::tl, value)
      .required("tr", "Top right.", &model::PerBelt<V>::tr, value)
      .required("bl", "Bottom left.", &model::PerBelt<V>::bl, value)
      .required("br", "Bottom right.", &model::PerBelt<V>::br, value);
}

/// tl, tr, bl, br.
[[nodiscard]] inline Value<model::Belt> belt_word() { return by_name_to(model::Belt::br); }

[[nodiscard]] Record<BeltPrediction> prediction_record();
[[nodiscard]] Record<BeltScale> scale_record();
[[nodiscard]] Record<FirmwareFit> firmware_fit_record();
/// belt_holes_record.cpp.
[[nodiscard]] Record<HolesWithBelts> holes_with_belts_record();

}  // namespace chaintrue::grid::files

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

/// Includes the checks of model::problems_of.
Record<BeltMachine> belt_machine_record();

const Record<MeasuredBelts>& belts_record();

template <class V>
Record<PerBelt<V>> per_belt_record(const Value<V>& value) {
  RECORD(PerBelt<V>, "a value for each belt")
  REQUIRED(tl, "Top left.", value)
  REQUIRED(tr, "Top right.", value)
  REQUIRED(bl, "Bottom left.", value)
  REQUIRED(br, "Bottom right.", value);
}

/// tl, tr, bl, br.
inline Value<Belt> belt_word() { return by_name_to(Belt::br); }

Record<BeltPrediction> record_of(Of<BeltPrediction>);
Record<BeltScale> record_of(Of<BeltScale>);
Record<FirmwareFit> record_of(Of<FirmwareFit>);
/// belt_holes_record.cpp.
Record<HolesWithBelts> record_of(Of<HolesWithBelts>);

}  // namespace chaintrue::grid::files

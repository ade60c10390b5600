// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/compensation_map.hpp"

#include "model/calibration/setting.hpp"

namespace chaintrue::grid {

std::string_view name(NoiseSource source) {
  constexpr std::string_view kNames[] = {"stated", "repeats", "fit", "assumed"};
  return kNames[static_cast<std::size_t>(source)];
}

MapFailure unreachable(const model::MechanismFailure& why) {
  return MapFailure(MapReason::unreachable).because_of(why.reason.words);
}

std::string_view sentence_of(MapReason reason) {
  switch (reason) {
    case MapReason::outside_map:
      return "the point is off the bed that was measured";
    case MapReason::unreachable:
      return "the chains cannot hold the sled there";
    case MapReason::not_converged:
      break;
  }
  return "no point of the bed was found for these chain lengths";
}

std::optional<model::Machine> stated_machine(const CompensationMap& map) {
  if (map.machine() == nullptr) return std::nullopt;
  model::Machine machine = *map.machine();
  for (const SettingResult& result : map.contents().settings) {
    if (!model::is_of_sheet(result.setting))
      machine = model::with_setting(std::move(machine), result.setting, result.stated);
  }
  return machine;
}

}  // namespace chaintrue::grid

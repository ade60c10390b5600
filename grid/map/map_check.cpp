// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/map_check.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "grid/map/check_readings.hpp"
#include "grid/map/check_words.hpp"

namespace chaintrue::grid {
namespace {

std::string chain_words(const std::string& side) {
  return side == "both" ? std::string("both chains") : fmt::format("the {} chain", side);
}

std::string words_of_chains(const CheckHypothesis& h) {
  if (h.what == model::Change::zero && h.side == "both") {
    return fmt::format("the zeros have shifted, the left by {:+.2f} mm and the right by {:+.2f} mm",
                       h.added(0).value, h.added(1).value);
  }
  if (h.what == model::Change::zero) {
    return fmt::format("the zero of {} has shifted by {:+.2f} mm", chain_words(h.side), h.size());
  }
  if (h.what == model::Change::tooth) {
    return fmt::format("{} skipped {} {}: it reads {:.2f} mm too {}", chain_words(h.side),
                       std::abs(h.count) == 1 ? "one" : "two",
                       std::abs(h.count) == 1 ? "tooth" : "teeth", std::abs(h.size()),
                       h.count > 0 ? "much" : "little");
  }
  if (h.what == model::Change::pitch || h.what == model::Change::zeros_and_pitch) {
    const double growth = h.elongation(h.side == "right" ? 1 : 0).value;
    return fmt::format("the links of {} have grown by {:.3f} %{}", chain_words(h.side),
                       100.0 * growth,
                       h.what == model::Change::pitch ? "" : ", and the zeros have shifted");
  }
  return "a motor has moved";
}

/// A Maslow's firmware stores no zeros: they follow from where the chains are set.
bool sets_chains(const CompensationMap& map) {
  if (map.machine() == nullptr) return false;
  const model::ControllerKind kind = map.machine()->controller.kind;
  return kind == model::ControllerKind::maslow_classic || kind == model::ControllerKind::holey;
}

CheckWords words_of_map(bool sets_chains) {
  return {"the map",
          "points",
          "The map is still valid",
          "The map is valid after re-zeroing",
          "The map must be measured again",
          words_of_chains,
          [sets_chains](const Check& check) {
            return fmt::format("{}New zeros: left {:.2f} mm, right {:.2f} mm.",
                               sets_chains ? "Set the chain lengths again, with both sprockets' "
                                             "teeth at 12 o'clock (Actions, Set Chain Length), "
                                             "and check again. No number in the settings corrects "
                                             "this. "
                                           : "",
                               check.new_zero_mm[0], check.new_zero_mm[1]);
          }};
}

}  // namespace

tl::expected<Check, CheckFailure> check_map(const CompensationMap& map, const Measured& measured,
                                            const Progress& progress) {
  return check_readings(map, measured, progress).map([&](const CheckReadings& readings) {
    tell(progress, {"what may have changed", 2, 2});
    return judged(readings, words_of_map(sets_chains(map)));
  });
}

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/reading_record.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace chaintrue::grid::files {
namespace {

/// A measurement other than a point.
struct ReadingKind {
  const char* what;
  Range value;
  std::vector<std::string> sides = {};  ///< allowed sides; empty: none
};

const std::vector<ReadingKind>& reading_kinds() {
  static const std::vector<ReadingKind> kKinds = {
      {"motor_spacing_mm", {"mm", 500.0, 20000.0}},
      {"beam_rise_mm", {"mm", -1000.0, 1000.0}},
      {"ring_radius_mm", {"mm", 0.0, 1000.0}},
      {"sled_mass_kg", {"kg", 0.1, 200.0}},
      {"link_pitch_mm", {"mm", 1.0, 50.0}, {"left", "right", "both"}},
      {"chain_mass_kg_per_m", {"kg/m", 0.001, 10.0}},
      {"tape_error_mm_per_m", {"mm a metre", -50.0, 50.0}, {"x", "y", "both"}},
  };
  return kKinds;
}

std::vector<std::string> reading_names() {
  std::vector<std::string> names;
  for (const ReadingKind& kind : reading_kinds()) names.emplace_back(kind.what);
  return names;
}

void check_reading(const Cursor& at, ExtraReading& reading) {
  for (const ReadingKind& kind : reading_kinds()) {
    if (reading.what != kind.what) continue;
    if (at.child("value").clean()) (void)at.child("value").number(kind.value);
    const auto& sides = kind.sides;
    if (reading.side.empty() || !at.child("side").clean()) continue;
    if (sides.empty()) at.child("side").expect(fmt::format("no side, {} has none", kind.what));
    if (!sides.empty() && std::find(sides.begin(), sides.end(), reading.side) == sides.end()) {
      at.child("side").expect(fmt::format("{} for {}", fmt::join(sides, ", "), kind.what));
    }
  }
}

}  // namespace

const Record<ExtraReading>& reading_record() {
  constexpr double kAny = 1e6;
  constexpr double kSmallestSigma = 1e-9;
  static const auto record =
      Record<ExtraReading>("a reading")
          .required("what", &ExtraReading::what, one_of(reading_names()))
          .sparse("side", &ExtraReading::side, one_of({"left", "right", "both", "x", "y"}))
          .required("value", &ExtraReading::value, number({"", -kAny, kAny}))
          .required("sigma", &ExtraReading::sigma, number({"", kSmallestSigma, kAny}))
          .check(check_reading);
  return record;
}

}  // namespace chaintrue::grid::files

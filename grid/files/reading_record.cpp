// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/records.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

/// A measurement other than a point.
struct ReadingKind {
  ReadingOf what;
  Range value;
  Words sides = {};  ///< allowed sides; empty: none
};

const std::vector<ReadingKind>& reading_kinds() {
  static const std::vector<ReadingKind> kKinds = {
      {ReadingOf::motor_spacing, {"mm", 500.0, 20000.0}},
      {ReadingOf::beam_rise, {"mm", -1000.0, 1000.0}},
      {ReadingOf::ring_radius, {"mm", 0.0, 1000.0}},
      {ReadingOf::sled_mass, {"kg", 0.1, 200.0}},
      {ReadingOf::link_pitch, {"mm", 1.0, 50.0}, {"left", "right", "both"}},
      {ReadingOf::chain_mass, {"kg/m", 0.001, 10.0}},
      {ReadingOf::tape_error, {"mm per metre", -50.0, 50.0}, {"x", "y", "both"}},
  };
  return kKinds;
}

void check_reading(const Cursor& at, ExtraReading& reading) {
  if (!at.json().contains("what") || !at.child("what").clean()) return;
  for (const ReadingKind& kind : reading_kinds()) {
    if (reading.what != kind.what) continue;
    if (at.child("value").clean()) (void)number(kind.value).read(at.child("value"));
    const auto& sides = kind.sides;
    if (reading.side.empty() || !at.child("side").clean()) continue;
    if (sides.empty())
      at.child("side").expect(fmt::format("no side, because {} has none", name(kind.what)));
    if (!sides.empty() && !contains(sides, reading.side)) {
      at.child("side").expect(fmt::format("{} for {}", fmt::join(sides, ", "), name(kind.what)));
    }
  }
}

}  // namespace

Value<ReadingOf> reading_name() { return by_name(mapped(reading_kinds(), &ReadingKind::what)); }

Record<ExtraReading> reading_record() {
  constexpr double kAny = 1e6;
  constexpr double kSmallestSigma = 1e-9;
  RECORD(ExtraReading, "a reading")
  REQUIRED(what, "The quantity that was measured.", reading_name())
  SPARSE(side, "For a pitch: left, right or both; for a tape error: x, y or both.",
         one_of({"left", "right", "both", "x", "y"}))
  REQUIRED(value, "Its value, in the unit at the end of the quantity's name.", {"", -kAny, kAny})
  REQUIRED(sigma, "1 sigma, in the same unit.", {"", kSmallestSigma, kAny}).check(check_reading);
}

}  // namespace chaintrue::grid::files

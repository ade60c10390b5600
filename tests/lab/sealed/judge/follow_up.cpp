// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/follow_up.hpp"

#include "generator/hidden/random.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::MeasurementKind;
using grid::diagnosis::NextMeasurement;
using grid::diagnosis::Verdict;

bool measure(generator::SealedSet& set, grid::MeasuredGrid& grid, const NextMeasurement& next,
             generator::Dice& dice) {
  if (next.kind == MeasurementKind::reading) {
    const auto reading = set.machine.read(name(next.reading.value()), next.side, dice);
    if (!reading) return false;
    grid.readings.push_back({next.reading.value(), next.side, reading->value, reading->sigma});
    return true;
  }
  if (!next.mark) return false;
  const auto note = set.machine.measure({next.mark->x_mm, next.mark->y_mm}, set.noise, dice);
  if (!note) return false;
  grid::MeasuredPoint point;
  point.mark = {note->mark.x, note->mark.y};
  point.lengths = model::ChainLengths{note->lengths[0], note->lengths[1]};
  if (!grid.points.empty() && grid.points.front().order) point.order = note->number;
  grid.points.push_back(point);
  return true;
}

}  // namespace

bool follow_up(generator::SealedSet& set, grid::MeasuredGrid grid, Diagnosis found,
               const grid::diagnosis::DiagnosisOptions& how) {
  constexpr int kMeasurements = 8;
  generator::Dice dice(1, "follow-up");
  int measured = 0;
  while (measured < kMeasurements && found.verdict != Verdict::named) {
    const int before = measured;
    for (const NextMeasurement& next : found.next_measurements) {
      if (measured < kMeasurements && measure(set, grid, next, dice)) ++measured;
    }
    if (measured == before) break;
    auto again = grid::diagnosis::diagnose(grid, how);
    if (!again) break;
    found = std::move(*again);
  }
  const std::vector<Claim> named = named_causes(found);
  return found.verdict == Verdict::named && set.answer.hidden.size() == 1 &&
         named.front().means(id_of(set.answer.hidden.front()));
}

}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/follow_up.hpp"

namespace chaintrue::sealed {
namespace {

using grid::diagnosis::Diagnosis;
using grid::diagnosis::MeasurementKind;
using grid::diagnosis::NextMeasurement;
using grid::diagnosis::Verdict;

bool measure(generator::SealedSet& set,
             grid::MeasuredGrid& grid,
             const NextMeasurement& next,
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

bool single_right(const Diagnosis& found, const generator::SealedSet& set) {
  if (found.verdict != Verdict::named || found.causes.size() != 1) return false;
  if (set.answer.hidden.size() != 1) return false;
  const std::string truth = id_of(set.answer.hidden.front());
  const auto& cause = found.causes.front();
  if (id_of(cause.cause) == truth) return true;
  for (const auto& same : cause.same_as) {
    if (id_of(same.cause) == truth) return true;
  }
  return false;
}

}  // namespace

FollowUp follow_up(generator::SealedSet& set,
                   grid::MeasuredGrid grid,
                   Diagnosis found,
                   const grid::diagnosis::DiagnosisOptions& how,
                   int measurements) {
  generator::Dice dice(1, "follow-up");
  FollowUp result;
  while (result.measurements < measurements && found.verdict != Verdict::named) {
    bool any = false;
    for (const NextMeasurement& next : found.next_measurements) {
      if (result.measurements == measurements) break;
      if (!measure(set, grid, next, dice)) continue;
      ++result.measurements;
      any = true;
    }
    if (!any) break;
    auto again = grid::diagnosis::diagnose(grid, how);
    if (!again) break;
    found = std::move(*again);
  }
  result.single_right = single_right(found, set);
  return result;
}

}  // namespace chaintrue::sealed

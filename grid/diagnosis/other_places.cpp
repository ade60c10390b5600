// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/other_places.hpp"

#include "grid/raster.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The first part with chain readings at marks.
std::size_t chain_part(const ObservationSet& session) {
  const auto* found =
      find_where(session.parts, [](const auto& part) { return part.reads_chains(); });
  return as_size(found - session.parts.data());
}

const observation::ChainLengthReadings& readings_of(const ObservationSet& session,
                                                    std::size_t part) {
  return dynamic_cast<const observation::ChainLengthReadings&>(*session.parts[part].observation);
}

}  // namespace

interp::Rectangle marked_area(const ObservationSet& session) {
  const auto& places = readings_of(session, chain_part(session)).places();
  const model::MarkPoint first = places.front().mark;
  interp::Rectangle area{first.x_mm, first.x_mm, first.y_mm, first.y_mm};
  for (const observation::Place& place : places) take_in(area, place.mark);
  return area;
}

ObservationSet session_at(const Analysis& a, const std::vector<model::MarkPoint>& marks) {
  const ObservationSet& session = a.session;
  const std::size_t part = chain_part(session);
  const observation::ChainLengthReadings& own = readings_of(session, part);
  const model::ReadingModel model(a.state.machine);
  const model::SheetPlacement sheet = a.state.sheet_of(session.parts[part]);
  std::vector<observation::Place> places;
  for (const model::MarkPoint& mark : marks) {
    if (model.at(sheet.to_bed(mark))) places.push_back({0, "", mark, {}, 0});
  }
  // These places are not visited: no order.
  return with_observations(
      session, {{std::make_shared<const observation::ChainLengthReadings>(
                     observation::ChainLengthReadings::in_given_order(
                         std::move(places), false, own.noise(), own.noise_dof(), own.sheet())),
                 part}});
}

}  // namespace chaintrue::grid::diagnosis

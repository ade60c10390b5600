// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/uncalibrated.hpp"

#include "grid/diagnosis/observations.hpp"

namespace chaintrue::grid::diagnosis {

Eigen::VectorXd uncalibrated(const ObservationSet& session, const RegressorSystem& stated) {
  Eigen::VectorXd e = stated.e;
  for (const SystemUnit& unit : stated.units) {
    if (!unit.reads_chains) continue;
    const std::size_t number = unit.places.front().place;
    const ObservationPart& part = session.parts[session.places[number].part];
    const observation::Place& place = part.observation->places()[number - part.first_place];
    if (!place.commanded) continue;
    const Eigen::Vector2d displacement(place.commanded->x_mm - place.mark.x_mm,
                                 place.commanded->y_mm - place.mark.y_mm);
    e.segment<2>(unit.first_row) = unit.whitening * (stated.places[number].state.by_mark * displacement);
  }
  return e;
}

}  // namespace chaintrue::grid::diagnosis

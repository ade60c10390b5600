// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/chain_lengths.hpp"

#include <fmt/format.h>
#include <cmath>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"

namespace chaintrue::grid::observation {

const Kind chain_lengths{"chain_lengths", "point", "points", "point", true};

Matrix2d covariance_of(const PointNoise& noise, const Matrix2d& by_mark) {
  return std::pow(noise.length_mm, 2) * Matrix2d::Identity() +
         std::pow(noise.position_mm, 2) * by_mark * by_mark.transpose();
}

ChainLengthReadings::ChainLengthReadings(std::vector<Place> places, bool ordered, PointNoise noise,
                                         double noise_dof, std::optional<SheetPrior> sheet)
    : Observation(ordered, noise_dof), noise_(noise) {
  sheet_ = sheet;
  sort(places, ascending([](const Place& own) {
         return std::tie(own.order, own.mark.x_mm, own.mark.y_mm, own.lengths.left_mm,
                         own.lengths.right_mm);
       }));
  take(std::move(places));
}

ChainLengthReadings ChainLengthReadings::in_given_order(std::vector<Place> places, bool ordered,
                                                        PointNoise noise, double noise_dof,
                                                        std::optional<SheetPrior> sheet) {
  ChainLengthReadings readings({}, ordered, noise, noise_dof, sheet);
  readings.take(std::move(places));
  return readings;
}

tl::expected<VectorXd, Unreachable> ChainLengthReadings::predicted(const View& view) const {
  const model::MarkFrame frame(view.chains().machine());
  std::vector<model::Visit> visits;
  for (const auto i : each_index(places_)) {
    visits.push_back(
        {view.sheet.to_bed(frame.place(places_[i].mark)), ordered_ ? places_[i].order : as_int(i)});
  }
  const auto lengths = model::readings(view.chains(), visits);
  if (!lengths)
    return tl::unexpected(mechanism_failure(lengths.error().reason).at(lengths.error().place));
  VectorXd all(rows());
  for (const auto i : each_index(*lengths)) {
    all.segment<2>(2 * as_index(i)) =
        vector_of(view.corrected(places_[i].mark, (*lengths)[i], Matrix2d::Zero()).lengths);
  }
  return all;
}

tl::expected<Linearisation, Unreachable> ChainLengthReadings::linearise(
    const View& view, const Columns& columns) const {
  const std::vector<Setting> settings = settings_in(columns);
  const model::MarkFrame frame(view.chains().machine());
  Linearisation line = blank(std::ssize(settings));
  for (const auto i : each_index(places_)) {
    const MarkPoint place = frame.place(places_[i].mark);
    const auto reading = view.chains().at(view.sheet.to_bed(place));
    if (!reading) return tl::unexpected(mechanism_failure(reading.error()).at(i));
    const ChainPlaceState state = place_state(view, *reading, places_[i].mark);
    const auto row = 2 * as_index(i);
    line.predicted.segment<2>(row) = vector_of(state.lengths);
    line.by_setting.middleRows<2>(row) =
        state.by_length.asDiagonal() * lengths_by_setting(view, *reading, place, settings);
    line.units.push_back({covariance_of(noise_, state.by_mark), {{i, Matrix2d::Identity()}}});
    line.places.push_back(state);
  }
  return line;
}

std::string ChainLengthReadings::name_of(std::size_t unit) const {
  const Place& place = places_.at(unit);
  return fmt::format("point {} at ({:.1f}, {:.1f}) mm", place.name, place.mark.x_mm,
                     place.mark.y_mm);
}

void ChainLengthReadings::take(std::vector<Place> places) {
  places_ = std::move(places);
  measured_.resize(2 * std::ssize(places_));
  for (const auto i : each_index(places_)) {
    const auto row = 2 * as_index(i);
    measured_.segment<2>(row) = vector_of(places_[i].lengths);
    units_.push_back({row, 2, places_[i].index});
  }
}

}  // namespace chaintrue::grid::observation

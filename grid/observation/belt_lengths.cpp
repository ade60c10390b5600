// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/belt_lengths.hpp"

#include <algorithm>
#include <map>

#include "grid/precondition.hpp"

namespace chaintrue::grid::observation {

const Kind belt_lengths{"belt_lengths", "point", "points", "point", false};

namespace {

/// Rows that several places of a block share are in units of this many.
constexpr Index kBlockUnitRows = 2;

std::vector<LengthsAtPlace> sorted_readings(std::vector<LengthsAtPlace> places) {
  stable_sort(places, [](const auto& a, const auto& b) {
    if (a.visit.order != b.visit.order) return a.visit.order < b.visit.order;
    return std::lexicographical_compare(a.lengths_mm.begin(), a.lengths_mm.end(),
                                        b.lengths_mm.begin(), b.lengths_mm.end());
  });
  return places;
}

}  // namespace

BeltLengthReadings::BeltLengthReadings(std::vector<LengthsAtPlace> places, bool ordered,
                                       BeltNoise noise, double noise_dof,
                                       std::vector<TapedDistance> distances)
    : Observation(ordered, noise_dof),
      readings_(sorted_readings(std::move(places))),
      distances_(std::move(distances)),
      noise_(noise) {
  if (!(noise_.length_mm > 0.0 && noise_.position_mm >= 0.0)) {
    throw precondition("lengths with a sigma of {} mm at positions with {} mm", noise_.length_mm,
                       noise_.position_mm);
  }
  for (const LengthsAtPlace& own : readings_) {
    Place place;
    place.index = own.index;
    place.name = own.name;
    place.order = own.visit.order;
    if (own.known) place.mark = {own.known->x_mm, own.known->y_mm};
    places_.push_back(std::move(place));
  }
  join_places();
  std::vector<double> measured;
  for (const Block& block : blocks_) number_rows(block, measured);
  measured_ = Eigen::Map<const VectorXd>(measured.data(), std::ssize(measured));
}

/// Blocks: places with the distances between them, joined until no distance leads out of one.
void BeltLengthReadings::join_places() {
  const auto is_found = [this](std::size_t place) {
    return readings_[place].known || readings_[place].counted() >= 2;
  };
  std::map<std::size_t, std::size_t> place_of_index;
  for (const auto i : each_index(readings_)) place_of_index[readings_[i].index] = i;
  Indices first = numbers_below(readings_.size());  // of the places found with each
  // Of each distance that counts, a place at its end; places_.size(): it ends at none.
  std::vector<std::pair<std::size_t, std::size_t>> ends_at;
  for (const auto k : each_index(distances_)) {
    std::size_t at = readings_.size();
    bool counts = true;
    for (TapeEnd* end : {&distances_[k].from, &distances_[k].to}) {
      auto* place = std::get_if<AtPlace>(end);
      if (place == nullptr) continue;
      const auto number = place_of_index.find(place->index);
      counts = counts && number != place_of_index.end() && is_found(number->second);
      if (!counts) continue;
      place->index = number->second;
      const LengthsAtPlace& own = readings_[place->index];
      if (own.known || own.about)
        throw precondition("a distance to point {}, whose position is given", own.name);
      if (at < first.size()) {
        const auto [low, high] = std::minmax({first[at], first[place->index]});
        std::replace(first.begin(), first.end(), high, low);
      }
      at = place->index;
    }
    if (counts) ends_at.emplace_back(k, at);
  }
  Indices block_of(readings_.size());  // by its first place
  for (const auto i : each_index(readings_)) {
    if (!is_found(i)) continue;
    if (first[i] == i) {
      block_of[i] = blocks_.size();
      blocks_.emplace_back();
    }
    blocks_[block_of[first[i]]].places.push_back(i);
  }
  for (const auto& [distance, place] : ends_at) {
    if (place == readings_.size()) {
      blocks_.push_back({{}, {distance}});
    } else {
      blocks_[block_of[first[place]]].distances.push_back(distance);
    }
  }
}

void BeltLengthReadings::number_rows(const Block& block, std::vector<double>& measured) {
  first_unit_.push_back(units_.size());
  Index rows = 0;
  Index most = kBlockUnitRows;
  for (const std::size_t place : block.places) {
    const LengthsAtPlace& own = readings_[place];
    rows += own.counted() - (own.known ? 0 : 2);
  }
  if (block.places.size() == 1 && block.distances.empty()) most = std::max<Index>(rows, 1);
  rows += std::ssize(block.distances);
  const std::size_t place = block.places.empty() ? readings_.size() : block.places.front();
  const bool is_known = !block.places.empty() && readings_[place].known.has_value();
  for (Index row = 0; row < rows; row += most) {
    units_.push_back({std::ssize(measured), std::min(most, rows - row),
                      place < readings_.size() ? readings_[place].index : block.distances.front()});
    place_of_unit_.push_back(place);
    if (is_known) {
      const LengthsAtPlace& own = readings_[place];
      for (const Index i : each_below(own.lengths_mm.size())) {
        if (own.counts(i)) measured.push_back(own.lengths_mm[i]);
      }
    } else {
      measured.insert(measured.end(), as_size(units_.back().rows), 0.0);
    }
  }
}

}  // namespace chaintrue::grid::observation

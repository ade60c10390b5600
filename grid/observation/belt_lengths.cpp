// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/belt_lengths.hpp"

#include <algorithm>

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
  auto root = numbers_below(readings_.size());
  const auto root_of = [&root](std::size_t place) {
    while (root[place] != place) place = root[place] = root[root[place]];
    return place;
  };
  const auto is_found = [this](std::size_t place) {
    return readings_[place].known || readings_[place].counted() >= 2;
  };
  constexpr auto none = as_size(-1);
  Indices number_of(readings_.size(), none);
  for (std::size_t i = 0; i < readings_.size() && !distances_.empty(); ++i) {
    if (number_of.size() <= readings_[i].index) number_of.resize(readings_[i].index + 1, none);
    number_of[readings_[i].index] = i;
  }
  std::vector<std::optional<std::size_t>> block_place;  // of each distance; none: of no place
  Flags is_left_out;
  for (TapedDistance& distance : distances_) {
    std::optional<std::size_t> at;
    bool left_out = false;
    for (TapeEnd* end : {&distance.from, &distance.to}) {
      auto* place = std::get_if<AtPlace>(end);
      if (place == nullptr) continue;
      place->index = number_of.at(place->index);
      left_out = left_out || place->index == none || !is_found(place->index);
      if (left_out) continue;
      if (readings_[place->index].known || readings_[place->index].about)
        throw precondition("a distance to point {}, whose position is given",
                           readings_[place->index].name);
      if (at) root[root_of(place->index)] = root_of(*at);
      at = place->index;
    }
    block_place.push_back(at);
    is_left_out.push_back(left_out);
  }
  block_of_.assign(readings_.size(), none);
  Indices block_of_root(readings_.size(), none);
  for (const auto i : each_index(readings_)) {
    if (!is_found(i)) continue;
    std::size_t& block = block_of_root[root_of(i)];
    if (block == none) {
      block = blocks_.size();
      blocks_.emplace_back();
    }
    blocks_[block].places.push_back(i);
    block_of_[i] = block;
  }
  for (const auto k : each_index(distances_)) {
    if (is_left_out[k]) continue;
    if (block_place[k]) {
      blocks_[block_of_[*block_place[k]]].distances.push_back(k);
    } else {
      blocks_.push_back({{}, {k}});
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

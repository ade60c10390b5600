// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/belt_lengths.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::observation {

const Kind belt_lengths{"belt_lengths", "point", "points", "point", false};

namespace {

/// Rows that several places of a block share are in units of this many.
constexpr Eigen::Index kBlockUnitRows = 2;

std::vector<LengthsAtPlace> sorted_readings(std::vector<LengthsAtPlace> places) {
  stable_sort(places, [](const auto& a, const auto& b) {
    if (a.visit.order != b.visit.order) return a.visit.order < b.visit.order;
    return std::lexicographical_compare(
        a.lengths_mm.begin(), a.lengths_mm.end(), b.lengths_mm.begin(), b.lengths_mm.end());
  });
  return places;
}

Eigen::Index counting_lengths(const LengthsAtPlace& place) {
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < place.lengths_mm.size(); ++i) count += place.counts(i) ? 1 : 0;
  return count;
}

}  // namespace

BeltLengthReadings::BeltLengthReadings(std::vector<LengthsAtPlace> places,
                                       bool ordered,
                                       BeltNoise noise,
                                       double noise_dof,
                                       std::vector<TapedDistance> distances)
    : Observation(ordered, noise_dof),
      readings_(sorted_readings(std::move(places))),
      distances_(std::move(distances)),
      noise_(noise) {
  if (!(noise_.length_mm > 0.0 && noise_.position_mm >= 0.0)) {
    throw precondition("lengths with a sigma of {} mm at positions with {} mm",
                       noise_.length_mm,
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
  measured_ = Eigen::Map<const Eigen::VectorXd>(measured.data(), std::ssize(measured));
}

/// Blocks: places with the distances between them, joined until no distance leads out of one.
void BeltLengthReadings::join_places() {
  auto root = numbers_below(readings_.size());
  const auto root_of = [&root](std::size_t place) {
    while (root[place] != place) place = root[place] = root[root[place]];
    return place;
  };
  const auto is_found = [this](std::size_t place) {
    return readings_[place].known || counting_lengths(readings_[place]) >= 2;
  };
  constexpr auto none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> number_of(readings_.size(), none);
  for (std::size_t i = 0; i < readings_.size() && !distances_.empty(); ++i) {
    if (number_of.size() <= readings_[i].index) number_of.resize(readings_[i].index + 1, none);
    number_of[readings_[i].index] = i;
  }
  std::vector<std::optional<std::size_t>> block_place;  // of each distance; none: of no place
  std::vector<bool> is_left_out;
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
  std::vector<std::size_t> block_of_root(readings_.size(), none);
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    if (!is_found(i)) continue;
    std::size_t& block = block_of_root[root_of(i)];
    if (block == none) {
      block = blocks_.size();
      blocks_.emplace_back();
    }
    blocks_[block].places.push_back(i);
    block_of_[i] = block;
  }
  for (std::size_t k = 0; k < distances_.size(); ++k) {
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
  Eigen::Index rows = 0;
  Eigen::Index most = kBlockUnitRows;
  for (const std::size_t place : block.places) {
    const LengthsAtPlace& own = readings_[place];
    rows += counting_lengths(own) - (own.known ? 0 : 2);
  }
  if (block.places.size() == 1 && block.distances.empty()) most = std::max<Eigen::Index>(rows, 1);
  rows += std::ssize(block.distances);
  const std::size_t place = block.places.empty() ? readings_.size() : block.places.front();
  const bool is_known = !block.places.empty() && readings_[place].known.has_value();
  for (Eigen::Index row = 0; row < rows; row += most) {
    units_.push_back({std::ssize(measured),
                      std::min(most, rows - row),
                      place < readings_.size() ? readings_[place].index : block.distances.front()});
    place_of_unit_.push_back(place);
    if (is_known) {
      const LengthsAtPlace& own = readings_[place];
      for (Eigen::Index i = 0; i < own.lengths_mm.size(); ++i) {
        if (own.counts(i)) measured.push_back(own.lengths_mm[i]);
      }
    } else {
      measured.insert(measured.end(), as_size(units_.back().rows), 0.0);
    }
  }
}

/// rows_of() for four counted lengths at one place, the usual case, with matrices of fixed size.
BeltLengthReadings::BlockRows BeltLengthReadings::rows_of_four(const BlockLine& line) const {
  const Eigen::Matrix<double, 4, 2> by_position = line.by_position;
  const Eigen::Matrix4d q =
      Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>>(by_position).householderQ();
  const Eigen::Matrix<double, 2, 4> checks = q.rightCols<2>().transpose();
  const double variance = noise_.length_mm * noise_.length_mm;
  return {-checks * line.residual_mm,
          checks * line.by_parameter,
          variance * Eigen::Matrix2d::Identity(),
          checks};
}

tl::expected<BeltLengthReadings::BlockRows, Unreachable> BeltLengthReadings::rows_of(
    const View& view, const Block& block, bool with_parameters) const {
  const auto line = block_line(view, block, with_parameters);
  if (!line) return tl::unexpected(line.error());
  const bool is_alone = block.places.size() == 1 && block.distances.empty();
  if (is_alone && !readings_[block.places.front()].known && line->weight.size() == 4 &&
      line->weight.minCoeff() == 1.0)
    return rows_of_four(*line);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < line->weight.size(); ++i) {
    if (line->weight[i] > 0.0) rows.push_back(i);
  }
  const auto count = std::ssize(rows);
  const double variance = noise_.length_mm * noise_.length_mm;
  const Eigen::VectorXd root = line->weight(rows).cwiseSqrt();
  const Eigen::MatrixXd by_position = root.asDiagonal() * line->by_position(rows, Eigen::all);
  const Eigen::MatrixXd by_parameter = root.asDiagonal() * line->by_parameter(rows, Eigen::all);
  if (!block.places.empty() && readings_[block.places.front()].known) {
    const LengthsAtPlace& own = readings_[block.places.front()];
    return BlockRows{own.lengths_mm(rows) - line->residual_mm(rows),
                     by_parameter,
                     variance * Eigen::MatrixXd::Identity(count, count) +
                         noise_.position_mm * noise_.position_mm * linear::outer(by_position),
                     {}};
  }
  const Eigen::VectorXd residual = root.cwiseProduct(line->residual_mm(rows));
  const Eigen::Index left = count - by_position.cols();
  BlockRows result;
  if (is_alone) {
    const Eigen::MatrixXd checks = linear::qr(by_position).q.rightCols(left).transpose();  // Q'
    result = {-linear::product(checks, residual), linear::product(checks, by_parameter), {}, {}};
    result.by_reading = Eigen::MatrixXd::Zero(left, line->weight.size());
    result.by_reading(Eigen::all, rows) = checks;
  } else if (block.places.empty()) {
    result = {-residual, by_parameter, {}, {}};
  } else {
    const Eigen::MatrixXd checks = linear::qr(by_position).q.rightCols(left);  // Q
    result = {-linear::product(linear::transposed(checks), residual),
              linear::product(linear::transposed(checks), by_parameter),
              {},
              {}};
  }
  result.covariance = variance * Eigen::MatrixXd::Identity(left, left);
  return result;
}

tl::expected<BeltLengthReadings::UnitLine, Unreachable> BeltLengthReadings::line_of(
    const View& view, std::size_t unit) const {
  const std::size_t place = place_of_unit_.at(unit);
  if (place >= readings_.size() || !blocks_[block_of_[place]].distances.empty())
    throw precondition("unit {} is of places that a tape joins", unit);
  const Block& block = blocks_[block_of_[place]];
  auto rows = rows_of(view, block, true);
  if (!rows) return tl::unexpected(rows.error());
  const auto line = block_line(view, block, false);
  if (!line) return tl::unexpected(line.error());
  const LengthsAtPlace& own = readings_[place];
  Eigen::MatrixXd by_length = std::move(rows->by_reading);
  if (own.known) {
    by_length = Eigen::MatrixXd::Zero(rows->predicted.size(), own.lengths_mm.size());
    Eigen::Index row = 0;
    for (Eigen::Index i = 0; i < own.lengths_mm.size(); ++i)
      if (own.counts(i)) by_length(row++, i) = 1.0;
  }
  return UnitLine{std::move(rows->predicted),
                  std::move(rows->by_parameter),
                  std::move(rows->covariance),
                  std::move(by_length),
                  own.lengths_mm - line->residual_mm};
}

tl::expected<Linearisation, Unreachable> BeltLengthReadings::linearise(
    const View& view, const Columns& columns) const {
  const Eigen::Index parameters = columns.parameters ? view.mechanism->values().size() : 0;
  Linearisation result;
  result.predicted.resize(rows());
  result.by_setting = Eigen::MatrixXd::Zero(rows(), parameters + (columns.sheet ? 3 : 0));
  result.by_nuisance.resize(rows(), 0);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t end = end_unit(b);
    if (first_unit_[b] == end) continue;
    auto own = rows_of(view, blocks_[b], columns.parameters);
    if (!own) return tl::unexpected(own.error());
    const Eigen::Index first = units_[first_unit_[b]].first_row;
    result.predicted.segment(first, own->predicted.size()) = own->predicted;
    result.by_setting.block(first, 0, own->predicted.size(), parameters) = own->by_parameter;
    for (std::size_t u = first_unit_[b]; u < end; ++u) {
      const Eigen::Index at = units_[u].first_row - first;
      result.units.push_back(
          {own->covariance.block(at, at, units_[u].rows, units_[u].rows), {}, own->by_reading});
    }
  }
  return result;
}

std::shared_ptr<const Observation> BeltLengthReadings::about_others(
    const std::vector<UnitReading>& rejected) const {
  auto other = std::make_shared<BeltLengthReadings>(*this);
  for (LengthsAtPlace& place : other->readings_) place.rejected.clear();
  for (const UnitReading& one : rejected) {
    LengthsAtPlace& place = other->readings_.at(place_of_unit_.at(one.unit));
    if (place.rejected.empty()) place.rejected.assign(as_size(place.lengths_mm.size()), false);
    place.rejected.at(static_cast<std::size_t>(one.reading)) = true;
  }
  return other;
}

std::string BeltLengthReadings::untestable(const model::effects::Effect& effect,
                                           model::effects::EffectSide /*side*/) const {
  const bool needs_order = effect.needs == model::effects::DataNeed::order;
  return needs_order && !ordered_ ? "the order in which the points were visited is not known" : "";
}

std::string BeltLengthReadings::name_of(std::size_t unit) const {
  const std::size_t place = place_of_unit_.at(unit);
  if (place < places_.size()) return "point " + places_[place].name;
  return fmt::format("distance {}", units_.at(unit).index + 1);
}

}  // namespace chaintrue::grid::observation

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::observation {
namespace {

/// Lengths that the position is found from; empty: all.
Flags deciding_lengths(const LengthsAtPlace& place) {
  if (place.rejected.empty()) return place.counting;
  return mapped(each_below(place.lengths_mm.size()),
                [&](Index i) { return place.counts(i) && !place.rejected.at(as_size(i)); });
}

}  // namespace

tl::expected<BlockLine, Unreachable> BeltLengthReadings::line_at(
    const View& view, const Block& block, std::vector<ToolPosition> positions,
    bool with_parameters) const {
  const auto wanted = with_parameters ? model::Derivatives::by_position_and_parameter
                                      : model::Derivatives::by_position;
  const auto lengths = std::ssize(view.mechanism->lengths());
  const auto places = std::ssize(block.places);
  const Index rows = lengths * places + std::ssize(block.distances);
  const Index parameters = with_parameters ? view.mechanism->values().size() : 0;
  BlockLine line{std::move(positions), VectorXd(rows), MatrixXd::Zero(rows, 2 * places),
                 MatrixXd::Zero(rows, parameters), VectorXd(rows)};
  for (const Index p : each_below(places)) {
    const std::size_t place = block.places[as_size(p)];
    const LengthsAtPlace& own = readings_[place];
    const auto at = view.mechanism->predict(line.positions[as_size(p)], own.visit, wanted);
    if (!at) return tl::unexpected(at.error().at(place));
    const auto here = Eigen::seqN(lengths * p, lengths);
    line.residual_mm(here) = own.lengths_mm - at->lengths_mm;
    line.by_position.block(lengths * p, 2 * p, lengths, 2) = at->by_position;
    if (with_parameters) line.by_parameter.middleRows(lengths * p, lengths) = at->by_parameter;
    for (const Index i : each_below(lengths))
      line.weight[lengths * p + i] = own.counts(i) ? 1.0 : 0.0;
  }
  Index row = lengths * places;
  for (const std::size_t k : block.distances) {
    const TapedDistance& distance = distances_[k];
    std::array<std::optional<std::size_t>, 2> slots;  // of its ends, among the block's places
    std::array<ToolPosition, 2> ends;
    for (std::size_t e = 0; e < 2; ++e) {
      const auto* place = std::get_if<AtPlace>(e == 0 ? &distance.from : &distance.to);
      if (place == nullptr) continue;
      const auto at = std::lower_bound(block.places.begin(), block.places.end(), place->index);
      slots[e] = as_size(at - block.places.begin());
      ends[e] = line.positions[*slots[e]];
    }
    const auto own = distance_line(*view.mechanism, distance, ends);
    if (!own) {
      return tl::unexpected(own.error().at(block.places.empty() ? 0 : block.places.front()));
    }
    line.residual_mm[row] = distance.distance_mm - own->predicted_mm;
    for (std::size_t e = 0; e < 2; ++e) {
      if (slots[e]) line.by_position.block<1, 2>(row, 2 * as_index(*slots[e])) += own->by_end[e];
    }
    if (with_parameters) line.by_parameter.row(row) = own->by_parameter;
    line.weight[row++] = std::pow(noise_.length_mm / distance.sigma_mm, 2);
  }
  return line;
}

/// For places that distances join: Gauss-Newton, starting from the lengths alone.
tl::expected<void, Unreachable> BeltLengthReadings::find_positions(const View& view,
                                                                   const Block& block,
                                                                   BlockLine& line) const {
  // Distances that agree to some millimetres converge as lengths do, by 1e-3 a step.
  constexpr int kMostSteps = 100;
  constexpr double kConvergedMm = 1e-9;
  for (int step = 0; step < kMostSteps; ++step) {
    const MatrixXd weighed = line.weight.asDiagonal() * line.by_position;
    const VectorXd move = linear::PivotedCholesky(linear::inner(weighed, line.by_position))
                              .solve(linear::inner(weighed, line.residual_mm));
    if (!move.allFinite()) break;
    std::vector<ToolPosition> next = line.positions;
    for (const auto p : each_index(next)) {
      next[p].x_mm += move[2 * as_index(p)];
      next[p].y_mm += move[2 * as_index(p) + 1];
    }
    auto there = line_at(view, block, std::move(next), line.by_parameter.cols() > 0);
    if (!there) return failed(there);
    line = *std::move(there);
    if (move.norm() < kConvergedMm) return {};
  }
  constexpr model::MechanismReason kNotConverged{"not_converged",
                                                 "no position was found for these lengths"};
  return tl::unexpected(Unreachable(kNotConverged, block.places.front()));
}

tl::expected<BlockLine, Unreachable> BeltLengthReadings::block_line(const View& view,
                                                                    const Block& block,
                                                                    bool with_parameters) const {
  std::vector<ToolPosition> positions;
  for (const std::size_t place : block.places) {
    const LengthsAtPlace& own = readings_[place];
    if (own.known || own.about) {
      positions.push_back(own.known ? *own.known : *own.about);
      continue;
    }
    // Starts where all lengths together put it, or at the middle if they do not meet.
    const Flags deciding = deciding_lengths(own);
    auto position = view.mechanism->locate(own.lengths_mm, own.visit);
    if (!position || !deciding.empty()) {
      position =
          locate_by_newton(*view.mechanism, own.lengths_mm, own.visit,
                           position ? *position : view.mechanism->extent().centre(), deciding);
    }
    if (!position) return tl::unexpected(position.error().at(place));
    positions.push_back(*position);
  }
  auto line = line_at(view, block, std::move(positions), with_parameters);
  if (!line || block.distances.empty() || block.places.empty()) return line;
  if (auto found = find_positions(view, block, *line); !found) return failed(found);
  return line;
}

tl::expected<Linearisation, Unreachable> BeltLengthReadings::linearise(
    const View& view, const Columns& columns) const {
  const Index parameters = columns.parameters ? view.mechanism->values().size() : 0;
  Linearisation result = blank(parameters + (columns.sheet ? 3 : 0));
  for (const auto b : each_index(blocks_)) {
    const std::size_t end = b + 1 < blocks_.size() ? first_unit_[b + 1] : units_.size();
    if (first_unit_[b] == end) continue;
    auto own = rows_of(view, blocks_[b], columns.parameters);
    if (!own) return failed(own);
    const Index first = units_[first_unit_[b]].first_row;
    result.predicted.segment(first, own->predicted.size()) = own->predicted;
    result.by_setting.block(first, 0, own->predicted.size(), parameters) = own->by_parameter;
    for (std::size_t u = first_unit_[b]; u < end; ++u) {
      const Index at = units_[u].first_row - first;
      result.units.push_back(
          {own->covariance.block(at, at, units_[u].rows, units_[u].rows), {}, own->by_reading});
    }
  }
  return result;
}

std::string BeltLengthReadings::name_of(std::size_t unit) const {
  const std::size_t place = place_of_unit_.at(unit);
  if (place < places_.size()) return "point " + places_[place].name;
  return fmt::format("distance {}", units_.at(unit).index + 1);
}

std::shared_ptr<const Observation> BeltLengthReadings::about_others(
    const std::vector<UnitReading>& rejected) const {
  auto other = std::make_shared<BeltLengthReadings>(*this);
  for (LengthsAtPlace& place : other->readings_) place.rejected.clear();
  for (const UnitReading& one : rejected) {
    LengthsAtPlace& place = other->readings_.at(place_of_unit_.at(one.unit));
    if (place.rejected.empty()) place.rejected.assign(as_size(place.lengths_mm.size()), false);
    place.rejected.at(as_size(one.reading)) = true;
  }
  return other;
}

tl::expected<BeltLengthReadings::BlockRows, Unreachable> BeltLengthReadings::rows_of(
    const View& view, const Block& block, bool with_parameters) const {
  const auto line = block_line(view, block, with_parameters);
  if (!line) return failed(line);
  const LengthsAtPlace* first = block.places.empty() ? nullptr : &readings_[block.places.front()];
  const bool is_known = first != nullptr && first->known;
  const bool is_alone = block.places.size() == 1 && block.distances.empty();
  Rows rows;
  for (const Index i : each_below(line->weight.size())) {
    if (line->weight[i] > 0.0) rows.push_back(i);
  }
  const auto count = std::ssize(rows);
  const double variance = noise_.length_mm * noise_.length_mm;
  const VectorXd root = line->weight(rows).cwiseSqrt();
  const MatrixXd by_position = root.asDiagonal() * line->by_position(rows, Eigen::all);
  const MatrixXd by_parameter = root.asDiagonal() * line->by_parameter(rows, Eigen::all);
  if (is_known) {
    return BlockRows{first->lengths_mm(rows) - line->residual_mm(rows),
                     by_parameter,
                     variance * MatrixXd::Identity(count, count) +
                         noise_.position_mm * noise_.position_mm * linear::outer(by_position),
                     {}};
  }
  const Index left = count - by_position.cols();
  const MatrixXd checks =  // Q
      first == nullptr ? MatrixXd(MatrixXd::Identity(count, count))
                       : MatrixXd(linear::qr(by_position).q.rightCols(left));
  BlockRows result{-linear::inner(checks, VectorXd(root.cwiseProduct(line->residual_mm(rows)))),
                   linear::inner(checks, by_parameter),
                   variance * MatrixXd::Identity(left, left),
                   {}};
  if (is_alone) {
    result.by_reading = MatrixXd::Zero(left, line->weight.size());
    result.by_reading(Eigen::all, rows) = checks.transpose();
  }
  return result;
}

}  // namespace chaintrue::grid::observation

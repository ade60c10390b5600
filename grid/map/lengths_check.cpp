// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/lengths_check.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

void name_rows(const observation::BeltLengthReadings& observed, const Mechanism& mechanism,
               CheckReadings& readings) {
  for (const auto u : each_index(observed.units())) {
    const observation::Unit& unit = observed.units()[u];
    const std::string name = observed.name_of(u);
    const observation::LengthsAtPlace& place = observed.readings()[observed.place_of(u)];
    const auto rows = as_size(unit.rows);
    readings.units.push_back({name, unit.index, readings.names.size(), rows});
    for (std::size_t i = 0, row = 0; row < rows; ++i) {
      if (place.known && !place.counts(as_index(i))) continue;
      ++row;
      readings.names.push_back(place.known ? fmt::format("{}, {}", name, mechanism.lengths()[i])
                                           : fmt::format("{}, check {}", name, row));
    }
  }
}

/// The effect of a millimetre of each length at a place on the rows of its unit.
MatrixXd by_length_of(const observation::LengthsAtPlace& place,
                      const observation::UnitState& unit) {
  if (!place.known) return unit.by_reading;
  MatrixXd by_length = MatrixXd::Zero(unit.covariance.rows(), place.lengths_mm.size());
  Index row = 0;
  for (const Index i : each_below(by_length.cols())) {
    if (place.counts(i)) by_length(row++, i) = 1.0;
  }
  return by_length;
}

tl::expected<CheckReadings, CheckFailure> readings_of(
    const FittedMechanism& fitted, const observation::BeltLengthReadings& observed) {
  const observation::View view(fitted.mechanism);
  const auto line = observed.linearise(view, {.parameters = true});
  if (!line) {
    return failed(CheckReason::unreachable,
                  fmt::format("point {}: {}", observed.places()[line.error().place].name,
                              line.error().sentence()));
  }
  const auto lengths = std::ssize(fitted.mechanism->lengths());
  const auto units = std::ssize(observed.units());
  CheckReadings readings;
  readings.noise_dof = fitted.noise_dof;
  readings.lengths = as_size(lengths);
  readings.residual_mm = observed.measured() - line->predicted;
  readings.by_parameter = line->by_setting;
  readings.lengths_mm.resize(lengths * units);
  readings.by_length.resize(observed.rows(), lengths * units);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Index u : each_below(units)) {
    const observation::UnitState& unit = line->units[as_size(u)];
    const std::size_t at = observed.place_of(as_size(u));
    const observation::LengthsAtPlace& place = observed.readings()[at];
    // The place was found above.
    readings.lengths_mm.segment(lengths * u, lengths) =
        place.lengths_mm - observed.block_line(view, {{at}, {}}, false)->residual_mm;
    const MatrixXd by_length = by_length_of(place, unit);
    for (const Index i : each_below(by_length.rows())) {
      for (const Index k : each_below(lengths))
        entries.emplace_back(observed.units()[as_size(u)].first_row + i, lengths * u + k,
                             by_length(i, k));
    }
    readings.covariance.own.push_back(unit.covariance);
  }
  readings.by_length.setFromTriplets(entries.begin(), entries.end());
  readings.covariance.shared.resize(observed.rows(), 0);
  readings.covariance.of_map =
      narrowed(readings.by_parameter * linear::covariance_root(fitted.covariance));
  readings.changes = fitted.mechanism->possible_changes();
  name_rows(observed, *fitted.mechanism, readings);
  return readings;
}

}  // namespace

tl::expected<Check, CheckFailure> check_lengths(
    const FittedMechanism& fitted, const std::vector<observation::LengthsAtPlace>& places,
    const CheckWords& words) {
  const observation::BeltLengthReadings observed(
      places, false, {fitted.length_mm, fitted.position_mm}, fitted.noise_dof);
  if (observed.units().empty()) {
    return failed(CheckReason::no_lengths, "no place has a length that checks another");
  }
  return readings_of(fitted, observed).map([&](const CheckReadings& readings) {
    return judged(readings, words);
  });
}

}  // namespace chaintrue::grid

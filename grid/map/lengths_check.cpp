// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/lengths_check.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

void name_rows(const observation::BeltLengthReadings& observed,
               const model::Mechanism& mechanism,
               CheckReadings& readings) {
  for (std::size_t u = 0; u < observed.units().size(); ++u) {
    const observation::Unit& unit = observed.units()[u];
    const std::string name = observed.name_of(u);
    const observation::LengthsAtPlace& place = observed.readings()[observed.place_of(u)];
    const auto rows = as_size(unit.rows);
    readings.units.push_back({name, unit.index, readings.names.size(), rows});
    for (std::size_t i = 0, row = 0; row < rows; ++i) {
      if (place.known && !place.counting.empty() && !place.counting[i]) continue;
      ++row;
      readings.names.push_back(place.known ? fmt::format("{}, {}", name, mechanism.lengths()[i])
                                           : fmt::format("{}, check {}", name, row));
    }
  }
}

tl::expected<CheckReadings, CheckFailure> readings_of(
    const FittedMechanism& fitted, const observation::BeltLengthReadings& observed) {
  const auto lengths = std::ssize(fitted.mechanism->lengths());
  const auto units = std::ssize(observed.units());
  CheckReadings readings;
  readings.noise_dof = fitted.noise_dof;
  readings.lengths = as_size(lengths);
  readings.residual_mm.resize(observed.rows());
  readings.lengths_mm.resize(lengths * units);
  readings.by_parameter.resize(observed.rows(), fitted.mechanism->values().size());
  readings.by_length.resize(observed.rows(), lengths * units);
  const observation::View view(fitted.mechanism);
  std::vector<Eigen::Triplet<double>> by_length;
  for (Eigen::Index u = 0; u < units; ++u) {
    const observation::Unit& unit = observed.units()[as_size(u)];
    auto line = observed.line_of(view, as_size(u));
    if (!line) {
      return failed(CheckReason::unreachable,
                    fmt::format("{}: {}", observed.name_of(as_size(u)), line.error().sentence()));
    }
    readings.residual_mm.segment(unit.first_row, unit.rows) =
        observed.measured().segment(unit.first_row, unit.rows) - line->predicted;
    readings.by_parameter.middleRows(unit.first_row, unit.rows) = line->by_parameter;
    readings.lengths_mm.segment(lengths * u, lengths) = line->lengths_mm;
    for (Eigen::Index i = 0; i < unit.rows; ++i) {
      for (Eigen::Index k = 0; k < lengths; ++k)
        by_length.emplace_back(unit.first_row + i, lengths * u + k, line->by_length(i, k));
    }
    readings.covariance.own.push_back(std::move(line->covariance));
  }
  readings.by_length.setFromTriplets(by_length.begin(), by_length.end());
  readings.covariance.shared.resize(observed.rows(), 0);
  readings.covariance.of_map =
      narrowed(readings.by_parameter * linear::covariance_root(fitted.covariance));
  readings.changes = fitted.mechanism->possible_changes();
  name_rows(observed, *fitted.mechanism, readings);
  return readings;
}

}  // namespace

tl::expected<Check, CheckFailure> check_lengths(
    const FittedMechanism& fitted,
    const std::vector<observation::LengthsAtPlace>& places,
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/lengths_check.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid {
namespace {

/// Numbers of the lengths that are used.
ColumnSet counted(const observation::LengthsAtPlace& place) {
  auto lengths = numbers_below<Index>(place.lengths_mm.size());
  std::erase_if(lengths, [&](Index i) { return !place.counts(i); });
  return lengths;
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
    const observation::Unit& rows = observed.units()[as_size(u)];
    const std::size_t at = observed.place_of(as_size(u));
    const observation::LengthsAtPlace& place = observed.readings()[at];
    // The place was found above.
    readings.lengths_mm.segment(lengths * u, lengths) =
        place.lengths_mm - observed.block_line(view, {{at}, {}}, false)->residual_mm;
    const ColumnSet own = counted(place);
    const std::string name = observed.name_of(as_size(u));
    MatrixXd by_length = unit.by_reading;
    if (place.known) by_length = MatrixXd::Identity(lengths, lengths)(own, Eigen::all);
    for (const Index i : each_below(rows.rows)) {
      for (const Index k : each_below(lengths))
        entries.emplace_back(rows.first_row + i, lengths * u + k, by_length(i, k));
      readings.names.push_back(
          place.known
              ? fmt::format("{}, {}", name, fitted.mechanism->lengths()[as_size(own[as_size(i)])])
              : fmt::format("{}, check {}", name, i + 1));
    }
    readings.covariance.own.push_back(unit.covariance);
    readings.units.push_back({name, rows.index, as_size(rows.first_row), as_size(rows.rows)});
  }
  readings.by_length.setFromTriplets(entries.begin(), entries.end());
  readings.covariance.shared.resize(observed.rows(), 0);
  readings.covariance.of_map =
      narrowed(readings.by_parameter * linear::covariance_root(fitted.covariance));
  readings.changes = fitted.mechanism->possible_changes();
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

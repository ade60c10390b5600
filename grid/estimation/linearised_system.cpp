// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/linearised_system.hpp"

#include "grid/containers.hpp"

namespace chaintrue::grid::estimation {
namespace {

using observation::Linearisation;
using observation::Observation;

void add_places(const ObservationSet& set, std::size_t number, const Linearisation& line,
                LinearisedSystem& system) {
  const ObservationPart& part = set.parts[number];
  for (const auto i : each_index(line.places)) {
    const NumberedPlace& place = set.places[part.first_place + i];
    system.places.push_back({number, i, line.places[i], place.mark, place.order,
                             part.reads_chains() && part.observation->ordered(), set.stated.bed});
  }
}

/// `predicted` is f.
void add_units(const ObservationSet& set, std::size_t number, const Linearisation& line,
               const VectorXd& predicted, const VectorXd& settings, LinearisedSystem& system) {
  const ObservationPart& part = set.parts[number];
  const Observation& observation = *part.observation;
  const auto columns = set.columns_of(part);
  for (std::size_t u = 0; u < line.units.size(); ++u) {
    const observation::Unit& rows = observation.units()[u];
    const auto there = Eigen::seqN(rows.first_row, rows.rows);
    const VectorXd residual = observation.measured()(there) - predicted(there);
    const MatrixXd by_setting = line.by_setting(there, Eigen::all);
    SystemUnit unit{number,
                    u,
                    part.first_row + rows.first_row,
                    rows.rows,
                    unit_whitening(line.units[u].covariance),
                    part.reads_chains()};
    const MatrixXd& w = unit.whitening;
    const auto own = Eigen::seqN(unit.first_row, unit.rows);
    system.e(own) = w * residual;
    system.response(own) = w * (residual + by_setting * settings).eval();
    system.by_setting(own, columns) = w * by_setting;
    system.by_setting(own, part.nuisance_columns) =
        w * line.by_nuisance.middleRows(rows.first_row, rows.rows);
    for (const observation::PlaceColumns& place : line.units[u].places) {
      unit.places.push_back({part.first_place + place.place, w * place.by_chain});
      if (!part.zero_columns.empty())
        system.by_setting(own, part.zero_columns) += unit.places.back().by_chain;
    }
    if (line.units[u].by_reading.size() > 0) unit.by_reading = w * line.units[u].by_reading;
    const bool may_be_outlier = observation.may_be_outlier();
    auto& units = may_be_outlier ? system.units : system.certain;
    for (const Index k : each_below(unit.rows)) {
      system.unit_of_row[as_size(unit.first_row + k)] = may_be_outlier ? as_int(units.size()) : -1;
    }
    units.push_back(std::move(unit));
  }
}

}  // namespace

Vector2d SystemUnit::whitened(const VectorXd& all) const {
  Vector2d result = Vector2d::Zero();
  result.head(rows) = whitening * segment(all);
  return result;
}

Vector2d SystemUnit::unwhitened(const VectorXd& all) const {
  Vector2d result = Vector2d::Zero();
  result.head(rows) = whitening.inverse() * segment(all);
  return result;
}

tl::expected<LinearisedSystem, UnreachablePlace> linearise(const ObservationSet& set,
                                                           const std::vector<ObservedFrom>& from,
                                                           Prediction prediction) {
  LinearisedSystem system;
  system.e.resize(set.rows);
  system.response.resize(set.rows);
  system.by_setting = MatrixXd::Zero(set.rows, set.stated_value.size());
  system.nuisances = set.nuisances();
  system.unit_of_row.resize(as_size(set.rows));
  for (const auto k : each_index(set.parts)) {
    const Observation& observation = *set.parts[k].observation;
    const auto fail = [k](const observation::Unreachable& why) {
      return tl::unexpected(why.at(PlaceOfObservation{k, why.place}));
    };
    const auto line = observation.linearise(from[k].view, observation::columns_of(observation));
    if (!line) return fail(line.error());
    const auto predicted = prediction == Prediction::place_by_place
                               ? line->predicted
                               : observation.predicted(from[k].view);
    if (!predicted) return fail(predicted.error());
    add_places(set, k, *line, system);
    add_units(set, k, *line, *predicted, from[k].settings, system);
  }
  return system;
}

VectorXd whitened(const LinearisedSystem& system, VectorXd all) {
  for (const auto* units : {&system.units, &system.certain}) {
    for (const SystemUnit& unit : *units) {
      const Vector2d own = unit.whitened(all);
      all.segment(unit.first_row, unit.rows) = own.head(unit.rows);
    }
  }
  return all;
}

}  // namespace chaintrue::grid::estimation

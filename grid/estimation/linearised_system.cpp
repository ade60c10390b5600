// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/linearised_system.hpp"

#include "grid/containers.hpp"

namespace chaintrue::grid::estimation {
namespace {

using observation::Linearisation;
using observation::Observation;

class Assembly {
 public:
  explicit Assembly(const ObservationSet& set) : set_(set) {
    const Eigen::Index columns = set.stated_value.size();
    system_.e.resize(set.rows);
    system_.response.resize(set.rows);
    system_.by_setting = Eigen::MatrixXd::Zero(set.rows, columns);
    system_.nuisances = set.nuisances();
    system_.unit_of_row.assign(as_size(set.rows), -1);
  }

  /// `predicted` is f.
  void add(std::size_t number,
           const Linearisation& line,
           const Eigen::VectorXd& predicted,
           const Eigen::VectorXd& settings) {
    const ObservationPart& part = set_.parts[number];
    const Observation& observation = *part.observation;
    add_places(number, line);
    const auto columns = set_.columns_of(part);
    for (std::size_t u = 0; u < line.units.size(); ++u) {
      const observation::Unit& rows = observation.units()[u];
      const Eigen::VectorXd residual = observation.measured().segment(rows.first_row, rows.rows) -
                                       predicted.segment(rows.first_row, rows.rows);
      const Eigen::MatrixXd by_setting = line.by_setting.middleRows(rows.first_row, rows.rows);
      SystemUnit unit;
      unit.observation = number;
      unit.unit = u;
      unit.first_row = part.first_row + rows.first_row;
      unit.rows = rows.rows;
      unit.whitening = UnitWhitening(line.units[u].covariance);
      unit.reads_chains = part.reads_chains();
      const UnitWhitening& w = unit.whitening;
      const auto own = Eigen::seqN(unit.first_row, unit.rows);
      system_.e(own) = w * residual;
      system_.response(own) = w * (residual + by_setting * settings).eval();
      system_.by_setting(own, columns) = w * by_setting;
      system_.by_setting(own, part.nuisance_columns) =
          w * line.by_nuisance.middleRows(rows.first_row, rows.rows);
      for (const observation::PlaceColumns& place : line.units[u].places) {
        unit.places.push_back({part.first_place + place.place, w * place.by_chain});
        if (!part.zero_columns.empty())
          system_.by_setting(own, part.zero_columns) += unit.places.back().by_chain;
      }
      if (line.units[u].by_reading.size() > 0) unit.by_reading = w * line.units[u].by_reading;
      take(std::move(unit), observation.may_be_outlier());
    }
  }

  LinearisedSystem finish() { return std::move(system_); }

 private:
  void add_places(std::size_t number, const Linearisation& line) {
    const ObservationPart& part = set_.parts[number];
    for (std::size_t i = 0; i < line.places.size(); ++i) {
      const NumberedPlace& place = set_.places[part.first_place + i];
      system_.places.push_back({number,
                                i,
                                line.places[i],
                                place.mark,
                                place.order,
                                part.reads_chains() && part.observation->ordered(),
                                set_.stated.bed});
    }
  }

  void take(SystemUnit unit, bool may_be_outlier) {
    if (!may_be_outlier) {
      system_.certain.push_back(std::move(unit));
      return;
    }
    for (Eigen::Index k = 0; k < unit.rows; ++k) {
      system_.unit_of_row[as_size(unit.first_row + k)] = static_cast<int>(system_.units.size());
    }
    system_.units.push_back(std::move(unit));
  }

  const ObservationSet& set_;
  LinearisedSystem system_;
};

}  // namespace

Eigen::Vector2d SystemUnit::whitened(const Eigen::VectorXd& all) const {
  Eigen::Vector2d result = Eigen::Vector2d::Zero();
  result.head(rows) = whitening * segment(all);
  return result;
}

Eigen::Vector2d SystemUnit::unwhitened(const Eigen::VectorXd& all) const {
  Eigen::Vector2d result = Eigen::Vector2d::Zero();
  result.head(rows) = whitening.inverse() * segment(all);
  return result;
}

tl::expected<LinearisedSystem, UnreachablePlace> linearise(const ObservationSet& set,
                                                           const std::vector<ObservedFrom>& from,
                                                           Prediction prediction) {
  Assembly assembly(set);
  for (std::size_t k = 0; k < set.parts.size(); ++k) {
    const Observation& observation = *set.parts[k].observation;
    const auto line = observation.linearise(from[k].view, observation::columns_of(observation));
    if (!line) return tl::unexpected(line.error().at(PlaceOfObservation{k, line.error().place}));
    if (prediction == Prediction::place_by_place) {
      assembly.add(k, *line, line->predicted, from[k].settings);
      continue;
    }
    const auto predicted = observation.predicted(from[k].view);
    if (!predicted) {
      return tl::unexpected(predicted.error().at(PlaceOfObservation{k, predicted.error().place}));
    }
    assembly.add(k, *line, *predicted, from[k].settings);
  }
  return assembly.finish();
}

Eigen::VectorXd whitened(const LinearisedSystem& system, Eigen::VectorXd all) {
  for (const auto* units : {&system.units, &system.certain}) {
    for (const SystemUnit& unit : *units) {
      const Eigen::Vector2d own = unit.whitened(all);
      all.segment(unit.first_row, unit.rows) = own.head(unit.rows);
    }
  }
  return all;
}

}  // namespace chaintrue::grid::estimation

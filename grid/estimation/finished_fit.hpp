// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The estimate that the last fit of a problem leads to. Private to grid/estimation.
#pragma once

#include <cmath>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/left_out.hpp"
#include "grid/failed.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::estimation {

struct FinishedFit {
  const JointProblem& problem;
  const interp::PenalisedFit& fit;
  const State& state;
  const VectorXd& weights;
  const VectorXd& distances;  ///< of units; those with fixed weights are found here
  const std::vector<std::vector<MarkPoint>>& as_stated;
  VectorXd values = problem.values(fit);
  MatrixXd covariance = problem.covariance(fit);

  [[nodiscard]] tl::expected<Estimate, EstimationFailure> estimate() const {
    const EstimationInput& input = problem.input();
    Estimate estimate{.machine = input.machine, .surface = state.surface};
    estimate.mechanism = problem.mechanism_at(values);
    if (const auto* chains = dynamic_cast<const ReadingModel*>(estimate.mechanism.get())) {
      estimate.machine = chains->machine();
      estimate.settings =
          observation::settings_in(observation::columns_of(*input.observations.front()));
    }
    estimate.has_surface = problem.has_surface();
    estimate.noise_factor = std::sqrt(fit.sigma2);
    estimate.effective_parameters = fit.edf;
    fill_covariances(estimate);
    fill_units(estimate);
    if (auto done = fill_observations(estimate); !done) return failed(done);
    return estimate;
  }

 private:
  void fill_covariances(Estimate& estimate) const {
    const Unknowns& unknowns = problem.unknowns();
    estimate.columns = {problem.settings(), estimate.surface.basis.size()};
    // The first settings, and as many columns after all those of the set.
    const auto with = [&](Index settings, Index after) {
      auto columns = numbers_below<Index>(settings);
      for (const Index i : each_below(after)) columns.push_back(unknowns.of_set + i);
      return columns;
    };
    const auto of_map = with(problem.settings(), values.size() - unknowns.of_set);
    estimate.map_unknowns = values(with(problem.settings(), unknowns.scales));
    estimate.covariance = covariance(of_map, of_map);
    const auto own = with(problem.set().parameters(), unknowns.scales);
    estimate.knowledge = {values(own), covariance(own, own)};
    if (!problem.has_surface()) return;
    // What no place observes keeps its prior.
    const MatrixXd unobserved =
        fit.inverse_lambda * linear::outer(problem.observed()->null_space);
    for (const Side side : kSides) {
      const Index first = estimate.columns.spline(side);
      estimate.covariance.block(first, first, unobserved.rows(), unobserved.cols()) += unobserved;
    }
  }

  void fill_units(Estimate& estimate) const {
    const EstimationInput& input = problem.input();
    const LeftOut left_out(problem, fit, weights);
    for (const auto u : each_index(problem.units())) {
      const SystemUnit& unit = problem.units()[u];
      const auto at = as_index(u);
      const MatrixXd back = unit.whitening.inverse();
      const double distance = input.fixed_weights ? left_out.distance(u) : distances[at];
      const auto [residual, own_covariance] = left_out.conditioned(u);
      estimate.units.push_back({unit.observation,
                                unit.unit,
                                weights[at],
                                distance,
                                back * left_out.residual_of(u),
                                back * residual,
                                linear::carried(back, own_covariance),
                                {}});
    }
    for (const Shift& one : shifts(problem, fit, true)) {
      const SystemUnit& unit = problem.units()[one.at.unit];
      estimate.rejected_readings.push_back(
          {unit.observation, {unit.unit, one.at.reading}, one.residual_mm, one.sigmas});
    }
    for (const UnitGroup& group : input.held_out_together) {
      const VectorXd residuals = left_out.residuals(group);
      Index row = 0;
      for (const std::size_t u : group) {
        const SystemUnit& unit = problem.units()[u];
        estimate.units[u].left_out_with_group =
            unit.whitening.inverse() * residuals.segment(row, unit.rows);
        row += unit.rows;
      }
    }
  }

  tl::expected<void, EstimationFailure> fill_observations(Estimate& estimate) const {
    const VectorXd sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    const auto corrections = problem.corrections_of(state);
    for (const auto k : each_index(problem.set().parts)) {
      const ObservationPart& part = problem.set().parts[k];
      ObservationEstimate own;
      own.sheet = problem.sheet_at(values, k);
      const auto line =
          part.observation->linearise({estimate.mechanism, own.sheet, &corrections[k]}, {});
      if (!line) {
        return tl::unexpected(
            problem.unreachable(line.error().at(PlaceOfObservation{k, line.error().place})));
      }
      own.predicted = line->predicted;
      if (!part.zero_columns.empty()) {
        const Vector2d zeros = values(part.zero_columns);
        const Vector2d zero_sigma = sigma(part.zero_columns);
        own.zeros = {{{zeros[0], zero_sigma[0]}, {zeros[1], zero_sigma[1]}}};
        for (const auto u : each_index(line->units)) {
          const observation::Unit& rows = part.observation->units()[u];
          for (const observation::PlaceColumns& place : line->units[u].places)
            own.predicted.segment(rows.first_row, rows.rows) += place.by_chain * zeros;
        }
      }
      for (const auto i : each_index(line->places)) {
        const observation::ChainPlaceState& place = line->places[i];
        own.places.push_back({as_stated[k][i], place.mark, place.by_mark, place.reading.lengths});
      }
      own.nuisance = values(part.nuisance_columns);
      own.nuisance_sigma = sigma(part.nuisance_columns);
      estimate.observations.push_back(std::move(own));
    }
    return {};
  }
};

}  // namespace chaintrue::grid::estimation

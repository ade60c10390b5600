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

/// The part of a map's covariance that the places observe, and the part that keeps its prior.
inline MatrixXd map_covariance(const JointProblem& problem, const interp::PenalisedFit& fit,
                               const FitColumns& columns) {
  const Unknowns& unknowns = problem.unknowns();
  const ObservedSubspace* observed = problem.observed();
  MatrixXd to_splines = MatrixXd::Zero(columns.total(), unknowns.total());
  to_splines.topLeftCorner(columns.settings, columns.settings).setIdentity();
  for (const Side side : kSides) {
    if (unknowns.scales == 0) break;
    to_splines(columns.scale(side), unknowns.scale(side)) = 1.0;
    if (observed == nullptr) continue;
    auto spline = to_splines.middleRows(columns.spline(side), columns.basis);
    spline.middleCols(unknowns.polynomial(side), unknowns.polynomials) = observed->polynomials;
    spline.middleCols(unknowns.first_penalised_of(side), unknowns.penalised) = observed->penalised;
  }
  MatrixXd result = linear::carried(to_splines, problem.covariance(fit));
  if (observed == nullptr) return result;
  const MatrixXd unobserved =
      fit.inverse_lambda * observed->null_space * observed->null_space.transpose();
  for (const Side side : kSides) {
    result.block(columns.spline(side), columns.spline(side), columns.basis, columns.basis) +=
        unobserved;
  }
  return result;
}

struct FinishedFit {
  const JointProblem& problem;
  const interp::PenalisedFit& fit;
  const State& state;
  const VectorXd& weights;
  const VectorXd& distances;  ///< of units; those with fixed weights are found here
  const std::vector<std::vector<MarkPoint>>& as_stated;

  [[nodiscard]] tl::expected<Estimate, EstimationFailure> estimate() const {
    const EstimationInput& input = problem.input();
    Estimate estimate{.machine = input.machine, .surface = state.surface};
    estimate.mechanism = problem.mechanism_at(problem.coefficients(fit));
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
    estimate.covariance = map_covariance(problem, fit, estimate.columns);
    const VectorXd coefficients = problem.coefficients(fit);
    const auto with_scales = [&](Index settings) {
      auto columns = numbers_below<Index>(settings);
      for (const Index i : each_below(unknowns.scales)) columns.push_back(unknowns.of_set + i);
      return columns;
    };
    estimate.map_unknowns = coefficients(with_scales(problem.settings()));
    const auto own = with_scales(problem.set().parameters());
    estimate.knowledge = {coefficients(own), problem.covariance(fit)(own, own)};
  }

  void fill_units(Estimate& estimate) const {
    const EstimationInput& input = problem.input();
    const LeftOut left_out(problem, fit, weights);
    for (const auto u : each_index(problem.units())) {
      const SystemUnit& unit = problem.units()[u];
      const auto at = as_index(u);
      const MatrixXd back = unit.whitening.inverse();
      const double distance = input.fixed_weights ? left_out.distance(u) : distances[at];
      UnitEstimate own{unit.observation, unit.unit, weights[at], distance, {}, {}, {}, {}};
      own.residual = back * left_out.residual_of(u);
      const LeftOut::Conditioned conditioned = left_out.conditioned(u);
      own.left_out = back * conditioned.residual;
      own.left_out_covariance = linear::carried(back, conditioned.covariance);
      estimate.units.push_back(std::move(own));
    }
    for (const Shift& one : shifts(problem, fit, true)) {
      const SystemUnit& unit = problem.units()[one.at.unit];
      estimate.rejected_readings.push_back(
          {unit.observation, {unit.unit, one.at.reading}, one.residual_mm, one.sigmas});
    }
    for (const UnitGroup& group : input.held_out_together) {
      const auto residuals = left_out.residuals(group);
      for (const auto k : each_index(group)) {
        estimate.units[group[k]].left_out_with_group =
            problem.units()[group[k]].whitening.inverse() * residuals[k];
      }
    }
  }

  tl::expected<void, EstimationFailure> fill_observations(Estimate& estimate) const {
    const VectorXd coefficients = problem.coefficients(fit);
    const VectorXd sigma = problem.covariance(fit).diagonal().cwiseMax(0.0).cwiseSqrt();
    const auto corrections = problem.corrections_of(state);
    for (const auto k : each_index(problem.set().parts)) {
      const ObservationPart& part = problem.set().parts[k];
      ObservationEstimate own;
      own.sheet = problem.sheet_at(coefficients, k);
      const auto line =
          part.observation->linearise({estimate.mechanism, own.sheet, &corrections[k]}, {});
      if (!line) {
        return tl::unexpected(
            problem.unreachable(line.error().at(PlaceOfObservation{k, line.error().place})));
      }
      own.predicted = line->predicted;
      if (!part.zero_columns.empty()) {
        const Vector2d zeros = coefficients(part.zero_columns);
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
      own.nuisance = coefficients(part.nuisance_columns);
      own.nuisance_sigma = sigma(part.nuisance_columns);
      estimate.observations.push_back(std::move(own));
    }
    return {};
  }
};

}  // namespace chaintrue::grid::estimation

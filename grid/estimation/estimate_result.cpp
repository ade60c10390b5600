// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Results of the last pass of an estimate: units, observations, covariances.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/estimator.hpp"
#include "grid/estimation/left_out.hpp"
#include "grid/estimation/unknowns.hpp"
#include "model/calibration/setting.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::estimation {

using model::Side;

void Estimator::fill_units(Estimate& estimate) const {
  LeftOut left_out(*problem_, fit_, weights_);
  left_out.prepare_units();
  if (!input_.held_out_together.empty()) left_out.prepare_all();
  for (std::size_t u = 0; u < problem_->units().size(); ++u) {
    const SystemUnit& unit = problem_->units()[u];
    const auto at = as_index(u);
    const auto back = unit.whitening.inverse();
    const Eigen::MatrixXd rows = problem_->design().middleRows(unit.first_row, unit.rows);
    const double distance = input_.fixed_weights ? left_out.distance(u) : distances_[at];
    UnitEstimate own{unit.observation, unit.unit, weights_[at], distance, {}, {}, {}, {}};
    own.residual =
        back * (problem_->response().segment(unit.first_row, unit.rows) - rows * fit_.coefficients);
    const LeftOut::Conditioned conditioned = left_out.conditioned(u);
    own.left_out = back * conditioned.residual;
    own.left_out_covariance = back * conditioned.covariance * back.transpose();
    estimate.units.push_back(std::move(own));
  }
  for (const Shift& one : shifts(true)) {
    const SystemUnit& unit = problem_->units()[one.at.unit];
    estimate.rejected_readings.push_back(
        {unit.observation, {unit.unit, one.at.reading}, one.residual_mm, one.sigmas});
  }
  for (const UnitGroup& group : input_.held_out_together) {
    const auto residuals = left_out.residuals(group);
    for (std::size_t k = 0; k < group.size(); ++k) {
      estimate.units[group[k]].left_out_with_group =
          problem_->units()[group[k]].whitening.inverse() * residuals[k];
    }
  }
}

tl::expected<void, EstimationFailure> Estimator::fill_observations(Estimate& estimate) const {
  const Unknowns& unknowns = problem_->unknowns();
  const Eigen::VectorXd coefficients = problem_->coefficients(fit_);
  const Eigen::VectorXd variance = problem_->covariance(fit_).diagonal();
  const auto corrections = problem_->corrections_of(state_);
  for (std::size_t k = 0; k < input_.observations.size(); ++k) {
    const observation::Observation& observation = *input_.observations[k];
    ObservationEstimate own;
    own.sheet = unknowns.sheet_at(coefficients, k);
    const auto line = observation.linearise({estimate.mechanism, own.sheet, &corrections[k]}, {});
    if (!line) {
      return tl::unexpected(
          problem_->unreachable(line.error().at(PlaceOfObservation{k, line.error().place})));
    }
    own.predicted = line->predicted;
    if (const Eigen::Index first = unknowns.zeros(k); first >= 0) {
      const Eigen::Vector2d zeros = coefficients.segment<2>(first);
      const Eigen::Vector2d sigma = variance.segment<2>(first).cwiseMax(0.0).cwiseSqrt();
      own.zeros = {{{zeros[0], sigma[0]}, {zeros[1], sigma[1]}}};
      for (std::size_t u = 0; u < line->units.size(); ++u) {
        const observation::Unit& rows = observation.units()[u];
        for (const observation::PlaceColumns& place : line->units[u].places)
          own.predicted.segment(rows.first_row, rows.rows) += place.by_chain * zeros;
      }
    }
    for (std::size_t i = 0; i < line->places.size(); ++i) {
      const observation::ChainPlaceState& place = line->places[i];
      own.places.push_back({as_stated_[k][i], place.mark, place.by_mark, place.reading.lengths});
    }
    const Eigen::Index count = observation.nuisance_sigma().size();
    own.nuisance = coefficients.segment(unknowns.nuisance(k), count);
    own.nuisance_sigma = variance.segment(unknowns.nuisance(k), count).cwiseMax(0.0).cwiseSqrt();
    estimate.observations.push_back(std::move(own));
  }
  return {};
}

void Estimator::fill_covariances(Estimate& estimate) const {
  const Unknowns& unknowns = problem_->unknowns();
  estimate.columns = {unknowns.settings(), estimate.surface.basis.size()};
  estimate.covariance = problem_->map_covariance(fit_, estimate.columns);
  std::vector<Eigen::Index> own;
  for (Eigen::Index i = 0; i < unknowns.parameters(); ++i) own.push_back(i);
  for (Eigen::Index i = 0; i < unknowns.scales(); ++i) own.push_back(unknowns.settings() + i);
  const Eigen::VectorXd coefficients = problem_->coefficients(fit_);
  estimate.map_unknowns = coefficients.head(unknowns.settings() + unknowns.scales());
  estimate.knowledge.mean = coefficients(own);
  estimate.knowledge.covariance = problem_->covariance(fit_)(own, own);
}

tl::expected<Estimate, EstimationFailure> Estimator::result() const {
  auto found = problem_->unknowns().mechanism_at(problem_->coefficients(fit_));
  const auto* chains = dynamic_cast<const model::ReadingModel*>(found.get());
  const observation::Columns columns = observation::columns_of(*input_.observations.front());
  Estimate estimate{
      chains != nullptr ? chains->machine() : input_.machine,
      chains != nullptr ? observation::settings_in(columns) : std::vector<model::Setting>{},
      {},
      {},
      state_.surface,
      problem_->has_surface(),
      surface_log_evidence_,
      {},
      {},
      std::sqrt(fit_.sigma2),
      fit_.edf,
      {},
      {},
      {},
      converged_,
      std::move(found)};
  fill_covariances(estimate);
  fill_units(estimate);
  if (auto done = fill_observations(estimate); !done) return tl::unexpected(done.error());
  return estimate;
}

std::string words_of(const std::array<SessionZero, 2>& zeros) {
  // Sigmas, 1 in 16 000 for each chain: a warning makes somebody inspect the chains.
  constexpr double kSpokenOf = 4.0;
  std::string words;
  for (const Side side : model::kSides) {
    const SessionZero& zero = zeros[as_size(row_of(side))];
    if (!(std::abs(zero.mm) > kSpokenOf * zero.sigma_mm)) continue;
    words += fmt::format("{}{} chain {:.1f} +- {:.1f} mm {}",
                         words.empty() ? "" : ", ",
                         side == Side::left ? "left" : "right",
                         std::abs(zero.mm),
                         zero.sigma_mm,
                         zero.mm > 0.0 ? "more" : "less");
  }
  return words;
}

}  // namespace chaintrue::grid::estimation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/linearised_system.hpp"

#include <Eigen/LU>
#include <cmath>

#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/unknowns.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// For each observation one whitening in place of its units' own, of the mean variance of a row.
std::vector<double> sigmas_alike(const estimation::LinearisedSystem& line, std::size_t parts) {
  std::vector<double> variance(parts, 0.0);
  std::vector<double> rows(parts, 0.0);
  for (const estimation::SystemUnit& unit : line.units) {
    variance[unit.observation] += estimation::unwhitening_of(unit.whitening).squaredNorm();
    rows[unit.observation] += static_cast<double>(unit.rows);
  }
  for (std::size_t k = 0; k < parts; ++k) variance[k] = std::sqrt(variance[k] / rows[k]);
  return variance;
}

void whiten_alike(const std::vector<double>& sigma, estimation::LinearisedSystem& line) {
  for (estimation::SystemUnit& unit : line.units) {
    const Eigen::MatrixXd change =
        estimation::unwhitening_of(unit.whitening) / sigma[unit.observation];
    const auto renew = [&](Eigen::MatrixXd& columns) {
      columns.middleRows(unit.first_row, unit.rows) =
          (change * columns.middleRows(unit.first_row, unit.rows)).eval();
    };
    renew(line.by_setting);
    renew(line.by_nuisance);
    for (observation::PlaceColumns& place : unit.places) {
      place.by_chain = (change * place.by_chain).eval();
    }
    unit.whitening =
        Eigen::MatrixXd::Identity(unit.rows, unit.rows) / sigma[unit.observation];
  }
}

/// A row each: one that never slips is no unit.
void add_unit(const SessionPart& part,
              const estimation::SystemUnit& own,
              LinearisedSystem& system) {
  SystemUnit unit;
  unit.first_row = own.first_row;
  unit.rows = own.rows;
  unit.reads_chains = part.reads_chains();
  if (own.rows == 1) unit.sigma = 1.0 / own.whitening(0, 0);
  if (own.rows == 2) unit.whitening = own.whitening;
  for (const observation::PlaceColumns& columns : own.places) {
    SeenPlace seen{columns.place, Eigen::Matrix2d::Zero()};
    seen.by_chain.topRows(own.rows) = columns.by_chain;
    unit.places.push_back(seen);
  }
  system.units.push_back(std::move(unit));
}

/// Columns from where the observations have them to where the session does.
void place_columns(const Session& session,
                   const estimation::LinearisedSystem& line,
                   LinearisedSystem& system) {
  constexpr auto kOfMachine = static_cast<Eigen::Index>(model::kMachineSettings.size());
  system.by_setting = Eigen::MatrixXd::Zero(session.rows, system.setting.size());
  system.by_setting.leftCols(kOfMachine) = line.by_setting.leftCols(kOfMachine);
  Eigen::Index sheet = kOfMachine;
  Eigen::Index nuisance = 0;
  for (const SessionPart& part : session.parts) {
    const Eigen::Index rows = part.observation->rows();
    auto block = system.by_setting.middleRows(part.first_row, rows);
    if (part.observation->sheet()) {
      block.middleCols<3>(Session::sheet_column(*part.sheet)) =
          line.by_setting.block(part.first_row, sheet, rows, 3);
      sheet += 3;
    }
    for (const Eigen::Index column : part.nuisance_columns) {
      block.col(column) = line.by_nuisance.col(nuisance++).segment(part.first_row, rows);
    }
  }
}

/// What was read less what the state predicts, visit by visit.
tl::expected<Eigen::VectorXd, observation::Unreachable> residual_of(const Session& session,
                                                                    const State& state) {
  Eigen::VectorXd residual(session.rows);
  for (const SessionPart& part : session.parts) {
    const auto predicted = part.observation->predicted(state.view(part));
    if (!predicted) {
      return tl::unexpected(observation::Unreachable{part.first_place + predicted.error().place,
                                                     predicted.error().reason});
    }
    residual.segment(part.first_row, part.observation->rows()) =
        part.observation->measured() - *predicted;
  }
  return residual;
}

tl::expected<estimation::LinearisedSystem, observation::Unreachable> lines_of(
    const Session& session, const State& state) {
  observation::Observations observations;
  std::vector<estimation::ObservedFrom> from;
  for (const SessionPart& part : session.parts) {
    observations.push_back(part.observation);
    const auto settings =
        static_cast<Eigen::Index>(estimation::settings_of(*part.observation).size());
    from.push_back({state.view(part), Eigen::VectorXd::Zero(settings)});
  }
  auto line = estimation::linearise(observations, from);
  if (line) return *std::move(line);
  return tl::unexpected(observation::Unreachable{
      session.parts[line.error().observation].first_place + line.error().place.place,
      line.error().place.reason});
}

}  // namespace

Eigen::Vector2d SystemUnit::whitened(const Eigen::VectorXd& all) const {
  if (rows == 1) return {all(first_row) / sigma, 0.0};
  return whitening * all.segment<2>(first_row);
}

Eigen::Vector2d SystemUnit::unwhitened(const Eigen::VectorXd& all) const {
  if (rows == 1) return {all(first_row) * sigma, 0.0};
  return whitening.inverse() * all.segment<2>(first_row);
}

Eigen::VectorXd whitened(const LinearisedSystem& system, Eigen::VectorXd all) {
  for (const SystemUnit& unit : system.units) {
    const Eigen::Vector2d own = unit.whitened(all);
    all.segment(unit.first_row, unit.rows) = own.head(unit.rows);
  }
  const Eigen::Index readings = system.reading_sigma.size();
  all.tail(readings) = all.tail(readings).cwiseQuotient(system.reading_sigma).eval();
  return all;
}

tl::expected<LinearisedSystem, observation::Unreachable> linearise(const Session& session,
                                                                   const State& state,
                                                                   const Steps& steps) {
  auto line = lines_of(session, state);
  if (!line) return tl::unexpected(line.error());
  auto residual = residual_of(session, state);
  if (!residual) return tl::unexpected(residual.error());
  if (!steps.whiten) whiten_alike(sigmas_alike(*line, session.parts.size()), *line);
  LinearisedSystem system;
  system.setting = setting_values(session, state);
  system.expected_change = session.stated_value - system.setting;
  system.sigma = session.stated_sigma;
  system.nuisances = session.nuisances();
  system.noise_dof = session.noise_dof;
  system.fewest_units = session.fewest_units;
  for (const estimation::SystemPlace& own : line->places) {
    const SessionPart& part = session.parts[own.observation];
    const SessionPlace& place = session.places[part.first_place + own.place];
    system.places.push_back({own.state.reading,
                             place.mark,
                             own.state.by_mark,
                             place.order,
                             part.reads_chains() && part.observation->ordered(),
                             session.stated.bed});
  }
  system.unit_of_row.assign(static_cast<std::size_t>(session.rows), -1);
  for (const estimation::SystemUnit& own : line->units) {
    const SessionPart& part = session.parts[own.observation];
    if (!part.observation->may_slip()) {
      system.reading_sigma.conservativeResize(system.reading_sigma.size() + 1);
      system.reading_sigma.tail<1>()(0) = 1.0 / own.whitening(0, 0);
      continue;
    }
    const auto number = static_cast<int>(system.units.size());
    for (Eigen::Index k = 0; k < own.rows; ++k) {
      system.unit_of_row[static_cast<std::size_t>(own.first_row + k)] = number;
    }
    add_unit(part, own, system);
  }
  place_columns(session, *line, system);
  system.e = whitened(system, *std::move(residual));
  return system;
}

std::vector<std::pair<Eigen::Index, std::size_t>> units_in(const LinearisedSystem& system,
                                                           const std::vector<Eigen::Index>& kept) {
  std::vector<std::pair<Eigen::Index, std::size_t>> result;
  for (std::size_t a = 0; a < kept.size(); ++a) {
    const int unit = system.unit_of_row[static_cast<std::size_t>(kept[a])];
    if (unit < 0) break;
    const auto number = static_cast<std::size_t>(unit);
    if (system.units[number].first_row == kept[a]) {
      result.emplace_back(static_cast<Eigen::Index>(a), number);
    }
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis

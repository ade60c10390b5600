// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/linearised_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

void add_places(const Session& session,
                const SessionPart& part,
                const observation::Linearisation& line,
                LinearisedSystem& system) {
  for (std::size_t i = 0; i < line.places.size(); ++i) {
    const SessionPlace& own = session.places[part.first_place + i];
    system.places.push_back({line.places[i].reading,
                             own.mark,
                             line.places[i].by_mark,
                             own.order,
                             part.reads_chains() && part.observation->ordered()});
  }
}

/// One whitening for all, of the mean variance of a row.
void whiten_alike(std::size_t first_unit, LinearisedSystem& system) {
  double variance = 0.0;
  double rows = 0.0;
  for (std::size_t u = first_unit; u < system.units.size(); ++u) {
    const SystemUnit& unit = system.units[u];
    variance += unit.rows == 1 ? unit.sigma * unit.sigma
                               : (unit.whitening.transpose() * unit.whitening).inverse().trace();
    rows += static_cast<double>(unit.rows);
  }
  const double sigma = std::sqrt(variance / rows);
  for (std::size_t u = first_unit; u < system.units.size(); ++u) {
    system.units[u].sigma = sigma;
    system.units[u].whitening = Eigen::Matrix2d::Identity() / sigma;
  }
}

void add_units(const SessionPart& part,
               const observation::Linearisation& line,
               const Steps& steps,
               LinearisedSystem& system) {
  const std::size_t first = system.units.size();
  for (std::size_t u = 0; u < line.units.size(); ++u) {
    const observation::Unit& own = part.observation->units()[u];
    SystemUnit unit;
    unit.first_row = part.first_row + own.first_row;
    unit.rows = own.rows;
    unit.reads_chains = part.reads_chains();
    const Eigen::MatrixXd& covariance = line.units[u].covariance;
    if (own.rows == 1) {
      unit.sigma = std::sqrt(covariance(0, 0));
    } else {
      unit.whitening = Eigen::Matrix2d(Eigen::Matrix2d(covariance).llt().matrixL()).inverse();
    }
    system.units.push_back(std::move(unit));
  }
  if (!steps.whiten) whiten_alike(first, system);
  for (std::size_t u = 0; u < line.units.size(); ++u) {
    SystemUnit& unit = system.units[first + u];
    for (const observation::PlaceColumns& columns : line.units[u].places) {
      SeenPlace seen{part.first_place + columns.place, Eigen::Matrix2d::Zero()};
      if (unit.rows == 1) {
        seen.by_chain.row(0) = columns.by_chain.row(0) / unit.sigma;
      } else {
        seen.by_chain = unit.whitening * columns.by_chain;
      }
      unit.places.push_back(seen);
    }
  }
}

void add_columns(const Session& session,
                 const SessionPart& part,
                 const observation::Linearisation& line,
                 LinearisedSystem& system) {
  const Eigen::Index rows = line.by_setting.rows();
  auto block = system.by_setting.middleRows(part.first_row, rows);
  constexpr auto kOfMachine = static_cast<Eigen::Index>(model::kMachineSettings.size());
  block.leftCols(kOfMachine) = line.by_setting.leftCols(kOfMachine);
  if (part.sheet) {
    block.middleCols<3>(session.sheet_column(*part.sheet)) = line.by_setting.rightCols<3>();
  }
  for (std::size_t q = 0; q < part.nuisance_columns.size(); ++q) {
    block.col(part.nuisance_columns[q]) = line.by_nuisance.col(static_cast<Eigen::Index>(q));
  }
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
  LinearisedSystem system;
  system.setting = setting_values(session, state);
  system.expected_change = session.stated_value - system.setting;
  system.sigma = session.stated_sigma;
  system.nuisances = session.nuisances();
  system.noise_dof = session.noise_dof;
  system.fewest_units = session.fewest_units;
  system.by_setting = Eigen::MatrixXd::Zero(session.rows, system.setting.size());
  Eigen::VectorXd residual(session.rows);
  std::vector<model::Setting> settings(model::kMachineSettings.begin(),
                                       model::kMachineSettings.end());
  settings.insert(settings.end(), model::kSheetSettings.begin(), model::kSheetSettings.end());
  for (const SessionPart& part : session.parts) {
    const observation::View view = state.view(part);
    const auto line = part.observation->linearise(view, settings);
    if (!line) {
      return tl::unexpected(observation::Unreachable{part.first_place + line.error().place,
                                                     line.error().reason});
    }
    const auto predicted = part.observation->predicted(view);
    if (!predicted) {
      return tl::unexpected(observation::Unreachable{part.first_place + predicted.error().place,
                                                     predicted.error().reason});
    }
    residual.segment(part.first_row, part.observation->rows()) =
        part.observation->measured() - *predicted;
    add_columns(session, part, *line, system);
    if (part.observation->may_slip()) {
      add_places(session, part, *line, system);
      add_units(part, *line, steps, system);
    } else {
      const Eigen::Index before = system.reading_sigma.size();
      system.reading_sigma.conservativeResize(before + part.observation->rows());
      for (std::size_t u = 0; u < line->units.size(); ++u) {
        system.reading_sigma(before + static_cast<Eigen::Index>(u)) =
            std::sqrt(line->units[u].covariance(0, 0));
      }
    }
  }
  system.unit_of_row.assign(static_cast<std::size_t>(session.rows), -1);
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    for (Eigen::Index k = 0; k < system.units[u].rows; ++k) {
      system.unit_of_row[static_cast<std::size_t>(system.units[u].first_row + k)] =
          static_cast<int>(u);
    }
  }
  system.e = whitened(system, std::move(residual));
  for (Eigen::Index k = 0; k < system.setting.size(); ++k) {
    system.by_setting.col(k) = whitened(system, system.by_setting.col(k));
  }
  return system;
}

std::vector<std::pair<Eigen::Index, std::size_t>> units_in(
    const LinearisedSystem& system, const std::vector<Eigen::Index>& kept) {
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

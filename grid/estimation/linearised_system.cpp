// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/linearised_system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "grid/estimation/unknowns.hpp"

namespace chaintrue::grid::estimation {
namespace {

using observation::Linearisation;
using observation::Observation;

/// The system's own columns of an observation's settings.
std::vector<Eigen::Index> columns_of(const std::vector<model::Setting>& settings,
                                     Eigen::Index first_of_sheet) {
  std::vector<Eigen::Index> columns;
  for (std::size_t s = 0; s < settings.size(); ++s) {
    columns.push_back(model::is_of_sheet(settings[s])
                          ? first_of_sheet + model::sheet_column(settings[s])
                          : static_cast<Eigen::Index>(s));
  }
  return columns;
}

/// Where an observation's rows, columns and places begin.
struct Offsets {
  Eigen::Index row = 0;
  Eigen::Index sheet = static_cast<Eigen::Index>(model::kMachineSettings.size());
  Eigen::Index nuisance = 0;
};

void append(LinearisedSystem& system,
            const Observation& observation,
            std::size_t number,
            const Linearisation& line,
            const ObservedFrom& from,
            const Offsets& offsets) {
  const std::size_t first_place = system.places.size();
  for (std::size_t i = 0; i < line.places.size(); ++i)
    system.places.push_back({number, i, line.places[i]});
  const auto columns = columns_of(settings_of(observation), offsets.sheet);
  const Eigen::Index nuisances = line.by_nuisance.cols();
  for (std::size_t u = 0; u < line.units.size(); ++u) {
    const observation::Unit& rows = observation.units()[u];
    const Eigen::VectorXd residual = observation.measured().segment(rows.first_row, rows.rows) -
                                     line.predicted.segment(rows.first_row, rows.rows);
    const Eigen::MatrixXd by_setting = line.by_setting.middleRows(rows.first_row, rows.rows);
    SystemUnit unit{number,
                    u,
                    offsets.row + rows.first_row,
                    rows.rows,
                    whitening_of(line.units[u].covariance),
                    {}};
    const Eigen::MatrixXd& w = unit.whitening;
    system.residual.segment(unit.first_row, unit.rows) = w * residual;
    system.response.segment(unit.first_row, unit.rows) =
        w * (residual + by_setting * from.settings);
    system.by_setting(Eigen::seqN(unit.first_row, unit.rows), columns) = w * by_setting;
    system.by_nuisance.block(unit.first_row, offsets.nuisance, unit.rows, nuisances) =
        w * line.by_nuisance.middleRows(rows.first_row, rows.rows);
    for (const observation::PlaceColumns& place : line.units[u].places)
      unit.places.push_back({first_place + place.place, w * place.by_chain});
    system.units.push_back(std::move(unit));
  }
}

}  // namespace

Eigen::MatrixXd whitening_of(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows();
  if (n == 1) return Eigen::MatrixXd::Constant(1, 1, 1.0 / std::sqrt(covariance(0, 0)));
  if (n == 2) {
    const Eigen::Matrix2d lower = Eigen::Matrix2d(covariance).llt().matrixL();
    return lower.inverse();
  }
  return Eigen::MatrixXd(covariance.llt().matrixL())
      .triangularView<Eigen::Lower>()
      .solve(Eigen::MatrixXd::Identity(n, n));
}

Eigen::MatrixXd unwhitening_of(const Eigen::MatrixXd& whitening) {
  const Eigen::Index n = whitening.rows();
  if (n == 1) return whitening.cwiseInverse();
  if (n == 2) return Eigen::Matrix2d(whitening).inverse();
  return whitening.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(n, n));
}

tl::expected<LinearisedSystem, UnreachablePlace> linearise(
    const observation::Observations& observations, const std::vector<ObservedFrom>& from) {
  Offsets total;
  for (const auto& observation : observations) {
    total.row += observation->rows();
    total.sheet += observation->sheet() ? 3 : 0;
    total.nuisance += observation->nuisance_sigma().size();
  }
  LinearisedSystem system;
  system.residual.resize(total.row);
  system.response.resize(total.row);
  system.by_setting = Eigen::MatrixXd::Zero(total.row, total.sheet);
  system.by_nuisance = Eigen::MatrixXd::Zero(total.row, total.nuisance);
  Offsets offsets;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const Observation& observation = *observations[k];
    const auto line = observation.linearise(from[k].view, settings_of(observation));
    if (!line) return tl::unexpected(UnreachablePlace{k, line.error()});
    append(system, observation, k, *line, from[k], offsets);
    offsets.row += observation.rows();
    offsets.sheet += observation.sheet() ? 3 : 0;
    offsets.nuisance += observation.nuisance_sigma().size();
  }
  return system;
}

}  // namespace chaintrue::grid::estimation

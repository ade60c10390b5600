// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/observation.hpp"

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::observation {

Columns columns_of(const Observation& observation) {
  return {true, observation.sheet().has_value()};
}

std::vector<Setting> settings_in(const Columns& columns) {
  std::vector<Setting> settings;
  if (columns.parameters) settings.assign(kMachineSettings.begin(), kMachineSettings.end());
  if (columns.sheet) append_all(settings, model::kSheetSettings);
  return settings;
}

const std::vector<const Kind*>& kinds() {
#define CHAINTRUE_OBSERVATION(id) &id,
  static const std::vector<const Kind*> kKinds = {
#include "grid/observation/kinds.def"
  };
#undef CHAINTRUE_OBSERVATION
  return kKinds;
}

MatrixXd marginal_covariance(const Linearisation& line, const VectorXd& nuisance_sigma) {
  const MatrixXd shared = line.by_nuisance * nuisance_sigma.asDiagonal();
  MatrixXd covariance = linear::outer(shared);
  Index row = 0;
  for (const UnitState& unit : line.units) {
    const Index n = unit.covariance.rows();
    covariance.block(row, row, n, n) += unit.covariance;
    row += n;
  }
  return covariance;
}

ChainPlaceState place_state(const View& view, const model::PointReading& reading, MarkPoint mark) {
  return {view.corrected(mark, reading.lengths, reading.position_jacobian * view.sheet.rotation()),
          reading, mark};
}

Matrix2Xd lengths_by_setting(const View& view, const model::PointReading& reading, MarkPoint place,
                             const std::vector<Setting>& settings) {
  const Eigen::Matrix<double, 2, 3> by_sheet =
      reading.position_jacobian * view.sheet.sensitivity(place);
  Matrix2Xd columns(2, std::ssize(settings));
  for (const auto s : each_index(settings)) {
    const auto column = as_index(s);
    if (is_of_sheet(settings[s])) {
      columns.col(column) = by_sheet.col(sheet_column(settings[s]));
    } else {
      columns.col(column) = view.chains().sensitivity(reading, settings[s]);
    }
  }
  return columns;
}

}  // namespace chaintrue::grid::observation

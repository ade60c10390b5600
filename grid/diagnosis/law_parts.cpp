// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_parts.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/bed_parts.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using Rows = std::vector<Eigen::Index>;

/// One context: the kept rows' covariance, amplitudes and sizes integrated out.
class LawModel {
 public:
  LawModel(const Analysis& a,
           const MarginalisedSystem& marginalised,
           const std::vector<int>& regressors,
           int discrepancy)
      : kept_(marginalised.kept), dof_(noise_dof(a)) {
    const Eigen::MatrixXd settings = kept_.of(a.system.by_setting) * a.system.sigma.asDiagonal();
    covariance_ = settings * settings.transpose();
    covariance_.diagonal().array() += 1.0;
    if (discrepancy >= 0) {
      const Discrepancy own = discrepancy_of(a.system, marginalised, discrepancy);
      covariance_ +=
          own.sigma_mm * own.sigma_mm * discrepancy_covariance(a.system, kept_, own.kernel);
    }
    for (const int k : regressors)
      add(marginalised, Eigen::VectorXd(a.system.g.col(k)));
    e_ = kept_(Eigen::VectorXd(a.system.e - a.system.by_setting * a.system.expected_change));
  }

  /// A column of unknown amplitude.
  void add(const MarginalisedSystem& marginalised, const Eigen::VectorXd& column) {
    const Eigen::VectorXd own = kept_(column);
    // Of the usual strength.
    const double sigma =
        kUsualSignalToNoise / std::max(marginalised.root.solve(own).norm(), 1e-12);
    covariance_ += sigma * sigma * own * own.transpose();
  }

  [[nodiscard]] double log_density(const Rows& rows) const {
    const Eigen::LLT<Eigen::MatrixXd> llt(covariance_(rows, rows));
    const Eigen::VectorXd z = llt.matrixL().solve(e_(rows));
    const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
    const NoiseDensity noise(dof_, static_cast<Eigen::Index>(rows.size()));
    return noise.log_density(z.squaredNorm()) - 0.5 * log_det;
  }

 private:
  const KeptRows& kept_;
  double dof_;
  Eigen::MatrixXd covariance_;
  Eigen::VectorXd e_;
};

Rows rows_without(const KeptRows& kept, const std::vector<std::size_t>& units) {
  Rows rows;
  for (const KeptRows::Unit& unit : kept.units()) {
    if (std::find(units.begin(), units.end(), unit.unit) != units.end()) continue;
    for (Eigen::Index k = 0; k < unit.rows; ++k) rows.push_back(unit.at + k);
  }
  return rows;
}

}  // namespace

double averaged_over_parts(const Analysis& a,
                           const LawEvidence& evidence,
                           const WeighedLaw& law,
                           double probability) {
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[evidence.marginalised];
  const std::vector<BedPart> parts =
      bed_parts(a.system, std::vector<bool>(a.system.units.size(), false), a.session.fewest_units);
  if (parts.empty()) return probability;
  LawModel with(a, marginalised, evidence.sets[law.set], law.discrepancy);
  const Eigen::MatrixXd columns = LawColumns(a.system).of(evidence.curves[law.curve], law.at);
  for (Eigen::Index k = 0; k < columns.cols(); ++k)
    with.add(marginalised, Eigen::VectorXd(columns.col(k)));
  const LawModel without(a,
                         marginalised,
                         evidence.sets[evidence.without_set],
                         evidence.without_discrepancy);
  const Rows all = rows_without(marginalised.kept, {});
  const double of_all = with.log_density(all) - without.log_density(all);
  // As far as odds are numbers.
  const double sure = std::min(probability, 1.0 - 1e-15);
  const double log_odds = std::log(sure) - std::log1p(-sure);
  double sum = 0.0;
  for (const BedPart& part : parts) {
    const Rows rows = rows_without(marginalised.kept, part.units);
    const double counts = static_cast<double>(all.size()) / static_cast<double>(rows.size());
    const double own = log_odds + counts * (with.log_density(rows) - without.log_density(rows)) - of_all;
    sum += 1.0 / (1.0 + std::exp(-own));
  }
  return std::min(probability, sum / static_cast<double>(parts.size()));
}

}  // namespace chaintrue::grid::diagnosis

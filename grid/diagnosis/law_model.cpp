// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_model.hpp"

#include <algorithm>

#include "grid/containers.hpp"
#include "grid/diagnosis/expected_discrimination.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

double log_density_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& e, double dof) {
  const linear::Cholesky factor(covariance);
  return NoiseDensity(dof, e.size()).log_density(factor.half_solve(e).squaredNorm()) -
         0.5 * factor.log_det();
}

double square_of(const Discrepancy& process) { return process.sigma_mm * process.sigma_mm; }

}  // namespace

LawModel::LawModel(const Analysis& a,
                   const MarginalisedSystem& marginalised,
                   const std::vector<int>& regressors,
                   int discrepancy)
    : system_(a.system), marginalised_(marginalised), dof_(a.system.noise_dof) {
  const KeptRows& kept = marginalised.kept;
  settings_ = linear::scaled_columns(kept.of(a.system.by_setting), a.system.sigma);
  covariance_ = linear::one_plus_outer(settings_);
  if (discrepancy >= 0) {
    process_ = discrepancy_of(a.system, marginalised, discrepancy);
    discrepancy_ =
        square_of(*process_) * discrepancy_covariance(a.system, kept, process_->kernel);
    covariance_ += discrepancy_;
  }
  for (const int k : regressors) add(Eigen::VectorXd(a.system.g.col(k)));
  Eigen::VectorXd e = a.system.e;
  linear::add_product(e, -1.0, a.system.by_setting, a.system.expected_change);
  e_ = kept(e);
}

void LawModel::add(const Eigen::VectorXd& column) {
  const Eigen::VectorXd own = marginalised_.kept(column);
  // Amplitude at the usual strength.
  const double sigma = kUsualSignalToNoise / std::max(marginalised_.root.solve(own).norm(), 1e-12);
  linear::add_outer(covariance_, sigma * sigma, own);
  columns_.push_back(sigma * own);
  sigmas_.push_back(sigma);
}

double LawModel::log_density(const std::vector<Eigen::Index>& rows) const {
  return log_density_of(covariance_(rows, rows), e_(rows), dof_);
}

double LawModel::log_density(const Eigen::VectorXd& known) const {
  return log_density_of(covariance_, e_ - marginalised_.kept(known), dof_);
}

LawModel::Left LawModel::left_of(const Eigen::VectorXd& known) const {
  Left left;
  left.noise = linear::Cholesky(covariance_).solve(e_ - marginalised_.kept(known));
  left.unexplained = left.noise;
  if (discrepancy_.size() > 0)
    linear::add_product(left.unexplained, 1.0, discrepancy_, left.noise);
  return left;
}

Eigen::VectorXd LawModel::left_of_prediction(const std::vector<Eigen::Index>& rows,
                                             const std::vector<Eigen::Index>& left_out) const {
  const linear::Cholesky own(covariance_(rows, rows));
  Eigen::VectorXd left = e_(left_out);
  linear::add_product(left,
                      -1.0,
                      Eigen::MatrixXd(covariance_(left_out, rows)),
                      own.solve(Eigen::VectorXd(e_(rows))));
  return left;
}

LawModel::Expected LawModel::expected_of(const RegressorSystem& next,
                                         const Eigen::MatrixXd& columns) const {
  const Eigen::Index settings = settings_.cols();
  Eigen::MatrixXd here(settings_.rows(), settings + columns.cols());
  Eigen::MatrixXd there(next.by_setting.rows(), settings + columns.cols());
  here.leftCols(settings) = settings_;
  there.leftCols(settings) =
      linear::scaled_columns(next.by_setting.leftCols(settings), system_.sigma);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    here.col(settings + k) = columns_[as_size(k)];
    there.col(settings + k) = sigmas_[as_size(k)] * columns.col(k);
  }
  Eigen::MatrixXd across = linear::product(there, linear::transposed(here));
  Eigen::MatrixXd own = linear::outer(there);
  // Holes not yet cut have their own columns, after all others.
  const Eigen::Index to_come = next.by_setting.cols() - settings;
  linear::add_outer(
      own,
      1.0,
      linear::scaled_columns(next.by_setting.rightCols(to_come), next.sigma.tail(to_come)));
  if (process_) {
    across += square_of(*process_) *
              discrepancy_covariance(next, system_, marginalised_.kept, process_->kernel);
    own += square_of(*process_) *
           discrepancy_covariance(next, next, KeptRows::all(next), process_->kernel);
  }
  const linear::Cholesky factor(covariance_);
  Expected expected;
  expected.mean = linear::product(next.by_setting.leftCols(settings), system_.expected_change);
  linear::add_product(expected.mean, 1.0, across, factor.solve(e_));
  linear::add_gram(own, -1.0, factor.half_solve(across.transpose()));
  expected.spread = root_of_spread(own);
  return expected;
}

LawModel model_with(const Analysis& a, const LawEvidence& evidence, const WeighedLaw* law) {
  LawModel model(a,
                 a.comparison.marginalised_systems[evidence.marginalised],
                 evidence.sets[law != nullptr ? law->set : evidence.without_set],
                 law != nullptr ? law->discrepancy : evidence.without_discrepancy);
  if (law == nullptr) return model;
  const Eigen::MatrixXd columns = LawColumns(a.system).of(evidence.curves[law->curve], law->at);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) model.add(Eigen::VectorXd(columns.col(k)));
  return model;
}

}  // namespace chaintrue::grid::diagnosis

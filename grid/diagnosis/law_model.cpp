// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/law_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "grid/diagnosis/expected_discrimination.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

double log_density_of(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& e, double dof) {
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  const Eigen::VectorXd z = llt.matrixL().solve(e);
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return NoiseDensity(dof, e.size()).log_density(z.squaredNorm()) - 0.5 * log_det;
}

double square_of(const Discrepancy& process) { return process.sigma_mm * process.sigma_mm; }

}  // namespace

LawModel::LawModel(const Analysis& a,
                   const MarginalisedSystem& marginalised,
                   const std::vector<int>& regressors,
                   int discrepancy)
    : system_(a.system), marginalised_(marginalised), dof_(noise_dof(a)) {
  const KeptRows& kept = marginalised.kept;
  settings_ = kept.of(a.system.by_setting) * a.system.sigma.asDiagonal();
  covariance_ = settings_ * settings_.transpose();
  covariance_.diagonal().array() += 1.0;
  if (discrepancy >= 0) {
    process_ = discrepancy_of(a.system, marginalised, discrepancy);
    discrepancy_ =
        square_of(*process_) * discrepancy_covariance(a.system, kept, process_->kernel);
    covariance_ += discrepancy_;
  }
  for (const int k : regressors) add(Eigen::VectorXd(a.system.g.col(k)));
  e_ = kept(Eigen::VectorXd(a.system.e - a.system.by_setting * a.system.expected_change));
}

void LawModel::add(const Eigen::VectorXd& column) {
  const Eigen::VectorXd own = marginalised_.kept(column);
  // Of the usual strength.
  const double sigma = kUsualSignalToNoise / std::max(marginalised_.root.solve(own).norm(), 1e-12);
  covariance_ += sigma * sigma * own * own.transpose();
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
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance_);
  Left left;
  left.noise = llt.solve(e_ - marginalised_.kept(known));
  left.unexplained = left.noise;
  if (discrepancy_.size() > 0) left.unexplained += discrepancy_ * left.noise;
  return left;
}

Eigen::VectorXd LawModel::left_of_prediction(const std::vector<Eigen::Index>& rows,
                                             const std::vector<Eigen::Index>& left_out) const {
  const Eigen::MatrixXd own = covariance_(rows, rows);
  const Eigen::MatrixXd across = covariance_(left_out, rows);
  const Eigen::VectorXd known = e_(rows);
  return e_(left_out) - across * own.llt().solve(known);
}

LawModel::Expected LawModel::expected_of(const RegressorSystem& next,
                                         const Eigen::MatrixXd& columns) const {
  const Eigen::Index settings = settings_.cols();
  Eigen::MatrixXd here(settings_.rows(), settings + columns.cols());
  Eigen::MatrixXd there(next.by_setting.rows(), settings + columns.cols());
  here.leftCols(settings) = settings_;
  there.leftCols(settings) = next.by_setting.leftCols(settings) * system_.sigma.asDiagonal();
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    here.col(settings + k) = columns_[static_cast<std::size_t>(k)];
    there.col(settings + k) = sigmas_[static_cast<std::size_t>(k)] * columns.col(k);
  }
  Eigen::MatrixXd across = there * here.transpose();
  Eigen::MatrixXd own = there * there.transpose();
  // Holes that are not cut yet have columns of their own, after all others.
  const Eigen::Index to_come = next.by_setting.cols() - settings;
  const Eigen::MatrixXd holes =
      next.by_setting.rightCols(to_come) * next.sigma.tail(to_come).asDiagonal();
  own += holes * holes.transpose();
  if (process_) {
    across += square_of(*process_) *
              discrepancy_covariance(next, system_, marginalised_.kept, process_->kernel);
    own += square_of(*process_) *
           discrepancy_covariance(next, next, KeptRows::all(next), process_->kernel);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance_);
  Expected expected;
  expected.mean = next.by_setting.leftCols(settings) * system_.expected_change + across * llt.solve(e_);
  expected.spread = root_of_spread(own - across * llt.solve(across.transpose()));
  return expected;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
// Notation as in reml.hpp.
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/reml_structure.hpp"

namespace chaintrue::interp {

PenalisedProblem::PenalisedProblem(Eigen::Index columns)
    : gram(Eigen::MatrixXd::Zero(columns, columns)), moment(Eigen::VectorXd::Zero(columns)) {}

void PenalisedProblem::add_rows(const Eigen::Ref<const Eigen::MatrixXd>& x,
                                const Eigen::Ref<const Eigen::VectorXd>& y) {
  if (x.cols() != columns() || x.rows() != y.size()) {
    throw std::invalid_argument(fmt::format("{} x {} design rows and {} responses for {} columns",
                                            x.rows(),
                                            x.cols(),
                                            y.size(),
                                            columns()));
  }
  gram.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
  moment.noalias() += x.transpose() * y;
  response_square += y.squaredNorm();
  rows += x.rows();
  if (keeps_rows) {
    design.conservativeResize(rows, columns());
    design.bottomRows(x.rows()) = x;
    response.conservativeResize(rows);
    response.tail(y.size()) = y;
  }
}

void PenalisedProblem::add_sparse_row(const std::vector<Eigen::Index>& indices,
                                      const std::vector<double>& values,
                                      double y) {
  if (keeps_rows || indices.size() != values.size()) {
    throw std::invalid_argument(keeps_rows ? "a problem that keeps its rows takes whole ones"
                                           : fmt::format("a sparse row of {} columns and {} values",
                                                         indices.size(),
                                                         values.size()));
  }
  for (std::size_t a = 0; a < indices.size(); ++a) {
    if (indices[a] < 0 || indices[a] >= columns()) {
      throw std::invalid_argument(fmt::format("column {} of {}", indices[a], columns()));
    }
    double* column = gram.col(indices[a]).data();
    for (std::size_t b = 0; b < indices.size(); ++b) {
      column[indices[b]] += values[a] * values[b];
    }
    moment(indices[a]) += values[a] * y;
  }
  response_square += y * y;
  ++rows;
}

namespace reml {

void check(const PenalisedProblem& problem) {
  const Eigen::Index q = problem.columns();
  const auto fail = [](const std::string& what) { throw std::invalid_argument(what); };
  if (problem.keeps_rows && problem.design.rows() != problem.rows) {
    fail(fmt::format("{} of {} rows were kept", problem.design.rows(), problem.rows));
  }
  if (q == 0 || problem.gram.rows() != q || problem.moment.size() != q) {
    fail(fmt::format(
        "a fit with X'X of {} x {} and X'y of {}", problem.gram.rows(), q, problem.moment.size()));
  }
  if (!problem.gram.allFinite() || !problem.moment.allFinite() ||
      !std::isfinite(problem.response_square)) {
    fail("the data of a penalised fit are not finite");
  }
  if (problem.prior_precision.size() != 0 &&
      (problem.prior_precision.rows() != q || problem.prior_precision.cols() != q)) {
    fail(fmt::format("a prior precision of {} x {} for {} columns",
                     problem.prior_precision.rows(),
                     problem.prior_precision.cols(),
                     q));
  }
  if (problem.prior_mean.size() != 0 && problem.prior_mean.size() != q) {
    fail(fmt::format("a prior mean of {} for {} columns", problem.prior_mean.size(), q));
  }
  for (const Penalty& penalty : problem.penalties) {
    const Eigen::Index m = penalty.matrix.rows();
    if (m == 0 || penalty.matrix.cols() != m || penalty.first_column < 0 ||
        penalty.first_column + m > q || !penalty.matrix.allFinite()) {
      fail(fmt::format("a penalty of {} x {} from column {} on among {} columns",
                       m,
                       penalty.matrix.cols(),
                       penalty.first_column,
                       q));
    }
  }
  if (problem.noise.knowledge == NoiseKnowledge::from_repeats &&
      !(problem.noise.degrees_of_freedom > 0.0)) {
    fail(fmt::format("a noise scale known from {} degrees of freedom",
                     problem.noise.degrees_of_freedom));
  }
}

}  // namespace reml
}  // namespace chaintrue::interp

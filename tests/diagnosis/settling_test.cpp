// SPDX-License-Identifier: GPL-3.0-or-later
// Convergence of the calibration, and the message where it does not converge.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/diagnosis/estimate.hpp"
#include "grid/diagnosis/findings.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing_support::analysis_of;
using testing_support::session_of;

constexpr const char* kNotConverged = "The calibration had not converged";

TEST(Settling, ReportsNonConvergence) {
  Analysis a = analysis_of(session_of({}, 1, 5, 4));
  Diagnosis converged;
  put_into_words(a, converged);
  EXPECT_THAT(converged.notes, Not(Contains(HasSubstr(kNotConverged))));
  a.converged = false;
  Diagnosis not_converged;
  put_into_words(a, not_converged);
  EXPECT_THAT(not_converged.notes, Contains(HasSubstr(kNotConverged)));
}

TEST(Settling, MeasuresATurnAtTheSheetsEdge) {
  // A rotation of 1e-4 rad is 0.12 mm at the edge of the bed: at convergence it is far below that.
  MeasuredGrid grid = session_of({}, 2, 5, 4);
  grid.sheet = SheetUncertainty{20.0, 10.0};
  const Analysis a = analysis_of(grid);
  ASSERT_TRUE(a.converged);
  const auto again = linearise(a.session, a.state).value();
  const auto marginalised = marginalise(again, a.comparison.marginalised_systems.front().outliers);
  const Eigen::VectorXd change = estimate(again, marginalised, {}, -1).setting_change;
  const double edge_mm = 0.5 * a.session.stated.bed.width_mm;
  const Eigen::Index turn = ObservationSet::sheet_column(0) + 2;
  // One more iteration changes nothing by more than the tolerance of the last one, 1e-4 mm.
  EXPECT_LT(edge_mm * std::abs(change(turn)), 1e-4);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis

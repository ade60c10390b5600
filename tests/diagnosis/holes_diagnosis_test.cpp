// SPDX-License-Identifier: GPL-3.0-or-later
// Diagnoses of distances between holes: bad input, the system's rows, and named causes and readings.
#include <gmock/gmock.h>

#include <algorithm>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using ::chaintrue::testing_support::nine_holes;
using ::testing::HasSubstr;

DiagnosisOptions quick() {
  DiagnosisOptions options;
  options.improvement = false;
  options.next_measurements = false;
  options.stability = false;
  return options;
}

/// Settings drawn from the stated uncertainties, with hidden effects.
MeasuredHoles holes(const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed) {
  synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.seed = seed;
  spec.hidden = hidden;
  const auto made = synthetic::simulate_holes(nine_holes(), spec);
  EXPECT_TRUE(made);
  return made->set;
}

Diagnosis diagnosed(const MeasuredHoles& set, const DiagnosisOptions& options = quick()) {
  const auto found = diagnose(set, options);
  EXPECT_TRUE(found) << found.error().sentence();
  return *found;
}

// Ninety-three distances for which Eigen's divide and conquer for singular values gave NaN, so that
// no model remained.
TEST(HolesDiagnosis, ToleratesNearlyEqualSingularValues) {
  const MeasuredHoles set =
      files::read(files::parse_holes, CHAINTRUE_FIXTURES "/holes/thirty_holes.json").holes;
  const Diagnosis found = diagnosed(set);
  EXPECT_EQ(found.verdict, Verdict::model_discrepancy) << found.sentence;
}

void expect_refused(const MeasuredHoles& set, DiagnosisFailure::Reason reason,
                    const std::string& words) {
  const auto found = diagnose(set, quick());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().reason, reason);
  EXPECT_THAT(found.error().sentence(), HasSubstr(words));
}

TEST(HolesDiagnosisBadInput, NamesTheMissingDistances) {
  MeasuredHoles set = holes({}, 1);
  set.distances.resize(6);
  expect_refused(set, DiagnosisFailure::Reason::too_few_points,
                 "6 distances are too few to name a cause: at least 8 are needed. Nine holes and "
                 "twenty distances are a good start. Measure also ");
}

TEST(HolesDiagnosisBadInput, ReportsAForgottenHookOffset) {
  MeasuredHoles set = holes({}, 1);
  for (HoleDistance& distance : set.distances) distance.distance_mm += 40.0;
  expect_refused(set, DiagnosisFailure::Reason::contradictory_settings,
                 "all distances are about 40 mm longer than commanded, whatever their length: the "
                 "tape's hook offset, entered as 0 mm, is probably 40 mm");
}

TEST(HolesDiagnosisBadInput, RefusesAMissingMachine) {
  MeasuredHoles set = holes({}, 1);
  set.machine.reset();
  expect_refused(set, DiagnosisFailure::Reason::no_machine, "add --machine M.json");
}

TEST(HolesDiagnosisBadInput, RefusesAHoleOutOfReach) {
  MeasuredHoles set = holes({}, 1);
  set.holes[0].commanded = {0.0, 5000.0};
  expect_refused(set, DiagnosisFailure::Reason::point_unreachable, "hole A at (0.0, 5000.0)");
}

// The system's columns reproduce the covariance of a set of distances as one observation.
TEST(HolesDiagnosis, RowsAreTheObservation) {
  MeasuredHoles set = holes({}, 3);
  set.distances.push_back({.from = 0, .edge = SheetEdge::left, .distance_mm = 50.0});
  set.distances.push_back({.from = 8, .edge = SheetEdge::right, .distance_mm = 50.0});
  const auto session = observations_of(set);
  ASSERT_TRUE(session);
  const State state = stated_state(*session);
  const auto system = linearise(*session, state);
  ASSERT_TRUE(system);
  const observation::Observation& tape = *session->parts.front().observation;
  const auto line =
      tape.linearise(state.view(session->parts.front()), observation::columns_of(tape));
  ASSERT_TRUE(line);
  Eigen::VectorXd sigma(system->e.size());
  for (const SystemUnit& unit : system->units) sigma(unit.first_row) = unit.sigma();
  const auto to_mm = sigma.asDiagonal();
  const Eigen::MatrixXd nuisance =
      to_mm * nuisance_columns(*system) * system->sigma.tail(system->nuisances).asDiagonal();
  Eigen::MatrixXd covariance = nuisance * nuisance.transpose();
  covariance.diagonal() += sigma.cwiseAbs2();
  // The same sums of some forty products each, computed in two ways.
  EXPECT_LT((covariance - observation::marginal_covariance(*line, tape.nuisance_sigma()))
                .cwiseAbs()
                .maxCoeff(),
            1e-12);
  EXPECT_LT((to_mm * system->e - (tape.measured() - line->predicted)).cwiseAbs().maxCoeff(), 1e-9);
  const auto settings = static_cast<Eigen::Index>(session->settings.size());
  EXPECT_LT(
      (to_mm * system->by_setting.leftCols(settings) - line->by_setting).cwiseAbs().maxCoeff(),
      1e-9 * line->by_setting.cwiseAbs().maxCoeff());
}

// With measured edges the sheet's placement is estimated, as one of the settings.
TEST(HolesDiagnosis, EdgesLocateTheSheet) {
  MeasuredHoles design = nine_holes();
  const std::vector<std::pair<std::size_t, SheetEdge>> edges = {
      {0, SheetEdge::left},   {0, SheetEdge::top},   {6, SheetEdge::left},
      {6, SheetEdge::bottom}, {8, SheetEdge::right}, {8, SheetEdge::bottom}};
  for (const auto& [hole, edge] : edges) {
    design.distances.push_back({.from = hole, .edge = edge, .distance_mm = 0.0});
  }
  synthetic::HolesSpec spec;
  spec.seed = 8;
  const auto made = synthetic::simulate_holes(design, spec);
  MeasuredHoles set = made->set;
  // The sheet lies 12 mm to the right of the bed's middle: marks on it are 12 mm further left.
  constexpr double kShiftMm = 12.0;
  for (HoleDistance& distance : set.distances) {
    if (distance.edge == SheetEdge::left) distance.distance_mm -= kShiftMm;
    if (distance.edge == SheetEdge::right) distance.distance_mm += kShiftMm;
  }
  const Diagnosis found = diagnosed(set, {});
  EXPECT_TRUE(found.causes.empty()) << found.sentence;
  const auto sheet = std::find_if(
      found.settings.begin(), found.settings.end(),
      [](const CalibratedSetting& s) { return s.setting == model::Setting::sheet_x_mm; });
  ASSERT_NE(sheet, found.settings.end());
  EXPECT_LT(sheet->sigma, 4.0) << "mm: the motors' 3 mm and the sheet move together";
  EXPECT_NEAR(sheet->calibrated, kShiftMm, 3.0 * sheet->sigma);
  ASSERT_TRUE(found.improvement && found.improvement->placed);
  EXPECT_LT(found.improvement->placed->rms_mm, 0.5 * found.improvement->uncalibrated.rms_mm);
}

TEST(HolesDiagnosis, NamesABadDistanceWithItsError) {
  for (const std::uint64_t seed : {1, 2}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    MeasuredHoles set = holes({}, seed);
    const std::size_t k = seed % set.distances.size();
    set.distances[k].distance_mm -= 12.0;
    const Diagnosis found = diagnosed(set);
    EXPECT_EQ(found.verdict, Verdict::outliers);
    ASSERT_EQ(found.outliers.size(), 1u);
    EXPECT_EQ(found.outliers[0].index, k);
    // Sigma of the tape, of both holes and of the prediction by the others: about 1 mm.
    EXPECT_NEAR(found.outliers[0].residual_mm, -12.0, 4.0);
    EXPECT_THAT(found.sentence, HasSubstr("mm too short"));
  }
}

// A hook offset in every distance has nearly the signature of worn links.
TEST(HolesDiagnosis, NamesNoCauseForATapesZeroOffset) {
  MeasuredHoles set = holes({}, 1);
  for (HoleDistance& distance : set.distances) distance.distance_mm += 5.0;
  const Diagnosis found = diagnosed(set);
  EXPECT_TRUE(found.causes.empty()) << found.sentence;
}

TEST(HolesDiagnosis, NamesASingleCause) {
  for (const model::AppliedEffect& hidden :
       {model::AppliedEffect{"chain_pitch_error", "left", {{"elongation", 0.0015}}},
        model::AppliedEffect{"chain_stretch", "", {{"compliance_per_n", 2e-5}}}}) {
    const Diagnosis found = diagnosed(holes({hidden}, 1));
    ASSERT_FALSE(found.causes.empty()) << found.sentence;
    EXPECT_EQ(found.causes.front().cause.effect->id, hidden.effect) << "seed 1";
    EXPECT_EQ(name(found.causes.front().cause.side), hidden.side) << "seed 1";
  }
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis

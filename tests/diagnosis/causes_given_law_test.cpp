// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Causes named once a law is known: those of the same readings without the law.
#include "grid/diagnosis/laws.hpp"

#include <gmock/gmock.h>

#include "grid/diagnosis/findings.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "tests/diagnosis/law_sessions.hpp"

namespace chaintrue::grid::diagnosis::laws {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::session_of;

constexpr double kPeriodMm = 47.0;

double wave(double length_mm) {
  return 0.6 * std::sin(2.0 * std::numbers::pi * length_mm / kPeriodMm + 0.7);
}

/// Friction at the right chain.
MeasuredGrid with_friction(double half_width_mm) {
  return session_of({{"direction_hysteresis", "right", {{"half_width_mm", half_width_mm}}}}, 21, 9,
                    6);
}

MeasuredGrid with_wave(const MeasuredGrid& grid) {
  return with_left(
      grid, [](const auto&, const auto& reading) { return wave(reading.pose.lengths.left_mm); });
}

/// The system's rows for what with_wave() adds.
Eigen::VectorXd rows_of_wave(const MeasuredGrid& without, const Analysis& a) {
  const MeasuredGrid with = with_wave(without);
  Eigen::VectorXd rows = Eigen::VectorXd::Zero(a.system.e.size());
  for (std::size_t u = 0; u < a.system.units.size(); ++u) {
    const std::size_t point = a.session.units[u].index;
    const Eigen::Vector2d added(
        with.points[point].lengths->left_mm - without.points[point].lengths->left_mm, 0.0);
    const SystemUnit& unit = a.system.units[u];
    rows.segment<2>(unit.first_row) = unit.whitening * added;
  }
  return rows;
}

TEST(CausesGivenLaw, EqualThoseOfReadingsWithoutTheLaw) {
  const MeasuredGrid plain = with_friction(0.6);
  const Analysis without = analysed(plain);
  const Analysis with = analysed(with_wave(plain));
  const Analysis given = analyse_without(with, rows_of_wave(plain, with), calibrated_rules());
  const std::vector<Cause> own = causes_found(given);
  const std::vector<Cause> asked = causes_found(without);
  ASSERT_EQ(asked.size(), 1U);
  ASSERT_EQ(own.size(), 1U);
  EXPECT_EQ(own.front().cause, asked.front().cause);
  // Linear about settings that the wave moved by a tenth of a millimetre, the secant at another size.
  const ParameterEstimate& size = asked.front().parameters.front();
  EXPECT_NEAR(own.front().parameters.front().value, size.value, 0.2 * size.sigma);
  EXPECT_NEAR(own.front().probability, asked.front().probability, 0.03);
}

TEST(CausesGivenLaw, KeepTheVerdictIfNothingIsRemoved) {
  const Analysis a = analysed(with_friction(0.6));
  const Analysis again =
      analyse_without(a, Eigen::VectorXd::Zero(a.system.e.size()), calibrated_rules());
  EXPECT_EQ(again.decision.verdict, a.decision.verdict);
  EXPECT_THAT(changed_causes(a, again), IsEmpty());
}

TEST(CausesGivenLaw, RemoveNothingWithoutAClaimedLaw) {
  const Analysis a = analysed(with_friction(0.6));
  EXPECT_FALSE(rows_of_claimed_law(a, laws_found(a)));
}

// A law alone: no cause has any evidence once it is known, and the comparison is not made again.
TEST(CausesGivenLaw, AreNotComparedWithoutANamedCause) {
  const Analysis a = analysed(with_half_turns(11));
  const LawsFound laws = laws_found(a);
  ASSERT_FALSE(laws.laws.empty());
  ASSERT_GE(laws.laws.front().probability, kLawClaimed);
  ASSERT_THAT(a.decision.listed, IsEmpty());
  EXPECT_FALSE(rows_of_claimed_law(a, laws));
}

// With friction as the law it is not a cause, and its probability is low.
TEST(CausesGivenLaw, DropANameThatOnlyTheLawMadeLikely) {
  Analysis a = analysed(with_friction(0.6));
  ASSERT_EQ(a.decision.listed.size(), 1U);
  const int column = a.decision.regressors.front();
  const CauseId cause = a.system.regressors[static_cast<std::size_t>(column)].cause;
  const Analysis given =
      analyse_without(a, a.system.g.col(column) * a.estimate.coefficient(0), calibrated_rules());
  const std::vector<CauseGivenLaw> changed = changed_causes(a, given);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed.front().cause, cause);
  EXPECT_THAT(changed.front().parameters, IsEmpty());
  EXPECT_GE(changed.front().without_law, kLawClaimed);
  take_names_back(given, a);
  EXPECT_THAT(a.decision.listed, IsEmpty());
  EXPECT_THAT(causes_found(a), IsEmpty());
  EXPECT_LT(probability_of(a, cause), 0.1);
}

// A little weaker than what is visible with the wave.
TEST(CausesGivenLaw, ReportWhatTheLawHides) {
  const Diagnosis found =
      diagnose(with_wave(with_friction(0.24)), testing_support::verdict_alone()).value();
  ASSERT_NE(claimed_law(found), nullptr);
  ASSERT_FALSE(found.unexplained->causes_given_law.empty()) << found.sentence;
  const CauseGivenLaw& own = found.unexplained->causes_given_law.front();
  EXPECT_EQ(own.cause.effect->id, "direction_hysteresis");
  EXPECT_GE(own.probability, kLawClaimed) << found.sentence;
  EXPECT_LT(own.without_law, own.probability);
  EXPECT_THAT(found.causes, IsEmpty());
  // Four sigmas: once in ten thousand sessions.
  EXPECT_NEAR(own.parameters.front().value, 0.24, 4.0 * own.parameters.front().sigma);
  EXPECT_THAT(found.sentence, HasSubstr("Given this law, they also name "));
  EXPECT_THAT(found.what_to_do.back(), HasSubstr("diagnose these readings again with it"));
  const std::string text = files::write_diagnosis(found);
  EXPECT_THAT(text, HasSubstr("\"causes_given_law\""));
  EXPECT_EQ(files::write_diagnosis(files::parse_diagnosis(text, "found.json")), text);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::laws

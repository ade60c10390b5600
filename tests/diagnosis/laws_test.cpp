// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws of what no listed cause explains: found with their place and size, with priors that keep
/// the false rate for a longer list, and weaker than a listed cause with the same effect.
#include "grid/diagnosis/laws.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/law_sessions.hpp"

namespace chaintrue::grid::diagnosis::laws {
namespace {

using model::effects::EffectSide;
using model::effects::find_effect;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::session_of;

/// The first law of a session's left chain.
Law law_of(const MeasuredGrid& grid, Coordinate of, LawShape shape) {
  Law law = laws_found(analysed(grid)).laws.at(0);
  EXPECT_EQ(law.of, of) << in_words(law);
  EXPECT_EQ(law.shape, shape);
  EXPECT_EQ(law.enters, Enters::left);
  EXPECT_GT(law.probability, kLawClaimed);
  return law;
}

// 117 marks; no listed cause makes it, and it is too short to be a smooth pattern.
TEST(Laws, AWaveOfHalfATurnIsFoundWithItsPeriodAndSize) {
  const Law law = law_of(with_half_turns(11), Coordinate::length_left, LawShape::wave);
  // Three sigmas.
  EXPECT_NEAR(law.parameters[0].value, 0.45, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 31.75, 3.0 * law.parameters[1].sigma);
  EXPECT_LT(law.parameters[1].sigma, 0.3);
  EXPECT_THAT(in_words(law), HasSubstr("over the left chain's length with period 31."));
  const auto hints = hints_of(law, model::Machine{});
  ASSERT_EQ(hints.size(), 1U);
  EXPECT_THAT(hints.front(), HasSubstr("half a turn of the sprocket (31.8 mm)"));
}

// Two sizes and one period; the second is not a separate wave.
TEST(Laws, AWaveAndItsSecondHarmonicAreOneLaw) {
  const Law law = law_of(with_two_harmonics(14), Coordinate::length_left, LawShape::harmonics);
  // Three sigmas.
  ASSERT_EQ(law.parameters.size(), 5U);
  EXPECT_NEAR(law.parameters[0].value, 0.5, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 110.0, 3.0 * law.parameters[1].sigma);
  EXPECT_NEAR(law.parameters[3].value, 0.45, 3.0 * law.parameters[3].sigma);
  EXPECT_THAT(in_words(law), HasSubstr("and its second harmonic of 0.4"));
}

double probability_of(const Diagnosis& found, std::string_view what) {
  const auto at = std::find_if(found.hypotheses.begin(), found.hypotheses.end(),
                               [&](const Hypothesis& one) { return one.effect == what; });
  return at == found.hypotheses.end() ? 0.0 : at->probability;
}

// What is claimed below is not denied above.
TEST(Laws, TheVerdictNamesTheClaimedLaw) {
  const Diagnosis found = diagnose(with_half_turns(11), testing_support::verdict_alone()).value();
  ASSERT_NE(claimed_law(found), nullptr);
  EXPECT_EQ(found.verdict, Verdict::model_discrepancy);
  EXPECT_THAT(found.sentence,
              HasSubstr("follow a law that no cause in the catalogue has: a wave of 0."));
  EXPECT_THAT(found.what_to_do.back(), HasSubstr("--law"));
  EXPECT_GT(probability_of(found, "law"), kLawClaimed);
  EXPECT_LT(probability_of(found, "nothing"), 1.0 - kLawClaimed);
  const Diagnosis sound =
      diagnose(session_of({}, 43, 8, 7), testing_support::verdict_alone()).value();
  EXPECT_EQ(sound.verdict, Verdict::nothing_found);
  EXPECT_EQ(probability_of(sound, "law"), 0.0);
}

TEST(Laws, AStepIsFoundWithItsPlace) {
  const Law law = law_of(with_step_along_x(12), Coordinate::x, LawShape::step);
  EXPECT_NEAR(law.parameters[0].value, 1.0, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 250.0, 3.0 * law.parameters[1].sigma);
}

/// Root mean square.
double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// The partial residuals minus the curve are noise, and so is the tool's residual with the law.
TEST(Laws, PointsScatterAboutTheCurveByTheirNoise) {
  for (const auto& [name, grid] :
       {std::pair{"wave", with_half_turns(11)}, std::pair{"step", with_step_along_x(12)}}) {
    SCOPED_TRACE(name);
    const Analysis a = analysed(grid);
    const std::vector<Law> laws = laws_found(a).laws;
    ASSERT_FALSE(laws.empty());
    const Law& law = laws.front();
    ASSERT_EQ(law.points.size(), grid.points.size());
    std::vector<double> about, of_law, left, before;
    for (std::size_t i = 0; i < law.points.size(); ++i) {
      const LawResidual& point = law.points[i];
      EXPECT_EQ(point.index, i);
      EXPECT_GE(point.at, law.from);
      EXPECT_LE(point.at, law.to);
      about.push_back(point.residual_mm - value_of(law, point.at));
      of_law.push_back(value_of(law, point.at));
      left.insert(left.end(), {point.left_x_mm.value(), point.left_y_mm.value()});
    }
    for (const PointPicture& point : point_pictures(a))
      before.insert(before.end(), {point.before_mm.x(), point.before_mm.y()});
    // Settings and the law take some of the noise; a sigma of n readings is known to 1 / sqrt(2 n), 10 %.
    const double noise_mm = std::hypot(0.2, 0.3);
    EXPECT_GT(rms(about), 0.7 * noise_mm);
    EXPECT_LT(rms(about), 1.2 * noise_mm);
    EXPECT_GT(rms(of_law), 0.7 * noise_mm);
    EXPECT_LT(rms(left), 0.9 * rms(before));
  }
}

TEST(Laws, AreNotClaimedForNoiseOrListedCauses) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    EXPECT_THAT(laws_found(analysed(session_of({}, seed))).laws, IsEmpty()) << "seed " << seed;
  }
  // Laws with the same effect exist: a line in the left chain's length, a kink in its angle and a
  // wave in its length. The listed cause has the larger prior.
  for (const auto& [id, values] : {std::pair{"chain_pitch_error", std::vector{0.0012}},
                                   std::pair{"angular_kink", std::vector{6.0, 0.5}},
                                   std::pair{"sprocket_eccentricity", std::vector{0.6, 1.0}}}) {
    const auto effect = model::effects::applied(*find_effect(id), EffectSide::left, values);
    EXPECT_THAT(laws_found(analysed(session_of({effect}, 24))).laws, IsEmpty()) << id;
  }
}

// The prior of all laws is fixed and shared out.
TEST(Laws, DuplicatesChangeNothing) {
  const Analysis a = analysed(with_step_along_x(12, 0.5));
  const std::vector<LawCurve> once = law_curves(a.system);
  std::vector<LawCurve> twice;
  for (const LawCurve& curve : once) twice.insert(twice.end(), 2, curve);
  share_out(twice);
  double sum = 0.0;
  for (const LawCurve& curve : twice) sum += curve.share;
  EXPECT_NEAR(sum, 1.0, 1e-12);  // rounding of two thousand terms
  const std::size_t number = a.comparison.best().marginalised;
  const double of_once = probability_of_any({weigh_laws(a, number, once)});
  const double of_twice = probability_of_any({weigh_laws(a, number, twice)});
  // Laws far below the best are not refined; these differ between two lists.
  EXPECT_NEAR(of_twice, of_once, 0.01);
}

TEST(Laws, PriorFallsWithParametersAndDirections) {
  const Analysis a = analysed(session_of({}, 21));
  std::map<LawShape, double> along_x;
  double across = 0.0;
  double of_x = 0.0;
  for (const LawCurve& curve : law_curves(a.system)) {
    if (curve.of == Coordinate::x && curve.enters == Enters::left)
      along_x[curve.shape] += curve.share;
    // No direction has a wave with its second harmonic.
    if (curve.of == Coordinate::x && curve.shape != LawShape::harmonics) of_x += curve.share;
    if (curve.of == Coordinate::across) across += curve.share;
  }
  EXPECT_DOUBLE_EQ(along_x[LawShape::step], 0.5 * along_x[LawShape::linear]);
  EXPECT_DOUBLE_EQ(along_x[LawShape::wave], 0.5 * along_x[LawShape::step]);
  EXPECT_DOUBLE_EQ(along_x[LawShape::harmonics], 0.25 * along_x[LawShape::wave]);
  EXPECT_NEAR(across, 0.5 * of_x, 1e-12);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::laws

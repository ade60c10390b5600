// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws of what no listed cause explains: found with their place and size, shared out so that a longer
/// list raises no false rate, weaker than a listed cause that does the same, written as a cause that a
/// second session confirms and a foreign law does not.
#include "grid/diagnosis/laws.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_declaration.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "grid/files/effect_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/sessions.hpp"
#include "tests/normal_numbers.hpp"

namespace chaintrue::grid::diagnosis::laws {
namespace {

using model::effects::Declaration;
using model::effects::declared_effect;
using model::effects::EffectSide;
using model::effects::find_effect;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::session_of;

/// Readings with something more in the left chain, or with the tool moved along y.
template <class Value>
MeasuredGrid with_left(MeasuredGrid grid, Value value) {
  const model::ReadingModel machine(*grid.machine);
  for (MeasuredPoint& point : grid.points) {
    const auto reading = machine.at(model::identity_placement(point.mark)).value();
    point.lengths->left_mm += value(point.mark, reading);
  }
  return grid;
}

/// Half a turn, as a wave of the chain's length.
MeasuredGrid with_half_turns(std::uint64_t seed, double size_mm = 0.45, double shift_rad = 0.7) {
  return with_left(session_of({}, seed, 13, 9), [=](const auto&, const auto& reading) {
    return size_mm * std::sin(2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 31.75 + shift_rad);
  });
}

/// A turn whose second harmonic is as large as its first: two bumps a turn, one of them deep.
MeasuredGrid with_two_harmonics(std::uint64_t seed) {
  return with_left(session_of({}, seed, 13, 9), [](const auto&, const auto& reading) {
    const double turn = 2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 110.0;
    return 0.5 * std::sin(turn + 0.7) + 0.45 * std::sin(2.0 * turn - 0.4);
  });
}

MeasuredGrid with_step_along_x(std::uint64_t seed, double size_mm = 1.0) {
  return with_left(session_of({}, seed, 9, 6), [=](const model::MarkPoint& mark, const auto&) {
    return mark.x_mm >= 250.0 ? size_mm : 0.0;
  });
}

Analysis analysed(const MeasuredGrid& grid) {
  DiagnosisOptions options = testing_support::verdict_alone();
  options.stability = false;
  return analyse(observations_of(Measured(grid)).value(), options).value();
}

// 117 marks; no listed cause makes it, and it is too short to be a smooth pattern.
TEST(Laws, AWaveOfHalfATurnIsFoundWithItsPeriodAndSize) {
  const std::vector<Law> laws = laws_found(analysed(with_half_turns(11))).laws;
  ASSERT_FALSE(laws.empty());
  const Law& law = laws.front();
  EXPECT_EQ(law.of, LawOf::length_left) << in_words(law);
  EXPECT_EQ(law.shape, LawShape::wave);
  EXPECT_EQ(law.enters, Enters::left);
  EXPECT_GT(law.probability, kLawClaimed);
  // Three sigmas.
  EXPECT_NEAR(law.parameters[0].value, 0.45, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 31.75, 3.0 * law.parameters[1].sigma);
  EXPECT_LT(law.parameters[1].sigma, 0.3);
  EXPECT_THAT(in_words(law), HasSubstr("over the left chain's length with period 31."));
  const auto hints = hints_of(law, model::Machine{});
  ASSERT_EQ(hints.size(), 1U);
  EXPECT_THAT(hints.front(), HasSubstr("half a turn of the sprocket (31.8 mm)"));
}

// Two sizes and one period; the second is not a wave of its own.
TEST(Laws, AWaveAndItsSecondHarmonicAreOneLaw) {
  const std::vector<Law> laws = laws_found(analysed(with_two_harmonics(14))).laws;
  ASSERT_FALSE(laws.empty());
  const Law& law = laws.front();
  EXPECT_EQ(law.of, LawOf::length_left) << in_words(law);
  EXPECT_EQ(law.shape, LawShape::harmonics);
  EXPECT_EQ(law.enters, Enters::left);
  EXPECT_GT(law.probability, kLawClaimed);
  // Three sigmas.
  ASSERT_EQ(law.parameters.size(), 5U);
  EXPECT_NEAR(law.parameters[0].value, 0.5, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 110.0, 3.0 * law.parameters[1].sigma);
  EXPECT_NEAR(law.parameters[3].value, 0.45, 3.0 * law.parameters[3].sigma);
  EXPECT_THAT(in_words(law), HasSubstr("and its second harmonic of 0.4"));
}

double probability_of(const Diagnosis& found, std::string_view what) {
  const auto at = std::find_if(found.hypotheses.begin(), found.hypotheses.end(), [&](const Hypothesis& one) {
    return one.effect == what;
  });
  return at == found.hypotheses.end() ? 0.0 : at->probability;
}

// What is claimed below is not denied above.
TEST(Laws, TheVerdictIsOfTheLawThatIsClaimed) {
  const Diagnosis found = diagnose(with_half_turns(11), testing_support::verdict_alone()).value();
  ASSERT_NE(claimed_law(found), nullptr);
  EXPECT_EQ(found.verdict, Verdict::model_discrepancy);
  EXPECT_THAT(found.sentence, HasSubstr("follow a law that no cause in the catalogue has: a wave of 0."));
  EXPECT_THAT(found.what_to_do.back(), HasSubstr("--law"));
  EXPECT_GT(probability_of(found, "law"), kLawClaimed);
  EXPECT_LT(probability_of(found, "nothing"), 1.0 - kLawClaimed);
  const Diagnosis sound = diagnose(session_of({}, 43, 8, 7), testing_support::verdict_alone()).value();
  EXPECT_EQ(sound.verdict, Verdict::nothing_found);
  EXPECT_EQ(probability_of(sound, "law"), 0.0);
}

TEST(Laws, AStepIsFoundWithItsPlace) {
  const std::vector<Law> laws = laws_found(analysed(with_step_along_x(12))).laws;
  ASSERT_FALSE(laws.empty());
  const Law& law = laws.front();
  EXPECT_EQ(law.of, LawOf::x) << in_words(law);
  EXPECT_EQ(law.shape, LawShape::step);
  EXPECT_EQ(law.enters, Enters::left);
  EXPECT_NEAR(law.parameters[0].value, 1.0, 3.0 * law.parameters[0].sigma);
  EXPECT_NEAR(law.parameters[1].value, 250.0, 3.0 * law.parameters[1].sigma);
}

/// Root mean square.
double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// What the curve leaves of the partial residuals is noise, and what the law leaves at the tool as well.
TEST(Laws, PointsStandAboutTheCurveByTheirNoise) {
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
      left.insert(left.end(), {point.left_x_mm, point.left_y_mm});
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

// What is proposed where a law is not sure makes the right one likelier.
TEST(Laws, WhatIsProposedPartsALawFromItsRivals) {
  int open = 0, likelier = 0;
  std::string said;
  for (std::uint64_t seed = 51; seed < 67; ++seed) {
    const auto step = [](const model::MarkPoint& mark, const auto&) { return mark.x_mm >= 250.0 ? 1.0 : 0.0; };
    MeasuredGrid grid = with_left(session_of({}, seed), step);
    const Analysis a = analysed(grid);
    const LawsFound found = laws_found(a);
    const std::vector<NextMeasurement> next = next_for_laws(a, found);
    if (next.empty()) continue;
    ++open;
    EXPECT_GE(next.back().raises_probability_to, next.front().raises_probability_to);
    const auto of_step = [](const std::vector<Law>& laws) {
      double p = 0.0;
      for (const Law& law : laws) p += law.of == LawOf::x && law.enters == Enters::left ? law.probability : 0.0;
      return p;
    };
    // All marks that are proposed, read as the others were.
    const model::ReadingModel machine(*grid.machine);
    chaintrue::testing_support::NormalNumbers noise(seed);
    for (const NextMeasurement& one : next) {
      if (!one.mark) continue;
      MeasuredPoint point = grid.points.front();
      point.mark = *one.mark;
      point.order = static_cast<int>(grid.points.size());
      const model::MarkPoint truth{one.mark->x_mm + 0.3 * noise(), one.mark->y_mm + 0.3 * noise()};
      const auto reading = machine.at(model::identity_placement(truth)).value();
      point.lengths = reading.pose.lengths;
      point.lengths->left_mm += step(truth, reading) + 0.2 * noise();
      point.lengths->right_mm += 0.2 * noise();
      grid.points.push_back(point);
    }
    const double before = of_step(found.laws), after = of_step(laws_found(analysed(grid)).laws);
    likelier += after > before ? 1 : 0;
    said += fmt::format("seed {}: {} proposed, {:.3f} to {:.3f}\n", seed, next.size(), before, after);
  }
  // One in six may be misled by the noise of the new readings, as of the old.
  EXPECT_GE(open, 3) << said;
  EXPECT_GE(likelier, open - 1) << said;
}

TEST(Laws, NothingAndListedCausesAreNoLaw) {
  for (const std::uint64_t seed : {21, 22, 23}) {
    EXPECT_THAT(laws_found(analysed(session_of({}, seed))).laws, IsEmpty()) << "seed " << seed;
  }
  // What these do a law would do as well: a line of the left chain's length, a kink of its angle and a wave
  // of its length. The listed cause is the likelier one beforehand.
  for (const auto& [id, values] :
       {std::pair{"chain_pitch_error", std::vector{0.0012}},
        std::pair{"angular_kink", std::vector{6.0, 0.5}},
        std::pair{"sprocket_eccentricity", std::vector{0.6, 1.0}}}) {
    const auto effect = model::effects::applied(*find_effect(id), EffectSide::left, values);
    EXPECT_THAT(laws_found(analysed(session_of({effect}, 24))).laws, IsEmpty()) << id;
  }
}

// The prior of all laws is fixed and shared out.
TEST(Laws, AListThatHoldsEachLawTwiceSaysTheSame) {
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
  // Laws far below the best are not looked at again, of two lists not the same ones.
  EXPECT_NEAR(of_twice, of_once, 0.01);
}

TEST(Laws, MoreParametersAndDirectionsHaveLess) {
  const Analysis a = analysed(session_of({}, 21));
  std::map<LawShape, double> along_x;
  double across = 0.0;
  double of_x = 0.0;
  for (const LawCurve& curve : law_curves(a.system)) {
    if (curve.of == LawOf::x && curve.enters == Enters::left) along_x[curve.shape] += curve.share;
    // No direction has a wave with its second harmonic.
    if (curve.of == LawOf::x && curve.shape != LawShape::harmonics) of_x += curve.share;
    if (curve.of == LawOf::across) across += curve.share;
  }
  EXPECT_DOUBLE_EQ(along_x[LawShape::step], 0.5 * along_x[LawShape::linear]);
  EXPECT_DOUBLE_EQ(along_x[LawShape::wave], 0.5 * along_x[LawShape::step]);
  EXPECT_DOUBLE_EQ(along_x[LawShape::harmonics], 0.25 * along_x[LawShape::wave]);
  EXPECT_NEAR(across, 0.5 * of_x, 1e-12);
}

/// A law with plain numbers.
Law law_of(LawOf of, LawShape shape, Enters enters) {
  Law law;
  law.of = of;
  law.shape = shape;
  law.enters = enters;
  law.probability = 0.95;
  law.shape_probability = 0.9;
  law.direction_deg = of == LawOf::across ? 30.0 : 0.0;
  const bool is_angle = unit_of(of) == "rad";
  law.from = is_angle ? 0.2 : unit_of(of) == "n" ? 20.0 : 500.0;
  law.to = is_angle ? 1.2 : unit_of(of) == "n" ? 90.0 : 2500.0;
  if (of == LawOf::x || of == LawOf::y || of == LawOf::across) {
    law.from = -600.0;
    law.to = 600.0;
  }
  if (of == LawOf::border) {
    law.from = 0.0;
    law.to = 600.0;
  }
  law.towards = shape == LawShape::kink || shape == LawShape::exponential ? 1 : 0;
  const double span = law.to - law.from;
  law.parameters = {{"size_mm", 0.7, 0.05}};
  const std::string unit(unit_of(of));
  if (is_periodic(shape)) {
    law.parameters.push_back({"period_" + unit, 0.4 * span, 0.01 * span});
    law.parameters.push_back({"phase_rad", 0.6, 0.1});
    if (shape == LawShape::harmonics) {
      law.parameters.push_back({"second_size_mm", 0.3, 0.05});
      law.parameters.push_back({"second_phase_rad", -1.1, 0.2});
    }
  } else if (shape == LawShape::exponential) {
    law.parameters.push_back({"scale_" + unit, 0.2 * span, 0.02 * span});
  } else if (shape != LawShape::linear) {
    law.parameters.push_back({"place_" + unit, law.from + 0.4 * span, 0.02 * span});
  }
  return law;
}

/// Its amplitudes as a curve's columns have them.
LawCurve curve_of(const Law& law, Eigen::VectorXd& amplitude, double& at) {
  LawCurve curve;
  curve.of = law.of;
  curve.shape = law.shape;
  curve.enters = law.enters;
  curve.direction_rad = law.direction_deg * std::numbers::pi / 180.0;
  curve.towards = law.towards;
  curve.from = law.from;
  curve.to = law.to;
  const double size = law.parameters[0].value;
  amplitude = Eigen::VectorXd::Constant(1, size);
  at = law.parameters.size() > 1 ? law.parameters[1].value : 0.0;
  const auto wave = [&](std::size_t of_size) {
    const double phase = law.parameters[of_size == 0 ? 2 : 4].value;
    return Eigen::Vector2d(law.parameters[of_size].value * Eigen::Vector2d(std::sin(phase), std::cos(phase)));
  };
  if (is_periodic(law.shape)) {
    at = curve.span() / at;
    amplitude = wave(0);
    if (law.shape == LawShape::harmonics) {
      amplitude.conservativeResize(4);
      amplitude.tail<2>() = wave(3);
    }
  } else if (law.shape == LawShape::square) {
    const double off = (at - curve.middle()) / (0.5 * curve.span());
    amplitude = size * Eigen::Vector2d(1.0, -2.0 * off);
  }
  return curve;
}

struct Written {
  LawOf of;
  LawShape shape;
  Enters enters;
};

class EveryLaw : public testing::TestWithParam<Written> {};

// The formula, the columns that were weighed and value_of() are the same function.
TEST_P(EveryLaw, IsTheSameAsAFileAsColumnsAndAsAFunction) {
  const Law law = law_of(GetParam().of, GetParam().shape, GetParam().enters);
  const MeasuredGrid grid = session_of({}, 31);
  const Analysis a = analysed(grid);
  const auto written = declaration_of(law, grid.machine->bed);
  ASSERT_TRUE(written) << written.error();
  // As it is read again.
  const Declaration own = files::parse_effect(files::write_effect(*written), "law.json");
  EXPECT_EQ(files::write_effect(own), files::write_effect(*written));
  EXPECT_THAT(model::effects::problems_on_bed(own, *grid.machine), IsEmpty());
  const model::effects::Effect& effect = declared_effect(own);
  const CauseId cause{&effect, own.sides.front()};
  std::vector<double> values = model::effects::nominal_values(effect);
  const auto as_effect = signature(a.session, a.state, a.system, cause, values);
  ASSERT_TRUE(as_effect);
  Eigen::VectorXd amplitude;
  double at = 0.0;
  const LawCurve curve = curve_of(law, amplitude, at);
  Eigen::VectorXd as_columns = LawColumns(a.system).of(curve, at) * amplitude;
  if (law.shape == LawShape::square) {
    // The columns leave a constant out.
    const double off = (law.parameters[1].value - curve.middle()) / (0.5 * curve.span());
    LawCurve constant = curve;
    constant.shape = LawShape::step;
    as_columns += LawColumns(a.system).of(constant, -1e9) * Eigen::VectorXd::Constant(
        1, law.parameters[0].value * off * off);
  }
  // What moves the tool is written by the chain's angle, which is its direction but for the ring.
  const bool moves_tool = law.enters == Enters::x || law.enters == Enters::y || law.enters == Enters::along;
  const double tolerance = moves_tool ? 0.05 : 1e-4;
  EXPECT_LT((as_columns - *as_effect).norm(), tolerance * as_columns.norm());
  const SystemPlace& place = a.system.places.front();
  const double v = variable_at(place, law.of, curve.direction_rad);
  if (law.enters == Enters::left) {
    const auto& unit = a.system.units.front();
    const Eigen::VectorXd rows = unit.places.front().by_chain.col(0) * value_of(law, v);
    EXPECT_LT((rows - as_columns.segment(unit.first_row, unit.rows)).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws,
    EveryLaw,
    testing::Values(Written{LawOf::x, LawShape::step, Enters::left},
                    Written{LawOf::x, LawShape::kink, Enters::right},
                    Written{LawOf::x, LawShape::wave, Enters::y},
                    Written{LawOf::x, LawShape::step, Enters::x},
                    Written{LawOf::across, LawShape::wave, Enters::along},
                    Written{LawOf::y, LawShape::square, Enters::left},
                    Written{LawOf::y, LawShape::exponential, Enters::y},
                    Written{LawOf::across, LawShape::linear, Enters::left},
                    Written{LawOf::across, LawShape::kink, Enters::y},
                    Written{LawOf::border, LawShape::exponential, Enters::left},
                    Written{LawOf::length_left, LawShape::wave, Enters::left},
                    Written{LawOf::length_left, LawShape::harmonics, Enters::left},
                    Written{LawOf::y, LawShape::harmonics, Enters::y},
                    Written{LawOf::length_right, LawShape::linear, Enters::right},
                    Written{LawOf::angle_left, LawShape::wave, Enters::left},
                    Written{LawOf::angle_right, LawShape::kink, Enters::right},
                    Written{LawOf::tension_left, LawShape::square, Enters::left}));

TEST(LawFiles, WhatNoFormulaCanSayIsRefused) {
  const model::Bed bed;
  for (const Law& law : {law_of(LawOf::border, LawShape::exponential, Enters::outwards),
                         law_of(LawOf::length_left, LawShape::wave, Enters::right),
                         law_of(LawOf::angle_right, LawShape::kink, Enters::x)}) {
    const auto written = declaration_of(law, bed);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error(), HasSubstr("No file is made of the law found"));
  }
  Law unsure = law_of(LawOf::x, LawShape::step, Enters::left);
  unsure.probability = 0.89;
  const auto written = declaration_of(std::vector<Law>{unsure}, bed);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("89 %"));
  EXPECT_FALSE(declaration_of(std::vector<Law>{}, bed));
}

// From one session to the next: found, written, and then a cause like the others.
TEST(LawFiles, AreConfirmedByASecondSessionOfTheMachineAndDeniedByAnother) {
  const std::vector<Law> laws = laws_found(analysed(with_half_turns(11))).laws;
  const auto written = declaration_of(laws, model::Bed{});
  ASSERT_TRUE(written) << written.error();
  const model::effects::Effect& effect = declared_effect(*written);
  const auto with_law = [&](MeasuredGrid grid) {
    grid.machine->declared = {&effect};
    return diagnose(grid, testing_support::verdict_alone()).value();
  };
  const auto is_named = [&](const Diagnosis& found) {
    return std::any_of(found.causes.begin(), found.causes.end(), [&](const Cause& cause) {
      return cause.cause.effect == &effect && cause.cause.side == EffectSide::left;
    });
  };
  // Other marks, other noise.
  const Diagnosis second = with_law(with_left(session_of({}, 41, 12, 8), [](const auto&, const auto& reading) {
    return 0.45 * std::sin(2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 31.75 + 0.7);
  }));
  EXPECT_TRUE(is_named(second)) << second.sentence;
  ASSERT_EQ(second.declared.size(), 1U);
  EXPECT_EQ(second.declared.front().says, DeclaredAnswer::Says::confirmed);
  EXPECT_GE(second.declared.front().probability, kLawClaimed);
  ASSERT_TRUE(second.unexplained);
  EXPECT_THAT(second.unexplained->laws, IsEmpty());
  // A machine with another law: it is not this one.
  const Diagnosis other = with_law(with_step_along_x(42));
  EXPECT_FALSE(is_named(other)) << other.sentence;
  const Diagnosis sound = with_law(session_of({}, 43, 8, 7));
  EXPECT_FALSE(is_named(sound));
  for (const Diagnosis& denying : {other, sound}) {
    ASSERT_EQ(denying.declared.size(), 1U);
    EXPECT_EQ(denying.declared.front().says, DeclaredAnswer::Says::denied)
        << denying.declared.front().probability;
  }
  // A few marks of the same machine may not tell it, and do not deny it.
  for (std::uint64_t seed = 61; seed < 67; ++seed) {
    const Diagnosis few = with_law(with_left(session_of({}, seed, 4, 3), [](const auto&, const auto& reading) {
      return 0.45 * std::sin(2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 31.75 + 0.7);
    }));
    ASSERT_EQ(few.declared.size(), 1U);
    EXPECT_NE(few.declared.front().says, DeclaredAnswer::Says::denied) << "seed " << seed;
  }
}

// A step between two columns of marks: no reading tells where, and the map has the mean over these places.
TEST(LawFiles, TheMapAveragesOverTheGapInWhichAStepMayStand) {
  const auto written = declaration_of(laws_found(analysed(with_step_along_x(12))).laws, model::Bed{});
  ASSERT_TRUE(written) << written.error();
  MeasuredGrid grid = with_step_along_x(41);
  double below = -1e9;
  double above = 1e9;
  for (const MeasuredPoint& point : grid.points) {
    double& own = point.mark.x_mm < 250.0 ? below : above;
    own = point.mark.x_mm < 250.0 ? std::max(own, point.mark.x_mm) : std::min(own, point.mark.x_mm);
  }
  grid.machine->declared = {&declared_effect(*written)};
  const CausesFit fit = fit_with_causes(Measured(grid)).value();
  ASSERT_EQ(fit.built_on.size(), 1U);
  const Cause& cause = fit.built_on.front();
  ASSERT_EQ(cause.parameters.back().parameter, "place_mm");
  const ParameterEstimate& place = cause.parameters.back();
  // A column of readings is a few millimetres wide where the lengths say that it is.
  constexpr double kColumnMm = 6.0;
  EXPECT_NEAR(place.value, 0.5 * (below + above), kColumnMm);
  EXPECT_NEAR(place.sigma, (above - below) / std::sqrt(12.0), kColumnMm);
  const auto effects = applied_over_places(cause);
  ASSERT_GT(effects.size(), 1U);
  double size = 0.0;
  for (const model::AppliedEffect& own : effects) {
    size += own.parameters.at("size_mm");
    EXPECT_GT(own.parameters.at("place_mm"), below - kColumnMm);
    EXPECT_LT(own.parameters.at("place_mm"), above + kColumnMm);
  }
  EXPECT_NEAR(size, cause.parameters.front().value, 1e-12);
  // The map's own file has them all.
  const model::Machine& base = std::get<ModelSurface>(fit.fit.map.contents().surface).machine;
  EXPECT_EQ(base.effects.size(), effects.size());
  // A cause without such a place is what it was.
  Cause pitch = cause;
  pitch.cause = {find_effect("chain_pitch_error"), EffectSide::left};
  pitch.parameters = {{"elongation", 0.001, 0.0001}};
  EXPECT_EQ(applied_over_places(pitch).size(), 1U);
  Cause wave = cause;
  wave.cause = {find_effect("sprocket_eccentricity"), EffectSide::left};
  wave.parameters = {{"eccentricity_mm", 0.4, 0.01}, {"phase_rad", 1.0, 0.05}};
  EXPECT_EQ(applied_over_places(wave).size(), 1U);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis::laws

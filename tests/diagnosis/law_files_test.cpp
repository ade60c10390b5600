// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws as files of declared causes: the formula is the law, a second session of the machine
/// confirms it and another machine's does not, a map has the mean over the possible places of a
/// step.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "grid/files/effect_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/diagnosis/law_sessions.hpp"

namespace chaintrue::grid::diagnosis::law_files {
namespace {

using laws::analysed;
using laws::with_half_turns;
using laws::with_step_along_x;
using model::effects::Declaration;
using model::effects::declared_effect;
using model::effects::EffectSide;
using model::effects::find_effect;
using testing::HasSubstr;
using testing::IsEmpty;
using testing_support::session_of;

/// A law with plain numbers.
Law law_of(Coordinate of, LawShape shape, Enters enters) {
  Law law;
  law.of = of;
  law.shape = shape;
  law.enters = enters;
  law.probability = 0.95;
  law.shape_probability = 0.9;
  law.direction_deg = of == Coordinate::across ? 30.0 : 0.0;
  const bool is_angle = unit_of(of) == "rad";
  law.from = is_angle ? 0.2 : unit_of(of) == "n" ? 20.0 : 500.0;
  law.to = is_angle ? 1.2 : unit_of(of) == "n" ? 90.0 : 2500.0;
  if (of == Coordinate::x || of == Coordinate::y || of == Coordinate::across) {
    law.from = -600.0;
    law.to = 600.0;
  }
  if (of == Coordinate::border) {
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

/// Its amplitudes in the order of a curve's columns.
LawCurve curve_of(const Law& law, Eigen::VectorXd& amplitude, double& at) {
  LawCurve curve{law};
  const double size = law.parameters[0].value;
  amplitude = Eigen::VectorXd::Constant(1, size);
  at = law.parameters.size() > 1 ? law.parameters[1].value : 0.0;
  const auto wave = [&](std::size_t of_size) {
    const double phase = law.parameters[of_size == 0 ? 2 : 4].value;
    return Eigen::Vector2d(law.parameters[of_size].value *
                           Eigen::Vector2d(std::sin(phase), std::cos(phase)));
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
  Coordinate of;
  LawShape shape;
  Enters enters;
};

class EveryLaw : public testing::TestWithParam<Written> {};

// The formula, the compared columns and value_of() are the same function.
TEST_P(EveryLaw, AgreesAsFileColumnsAndFunction) {
  const Law law = law_of(GetParam().of, GetParam().shape, GetParam().enters);
  const MeasuredGrid grid = session_of({}, 31);
  const Analysis a = analysed(grid);
  const auto written = declaration_of(law, grid.machine->bed);
  ASSERT_TRUE(written) << written.error();
  // As read again.
  const Declaration own = files::parse_effect(files::write_effect(*written), "law.json");
  EXPECT_EQ(files::write_effect(own), files::write_effect(*written));
  EXPECT_THAT(model::effects::problems_on_bed(own, *grid.machine), IsEmpty());
  const model::effects::Effect& effect = declared_effect(own);
  const CauseId cause{&effect, own.sides.front()};
  std::vector<double> values = model::effects::nominal_values(effect);
  const auto as_effect = signature(a.session, a.state, a.system, {cause, values});
  ASSERT_TRUE(as_effect);
  Eigen::VectorXd amplitude;
  double at = 0.0;
  const LawCurve curve = curve_of(law, amplitude, at);
  Eigen::VectorXd as_columns = law_columns(a.system, curve, {at}) * amplitude;
  if (law.shape == LawShape::square) {
    // The columns leave a constant out.
    const double off = (law.parameters[1].value - curve.middle()) / (0.5 * curve.span());
    LawCurve constant = curve;
    constant.shape = LawShape::step;
    as_columns += law_columns(a.system, constant, {-1e9}) *
                  Eigen::VectorXd::Constant(1, law.parameters[0].value * off * off);
  }
  // A movement of the tool is written by the chain's angle, which is its direction except for the
  // ring.
  const bool moves_tool =
      law.enters == Enters::x || law.enters == Enters::y || law.enters == Enters::along;
  const double tolerance = moves_tool ? 0.05 : 1e-4;
  EXPECT_LT((as_columns - *as_effect).norm(), tolerance * as_columns.norm());
  const SystemPlace& place = a.system.places.front();
  const double v = value_at(place, law.of, curve.direction_rad());
  if (law.enters == Enters::left) {
    const auto& unit = a.system.units.front();
    const Eigen::VectorXd rows = unit.places.front().by_chain.col(0) * value_of(law, v);
    EXPECT_LT((rows - as_columns.segment(unit.first_row, unit.rows)).norm(), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Laws, EveryLaw,
    testing::Values(Written{Coordinate::x, LawShape::step, Enters::left},
                    Written{Coordinate::x, LawShape::kink, Enters::right},
                    Written{Coordinate::x, LawShape::wave, Enters::y},
                    Written{Coordinate::x, LawShape::step, Enters::x},
                    Written{Coordinate::across, LawShape::wave, Enters::along},
                    Written{Coordinate::y, LawShape::square, Enters::left},
                    Written{Coordinate::y, LawShape::exponential, Enters::y},
                    Written{Coordinate::across, LawShape::linear, Enters::left},
                    Written{Coordinate::across, LawShape::kink, Enters::y},
                    Written{Coordinate::border, LawShape::exponential, Enters::left},
                    Written{Coordinate::length_left, LawShape::wave, Enters::left},
                    Written{Coordinate::length_left, LawShape::harmonics, Enters::left},
                    Written{Coordinate::y, LawShape::harmonics, Enters::y},
                    Written{Coordinate::length_right, LawShape::linear, Enters::right},
                    Written{Coordinate::angle_left, LawShape::wave, Enters::left},
                    Written{Coordinate::angle_right, LawShape::kink, Enters::right},
                    Written{Coordinate::tension_left, LawShape::square, Enters::left}));

TEST(LawFiles, RefuseLawsNoFormulaCanExpress) {
  const model::Bed bed;
  for (const Law& law : {law_of(Coordinate::border, LawShape::exponential, Enters::outwards),
                         law_of(Coordinate::length_left, LawShape::wave, Enters::right),
                         law_of(Coordinate::angle_right, LawShape::kink, Enters::x)}) {
    const auto written = declaration_of(law, bed);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error(), HasSubstr("cannot be written to a file"));
  }
  Law unsure = law_of(Coordinate::x, LawShape::step, Enters::left);
  unsure.probability = 0.89;
  const auto written = declaration_of(std::vector<Law>{unsure}, bed);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error(), HasSubstr("89 %"));
  EXPECT_FALSE(declaration_of(std::vector<Law>{}, bed));
}

// From one session to the next: found, written, and then a cause like the others.
TEST(LawFiles, AreConfirmedByTheirMachineAndDeniedByAnother) {
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
  const Diagnosis second = with_law(with_half_turns(41, 0.45, 0.7, 12, 8));
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
  // A few marks of the same machine may not confirm it, and do not deny it.
  for (std::uint64_t seed = 61; seed < 67; ++seed) {
    const Diagnosis few = with_law(with_half_turns(seed, 0.45, 0.7, 4, 3));
    ASSERT_EQ(few.declared.size(), 1U);
    EXPECT_NE(few.declared.front().says, DeclaredAnswer::Says::denied) << "seed " << seed;
  }
}

// A step in one chain's variable lies between two values of that chain, whatever the other's are.
TEST(LawFiles, AStepOfOneChainsLengthHasTheGapOfThatChain) {
  const auto written =
      declaration_of(law_of(Coordinate::length_left, LawShape::step, Enters::left), model::Bed{});
  ASSERT_TRUE(written) << written.error();
  const model::effects::Effect& effect = declared_effect(*written);
  const Analysis a = analysed(session_of({}, 21));
  std::vector<double> left;
  std::vector<double> right;
  for (const SystemPlace& place : a.system.places) {
    left.push_back(value_at(place, Coordinate::length_left, 0.0));
    right.push_back(value_at(place, Coordinate::length_right, 0.0));
  }
  std::sort(left.begin(), left.end());
  int others = 0;
  for (std::size_t k = 1; k < left.size(); ++k) {
    if (!(left[k] - left[k - 1] > 1.0)) continue;
    const double at = 0.5 * (left[k - 1] + left[k]);
    const auto gap = gap_about(a.system, {&effect, EffectSide::left}, at);
    ASSERT_TRUE(gap);
    EXPECT_DOUBLE_EQ(gap->below, left[k - 1]);
    EXPECT_DOUBLE_EQ(gap->above, left[k]);
    others += static_cast<int>(std::count_if(
        right.begin(), right.end(), [&](double v) { return v > gap->below && v < gap->above; }));
  }
  EXPECT_GT(others, 0) << "the other chain's lengths lie in these gaps";
}

// A step between two columns of marks: no reading shows where, and the map has the mean over these
// places.
TEST(LawFiles, TheMapAveragesOverTheGapInWhichAStepMayStand) {
  const auto written =
      declaration_of(laws_found(analysed(with_step_along_x(12))).laws, model::Bed{});
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
  // A column of readings is a few millimetres wide by its lengths.
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
  // A cause without such a place is unchanged.
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
}  // namespace chaintrue::grid::diagnosis::law_files

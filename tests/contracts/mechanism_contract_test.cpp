// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of every mechanism: two chains, four belts, V-plotters of three kinds, and a toy that exists only here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>
#include <set>

#include "model/belts/belt_mechanism.hpp"
#include "model/calibration/setting.hpp"
#include "model/chains/chain_mechanism.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_mechanism.hpp"
#include "tests/contracts/declared_examples.hpp"
#include "tests/contracts/toy_mechanism.hpp"

namespace chaintrue::model {
namespace {

using MechanismPtr = std::shared_ptr<const Mechanism>;

/// A mechanism, its mirror image, the position of the mirror's line, and the correspondence between
/// the lengths of the image and its own.
struct Tested {
  std::string name;
  std::function<MechanismPtr()> make;
  std::function<MechanismPtr()> mirrored;
  double mirror_x_mm;  ///< x of the image = this less x
  std::vector<Eigen::Index> mirrored_length;
};

void PrintTo(const Tested& tested, std::ostream* out) { *out << tested.name; }

/// A machine without symmetry, with effects that its owner declared.
Machine leaning() {
  Machine machine;
  machine.declared = effects::declared_examples();
  machine.motors.left = {-1480.0, 1075.0};
  machine.motors.right = {1495.0, 1068.0};
  machine.chain_zero = {1.5, -0.5};
  return machine;
}

Machine leaning_mirrored() {
  Machine machine = leaning();
  std::swap(machine.motors.left, machine.motors.right);
  machine.motors.left.x_mm *= -1.0;
  machine.motors.right.x_mm *= -1.0;
  std::swap(machine.chain_zero.left_mm, machine.chain_zero.right_mm);
  return machine;
}

constexpr double kFrameWidthMm = 2953.2;

BeltMachine four_belts(BeltLengths lengths) {
  BeltMachine machine;
  machine.anchors_known = true;
  machine.lengths = lengths;
  machine.anchors = {
      {-27.6, 2064.9, 100.0}, {2924.3, 2066.5, 56.0}, {0.0, 0.0, 34.0}, {kFrameWidthMm, 0.0, 78.0}};
  return machine;
}

BeltMachine four_belts_mirrored(BeltLengths lengths) {
  BeltMachine machine = four_belts(lengths);
  std::swap(machine.anchors.tl, machine.anchors.tr);
  std::swap(machine.anchors.bl, machine.anchors.br);
  for (const Belt belt : kBelts)
    machine.anchors[belt].x_mm = kFrameWidthMm - machine.anchors[belt].x_mm;
  return machine;
}

/// A pen on cords from the wall, a bot with its motors in it, and a light body on heavy cords.
std::vector<PlotterMachine> plotters() {
  PlotterMachine point;
  point.name = "point";
  point.pin_rise_mm = 4.5;
  point.pulley_radius_mm = 9.55;
  point.zero_mm = {3.0, -2.0};
  point.cord = {.mass_kg_per_m = 0.008, .compliance_per_n = 2e-5};
  PlotterMachine bot = mural(1500.0);
  bot.pin_rise_mm = -6.0;
  bot.gondola.pen_right_mm = 3.0;
  bot.scale_mm_per_m = {2.0, -1.0};
  PlotterMachine light;
  light.name = "light";
  light.pin_spacing_mm = 2000.0;
  light.feed = Feed::off_bottom;
  light.pulley_radius_mm = 14.0;
  light.gondola = {.spacing_mm = 60.0, .pen_below_mm = 35.0, .mass_below_mm = 55.0, .mass_kg = 0.4};
  light.cord = {.mass_kg_per_m = 0.012, .compliance_per_n = 1e-4};
  light.area = {-600.0, 600.0, -500.0, -1500.0};
  return {point, bot, light};
}

PlotterMachine mirrored(PlotterMachine machine) {
  machine.pin_rise_mm *= -1.0;
  machine.gondola.pen_right_mm *= -1.0;
  machine.gondola.mass_right_mm *= -1.0;
  std::swap(machine.zero_mm.left_mm, machine.zero_mm.right_mm);
  std::swap(machine.scale_mm_per_m.left_mm, machine.scale_mm_per_m.right_mm);
  return machine;
}

std::vector<Tested> every_mechanism() {
  std::vector<Tested> all;
  for (const PlotterMachine& machine : plotters()) {
    all.push_back({"plotter_" + machine.name,
                   [machine] { return make_plotter_mechanism(machine); },
                   [machine] { return make_plotter_mechanism(mirrored(machine)); },
                   0.0,
                   {1, 0}});
  }
  all.push_back({"chains",
                 [] { return make_chain_mechanism(leaning()); },
                 [] { return make_chain_mechanism(leaning_mirrored()); },
                 0.0,
                 {1, 0}});
  for (const BeltLengths lengths :
       {BeltLengths::belt, BeltLengths::belt_and_arm, BeltLengths::span}) {
    all.push_back({"belts_" + std::string(name(lengths)),
                   [lengths] { return make_belt_mechanism(four_belts(lengths), 20.0); },
                   [lengths] { return make_belt_mechanism(four_belts_mirrored(lengths), 20.0); },
                   kFrameWidthMm,
                   {1, 0, 3, 2}});
  }
  all.push_back({"toy",
                 [] { return std::make_shared<const ToyMechanism>(-1000.0, 1200.0); },
                 [] { return std::make_shared<const ToyMechanism>(-1200.0, 1000.0); },
                 0.0,
                 {1, 0, 2}});
  return all;
}

/// A mechanism with one more effect, or with none.
struct WithEffect {
  std::string words;
  MechanismPtr mechanism;
};

/// The visit at which effects set in with their nominal values.
constexpr int kNominalVisit = 10;

class MechanismContract : public testing::TestWithParam<Tested> {
 protected:
  [[nodiscard]] std::vector<ToolPosition> positions(const Mechanism& mechanism) const {
    const MechanismExtent e = mechanism.extent();
    std::vector<ToolPosition> all;
    for (const double y : {0.05, 0.37, 0.61, 0.93}) {
      for (const double x : {0.04, 0.29, 0.52, 0.71, 0.96}) {
        all.push_back({e.x_min_mm + x * (e.x_max_mm - e.x_min_mm),
                       e.y_min_mm + y * (e.y_max_mm - e.y_min_mm)});
      }
    }
    return all;
  }
  /// The first visit; the one at which effects of one visit act; a later one for which a length was
  /// taken in, and one at which a length was pulled.
  [[nodiscard]] std::vector<MechanismVisit> visits(const Mechanism& mechanism) const {
    const std::size_t n = mechanism.lengths().size();
    std::vector<double> taken_in(n, 1.0);
    std::vector<bool> pulled(n, false);
    taken_in.front() = -1.0;
    pulled.back() = true;
    return {{}, {kNominalVisit, {}, {}}, {40, taken_in, {}}, {41, {}, pulled}};
  }
  [[nodiscard]] static std::vector<AppliedEffect> effects_at(
      const Mechanism& mechanism,
      const std::function<double(const effects::EffectParameter&)>& of) {
    std::vector<AppliedEffect> all;
    for (const effects::Effect* effect : mechanism.effects()) {
      std::vector<double> values;
      for (const effects::EffectParameter& p : effect->parameters) values.push_back(of(p));
      for (const effects::EffectSide side : effect->sides)
        all.push_back(effects::applied(*effect, side, values));
    }
    return all;
  }
  [[nodiscard]] static std::vector<AppliedEffect> nominal_effects(const Mechanism& mechanism) {
    return effects_at(mechanism, [](const auto& p) { return p.nominal; });
  }
  [[nodiscard]] static std::vector<AppliedEffect> null_effects(const Mechanism& mechanism) {
    return effects_at(mechanism, [](const auto& p) {
      return p.role == effects::ParameterRole::size ? p.null : p.nominal;
    });
  }
  /// Without an effect, and with each at its nominal values.
  [[nodiscard]] static std::vector<WithEffect> in_every_state(const MechanismPtr& mechanism) {
    std::vector<WithEffect> all = {{"without effects", mechanism}};
    for (const AppliedEffect& effect : nominal_effects(*mechanism)) {
      if (mechanism->problems_of_effects({effect}).empty())
        all.push_back({effect.effect + ":" + effect.side, mechanism->with_effects({effect})});
    }
    return all;
  }
};

INSTANTIATE_TEST_SUITE_P(Every,
                         MechanismContract,
                         testing::ValuesIn(every_mechanism()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(MechanismContract, ItHasItsWordsAndItsShapes) {
  const MechanismPtr mechanism = GetParam().make();
  EXPECT_FALSE(mechanism->kind().empty());
  const auto lengths = mechanism->lengths();
  EXPECT_GE(lengths.size(), 2u);
  EXPECT_EQ(std::set<std::string_view>(lengths.begin(), lengths.end()).size(), lengths.size());
  std::set<std::string_view> names;
  for (const MechanismParameter& parameter : mechanism->parameters()) {
    names.insert(parameter.name);
    EXPECT_TRUE(parameter.name.ends_with(parameter.unit)) << parameter.name;
    EXPECT_GT(parameter.prior_sigma.value_or(1.0), 0.0) << parameter.name;
  }
  EXPECT_EQ(names.size(), mechanism->parameters().size());
  EXPECT_EQ(static_cast<std::size_t>(mechanism->values().size()), names.size());
  EXPECT_LT(mechanism->extent().x_min_mm, mechanism->extent().x_max_mm);
  EXPECT_LT(mechanism->extent().y_min_mm, mechanism->extent().y_max_mm);
  EXPECT_FALSE(mechanism->effects().empty());
  const auto n = static_cast<Eigen::Index>(lengths.size());
  const auto at = mechanism->predict(mechanism->extent().centre(), {});
  ASSERT_TRUE(at);
  EXPECT_EQ(at->lengths_mm.size(), n);
  EXPECT_EQ(at->by_position.rows(), n);
  EXPECT_EQ(at->by_parameter.rows(), n);
  EXPECT_EQ(at->by_parameter.cols(), mechanism->values().size());
  const auto plain = mechanism->predict(mechanism->extent().centre(), {}, Derivatives::by_position);
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->by_parameter.cols(), 0);
  EXPECT_EQ(plain->lengths_mm, at->lengths_mm);
}

TEST_P(MechanismContract, DerivativesAreDifferences) {
  constexpr double kStepMm = 2e-2;
  // Central differences without their second order: the lengths' own 1e-10 mm over the step.
  // ReadingModel states 1e-9 for its derivatives where an effect depends on a chain's angle.
  constexpr double kTolerance = 2e-8;
  const MechanismPtr mechanism = GetParam().make();
  for (const WithEffect& state : in_every_state(mechanism)) {
    SCOPED_TRACE(state.words);
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        const auto at = state.mechanism->predict(q, visit);
        ASSERT_TRUE(at) << q.x_mm << " " << q.y_mm << ": " << at.error().sentence();
        const auto difference_of = [](const auto& lengths_at) -> Eigen::VectorXd {
          return (8.0 * (lengths_at(kStepMm) - lengths_at(-kStepMm)) -
                  (lengths_at(2.0 * kStepMm) - lengths_at(-2.0 * kStepMm))) /
                 (12.0 * kStepMm);
        };
        const Mechanism& m = *state.mechanism;
        Eigen::MatrixXd difference(at->lengths_mm.size(), 2 + m.values().size());
        difference.col(0) = difference_of([&](double step) -> Eigen::VectorXd {
          return m.predict({q.x_mm + step, q.y_mm}, visit)->lengths_mm;
        });
        difference.col(1) = difference_of([&](double step) -> Eigen::VectorXd {
          return m.predict({q.x_mm, q.y_mm + step}, visit)->lengths_mm;
        });
        for (Eigen::Index i = 0; i < m.values().size(); ++i) {
          const Eigen::VectorXd unit = Eigen::VectorXd::Unit(m.values().size(), i);
          difference.col(2 + i) = difference_of([&](double step) -> Eigen::VectorXd {
            return m.with_values(m.values() + step * unit)->predict(q, visit)->lengths_mm;
          });
        }
        EXPECT_LT((at->by_position - difference.leftCols<2>()).cwiseAbs().maxCoeff(), kTolerance)
            << q.x_mm << " " << q.y_mm;
        EXPECT_LT(
            (at->by_parameter - difference.rightCols(difference.cols() - 2)).cwiseAbs().maxCoeff(),
            kTolerance)
            << q.x_mm << " " << q.y_mm;
      }
    }
  }
}

TEST_P(MechanismContract, LocateInvertsPredict) {
  const MechanismPtr mechanism = GetParam().make();
  for (const WithEffect& state : in_every_state(mechanism)) {
    SCOPED_TRACE(state.words);
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        const auto at = state.mechanism->predict(q, visit, Derivatives::by_position);
        ASSERT_TRUE(at);
        const auto found = state.mechanism->locate(at->lengths_mm, visit);
        ASSERT_TRUE(found) << found.error().sentence();
        // As stated in the header, with an allowance for the position error from lengths of 1e-10
        // mm.
        EXPECT_NEAR(found->x_mm, q.x_mm, 3e-9);
        EXPECT_NEAR(found->y_mm, q.y_mm, 3e-9);
      }
    }
  }
}

TEST_P(MechanismContract, AnEffectAtNullAddsExactlyNothing) {
  const MechanismPtr mechanism = GetParam().make();
  for (const AppliedEffect& effect : null_effects(*mechanism)) {
    SCOPED_TRACE(effect.effect + ":" + effect.side);
    if (!mechanism->problems_of_effects({effect}).empty()) continue;
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        const auto added = added_by(*mechanism, effect, q, visit);
        ASSERT_TRUE(added);
        EXPECT_EQ(added->cwiseAbs().maxCoeff(), 0.0);
      }
    }
  }
}

TEST_P(MechanismContract, AnEffectOfItsUsualSizeIsThere) {
  const MechanismPtr mechanism = GetParam().make();
  for (const AppliedEffect& effect : nominal_effects(*mechanism)) {
    SCOPED_TRACE(effect.effect + ":" + effect.side);
    if (!mechanism->problems_of_effects({effect}).empty()) continue;
    double most = 0.0;
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        const auto added = added_by(*mechanism, effect, q, visit);
        ASSERT_TRUE(added);
        most = std::max(most, added->cwiseAbs().maxCoeff());
      }
    }
    EXPECT_GT(most, 1e-3);  // a micrometre: any effect at all
    EXPECT_TRUE(std::isfinite(most));
  }
}

TEST_P(MechanismContract, EffectsAreDescribed) {
  const MechanismPtr mechanism = GetParam().make();
  std::set<std::string_view> ids;
  for (const effects::Effect* effect : mechanism->effects()) {
    SCOPED_TRACE(std::string(effect->id));
    EXPECT_TRUE(ids.insert(effect->id).second);
    for (const std::string_view words : {effect->id,
                                         effect->cause,
                                         effect->signature,
                                         effect->equation,
                                         effect->source,
                                         effect->not_modelled,
                                         effect->typical,
                                         effect->remedy}) {
      EXPECT_FALSE(words.empty());
      EXPECT_EQ(words.find('|'), std::string_view::npos) << "breaks a table of documents: " << words;
    }
    EXPECT_FALSE(effect->sides.empty());
    ASSERT_FALSE(effect->parameters.empty());
    EXPECT_EQ(effect->parameters.front().role, effects::ParameterRole::size);
    for (const effects::EffectParameter& p : effect->parameters) {
      SCOPED_TRACE(std::string(p.name));
      EXPECT_LT(p.lower, p.upper);
      EXPECT_LE(p.lower, p.null);
      EXPECT_LE(p.null, p.upper);
      EXPECT_LE(p.lower, p.nominal);
      EXPECT_LE(p.nominal, p.upper);
      EXPECT_GT(p.prior_sigma, 0.0);
      EXPECT_FALSE(p.meaning.empty() || p.symbol.empty());
      EXPECT_EQ(p.nominal != p.null, p.role == effects::ParameterRole::size);
      if (p.integer) {
        EXPECT_EQ(p.nominal, std::round(p.nominal));
      }
    }
  }
}

TEST_P(MechanismContract, EffectsAreFiniteAtTheirBounds) {
  const MechanismPtr mechanism = GetParam().make();
  const MechanismExtent e = mechanism->extent();
  const ToolPosition aside{e.x_min_mm + 0.3 * (e.x_max_mm - e.x_min_mm),
                           e.y_min_mm + 0.3 * (e.y_max_mm - e.y_min_mm)};
  for (const effects::Effect* effect : mechanism->effects()) {
    for (unsigned corner = 0; corner < (1U << effect->parameters.size()); ++corner) {
      std::vector<double> values;
      for (const effects::EffectParameter& p : effect->parameters)
        values.push_back((corner >> values.size() & 1U) != 0 ? p.upper : p.lower);
      for (const effects::EffectSide side : effect->sides) {
        const AppliedEffect applied = effects::applied(*effect, side, values);
        SCOPED_TRACE(applied.effect + ":" + applied.side + testing::PrintToString(values));
        if (!mechanism->problems_of_effects({applied}).empty()) continue;
        const MechanismPtr with = mechanism->with_effects({applied});
        for (const MechanismVisit& visit : visits(*mechanism)) {
          for (const ToolPosition& q : {e.centre(), aside}) {
            const auto at = with->predict(q, visit);
            // A pen that is held by more than its gondola weighs has no equilibrium.
            const bool is_held = !at && effect->id == "pen_friction";
            EXPECT_TRUE(is_held || (at && at->lengths_mm.allFinite()));
          }
        }
      }
    }
  }
}

TEST_P(MechanismContract, AnEffectOfOneSideChangesItsLengthAlone) {
  const MechanismPtr mechanism = GetParam().make();
  const auto lengths = mechanism->lengths();
  for (const AppliedEffect& effect : nominal_effects(*mechanism)) {
    const auto own = std::find(lengths.begin(), lengths.end(), effect.side);
    if (own == lengths.end() || !mechanism->problems_of_effects({effect}).empty()) continue;
    // A cord that gives or weighs more tilts the gondola, and the other cord with it.
    if (effect.effect.starts_with("cord_")) continue;
    SCOPED_TRACE(effect.effect + ":" + effect.side);
    for (const MechanismVisit& visit : visits(*mechanism)) {
      for (const ToolPosition& q : positions(*mechanism)) {
        auto added = *added_by(*mechanism, effect, q, visit);
        added[own - lengths.begin()] = 0.0;
        EXPECT_LT(added.cwiseAbs().maxCoeff(), 1e-11);  // rounding of 3 m
      }
    }
  }
}

TEST_P(MechanismContract, ParametersAtTheirValuesChangeNothing) {
  const MechanismPtr mechanism = GetParam().make();
  Eigen::VectorXd stated(mechanism->values().size());
  for (Eigen::Index i = 0; i < stated.size(); ++i)
    stated[i] = mechanism->parameters()[static_cast<std::size_t>(i)].stated.value_or(
        mechanism->values()[i]);
  EXPECT_EQ(stated, mechanism->values());
  for (const MechanismVisit& visit : visits(*mechanism)) {
    for (const ToolPosition& q : positions(*mechanism)) {
      const auto own = mechanism->predict(q, visit);
      const auto same = predict(*mechanism, q, visit, stated);
      ASSERT_TRUE(own && same);
      EXPECT_EQ(own->lengths_mm, same->lengths_mm);  // to the last bit
      EXPECT_EQ(own->by_position, same->by_position);
      EXPECT_EQ(own->by_parameter, same->by_parameter);
    }
  }
  // Stated values are kept when values change.
  const auto moved = mechanism->with_values(stated + Eigen::VectorXd::Constant(stated.size(), 2.0));
  for (std::size_t i = 0; i < mechanism->parameters().size(); ++i)
    EXPECT_EQ(moved->parameters()[i].stated, mechanism->parameters()[i].stated);
}

TEST_P(MechanismContract, FailuresAreNamed) {
  const MechanismPtr mechanism = GetParam().make();
  const auto is_named = [](const MechanismFailure& failure) {
    return !failure.sentence().empty() && !failure.reason.name.empty() &&
           std::all_of(failure.reason.name.begin(), failure.reason.name.end(), [](char c) {
             return (c >= 'a' && c <= 'z') || c == '_';
           });
  };
  const auto n = static_cast<Eigen::Index>(mechanism->lengths().size());
  const auto nowhere = mechanism->locate(Eigen::VectorXd::Constant(n, 200.0), {});
  ASSERT_FALSE(nowhere);
  EXPECT_TRUE(is_named(nowhere.error())) << nowhere.error().reason.name;
  EXPECT_THROW((void)mechanism->locate(Eigen::VectorXd::Zero(n + 1), {}), std::invalid_argument);
  const AppliedEffect unknown{"no_such_effect", "", {}};
  ASSERT_FALSE(mechanism->problems_of_effects({unknown}).empty());
  EXPECT_TRUE(mechanism->problems_of_effects({unknown}).front().parameter.starts_with("/effects/"));
  EXPECT_THROW((void)mechanism->with_effects({unknown}), std::invalid_argument);
  EXPECT_THROW((void)mechanism->with_values(Eigen::VectorXd::Zero(mechanism->values().size() + 1)),
               std::invalid_argument);
}

TEST_P(MechanismContract, ItsMirrorImageHasTheMirroredLengths) {
  const MechanismPtr mechanism = GetParam().make();
  const MechanismPtr image = GetParam().mirrored();
  for (const ToolPosition& q : positions(*mechanism)) {
    const auto own = mechanism->predict(q, {});
    const auto other = image->predict({GetParam().mirror_x_mm - q.x_mm, q.y_mm}, {});
    ASSERT_TRUE(own && other);
    for (std::size_t i = 0; i < GetParam().mirrored_length.size(); ++i) {
      const Eigen::Index mirrored = GetParam().mirrored_length[i];
      const auto row = static_cast<Eigen::Index>(i);
      // Rounding of coordinates that are subtracted, and the equilibrium's 1e-10 mm.
      EXPECT_NEAR(own->lengths_mm[row], other->lengths_mm[mirrored], 1e-9);
      EXPECT_NEAR(own->by_position(row, 0), -other->by_position(mirrored, 0), 1e-10);
      EXPECT_NEAR(own->by_position(row, 1), other->by_position(mirrored, 1), 1e-10);
    }
  }
}

TEST(ChainMechanismTest, VisitsReadAsASessionDoes) {
  for (const effects::Effect* effect : effects::catalogue()) {
    for (const effects::EffectSide side : effect->sides) {
      Machine machine = leaning();
      machine.effects = {{"chain_pitch_error", "left", {{"elongation", 0.001}}},
                         effects::applied(*effect, side, effects::nominal_values(*effect))};
      if (!effects::problems_of_effects(machine).empty()) continue;
      const ChainMechanism mechanism(machine);
      // The right chain is taken in on the way to the second position, the left one paid out.
      const std::vector<Visit> visits = {{{-500.0, 0.0}, 11}, {{500.0, -40.0}, 12}};
      const auto session = readings(ReadingModel(machine), visits);
      ASSERT_TRUE(session);
      const auto at = mechanism.predict({500.0, -40.0}, {12, {1.0, -1.0}, {}});
      ASSERT_TRUE(at);
      // Rounding of sums of 3 m in another order.
      EXPECT_NEAR(at->lengths_mm[0], (*session)[1].left_mm, 1e-11) << effect->id;
      EXPECT_NEAR(at->lengths_mm[1], (*session)[1].right_mm, 1e-11) << effect->id;
    }
  }
}

TEST(BeltMechanismTest, AnchorsThatNobodyKnowsHaveNoLengthsUntilTheyAreFound) {
  BeltMachine machine = four_belts(BeltLengths::span);
  machine.anchors_known = false;
  const auto mechanism = make_belt_mechanism(machine);
  EXPECT_FALSE(mechanism->parameters().front().stated);
  EXPECT_FALSE(mechanism->parameters().front().prior_sigma);
  ASSERT_FALSE(mechanism->predict({1500.0, 1000.0}, {}));
  EXPECT_EQ(mechanism->predict({1500.0, 1000.0}, {}).error().reason.name, "anchors_not_known");
  const auto found =
      mechanism->with_values(make_belt_mechanism(four_belts(BeltLengths::span))->values());
  const auto at = found->predict({1500.0, 1000.0}, {});
  ASSERT_TRUE(at);
  for (const Belt belt : kBelts) {
    // A span is converted to a belt's length and back: rounding of 3 m.
    EXPECT_NEAR(at->lengths_mm[static_cast<Eigen::Index>(belt)],
                reading_at(four_belts(BeltLengths::span), belt, {1500.0, 1000.0})->length_mm,
                1e-11);
  }
}

}  // namespace
}  // namespace chaintrue::model

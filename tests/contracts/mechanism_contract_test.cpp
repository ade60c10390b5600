// SPDX-License-Identifier: GPL-3.0-or-later
/// Laws of every mechanism: its words and shapes, derivatives, positions for lengths, named failures, mirror images.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "tests/contracts/every_mechanism.hpp"

namespace chaintrue::model::contract {
namespace {

class MechanismContract : public EveryMechanism {};

INSTANTIATE_TEST_SUITE_P(Every, MechanismContract, testing::ValuesIn(every_mechanism()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(MechanismContract, HasNamesAndDimensions) {
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

TEST_P(MechanismContract, NamesFailures) {
  const MechanismPtr mechanism = GetParam().make();
  const auto is_named = [](const MechanismFailure& failure) {
    return !failure.sentence().empty() && !failure.reason.name.empty() &&
           std::all_of(failure.reason.name.begin(), failure.reason.name.end(),
                       [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
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

TEST(BeltMechanismTest, UnknownAnchorsHaveNoLengths) {
  BeltMachine machine = testing_support::stated();
  machine.anchors_known = false;
  const auto mechanism = make_belt_mechanism(machine);
  EXPECT_FALSE(mechanism->parameters().front().stated);
  EXPECT_FALSE(mechanism->parameters().front().prior_sigma);
  ASSERT_FALSE(mechanism->predict({1500.0, 1000.0}, {}));
  EXPECT_EQ(mechanism->predict({1500.0, 1000.0}, {}).error().reason.name, "anchors_not_known");
  const auto found =
      mechanism->with_values(make_belt_mechanism(testing_support::stated())->values());
  const auto at = found->predict({1500.0, 1000.0}, {});
  ASSERT_TRUE(at);
  for (const Belt belt : kBelts) {
    // A span is converted to a belt's length and back: rounding of 3 m.
    EXPECT_NEAR(at->lengths_mm[static_cast<Eigen::Index>(belt)],
                reading_at(testing_support::stated(), belt, {1500.0, 1000.0})->length_mm, 1e-11);
  }
}

}  // namespace
}  // namespace chaintrue::model::contract

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each textbook method where its answer follows by hand: orthogonal columns of length one. What is left
/// is then y'y less the squares of the products with the columns in the model.
#include "planted/judge/baselines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "planted/judge/curves.hpp"

namespace chaintrue::planted {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Key;
using testing::Pair;

/// A Hadamard matrix of 32 rows (J. Sylvester): column k has the sign of the parity of row & k.
Eigen::MatrixXd orthonormal(Eigen::Index columns) {
  constexpr Eigen::Index kRows = 32;
  Eigen::MatrixXd x(kRows, columns);
  for (Eigen::Index row = 0; row < kRows; ++row) {
    for (Eigen::Index k = 0; k < columns; ++k) {
      const bool odd =
          __builtin_popcountll(static_cast<unsigned long long>(row & (k + 1))) % 2 == 1;
      x(row, k) = (odd ? -1.0 : 1.0) / std::sqrt(static_cast<double>(kRows));
    }
  }
  return x;
}

/// y is 10 times the column of a, 6 times that of b, and noise of square 28 orthogonal to all columns.
Regression two_causes() {
  constexpr Eigen::Index kColumns = 6;
  const Eigen::MatrixXd all = orthonormal(kColumns + 1);
  Regression data;
  data.columns = all.leftCols(kColumns);
  data.causes = {"a:-", "b:-", "c:-", "c:-", "d:-", "e:-"};
  data.y = 10.0 * all.col(0) + 6.0 * all.col(1) + std::sqrt(28.0) * all.col(kColumns);
  data.taken = 2;
  return data;
}

/// Noise alone, orthogonal to all columns but 1 along that of d.
Regression nothing_hidden() {
  Regression data = two_causes();
  const Eigen::MatrixXd all = orthonormal(7);
  data.y = std::sqrt(29.0) * all.col(6) + all.col(4);
  return data;
}

TEST(Stepwise, EntersAtTheFOfTheColumn) {
  // a enters first: F = 100 / ((36 + 28) / 29) = 45.3; then b: F = 36 / (28 / 28) = 36; then a's own F is
  // 100 / (28 / 28) = 100. At thresholds above 45.3 nothing enters.
  const Scores scores = stepwise_scores(two_causes());
  ASSERT_THAT(scores, ElementsAre(Pair("a:-", testing::_), Pair("b:-", testing::_)));
  // Thresholds rise by the root of two: 45.25 is the last at which a enters, 32 that of b.
  EXPECT_NEAR(scores.at("a:-"), 32.0 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(scores.at("b:-"), 32.0, 1e-9);
}

TEST(Stepwise, NothingEntersWhereNothingIsHidden) {
  // d would enter at F = 1 / (29 / 29) = 1.
  EXPECT_THAT(stepwise_scores(nothing_hidden()), IsEmpty());
}

TEST(Bic, WeighsTheSetsByHand) {
  const Scores scores = bic_scores(two_causes());
  // With n = 30: a and b leave 28; a alone 64, b alone 128, nothing 164. A third column explains nothing and
  // costs a factor exp(-ln(n) / 2); there are four, of three causes, since two are of c.
  const double n = 30.0;
  const auto weight = [&](double left, int size) {
    return std::pow(left, -n / 2.0) * std::pow(n, -size / 2.0);
  };
  const double both = weight(28.0, 2) + 4.0 * weight(28.0, 3);
  const double only_a = weight(64.0, 1) + 4.0 * weight(64.0, 2) + 5.0 * weight(64.0, 3);
  const double only_b = weight(128.0, 1) + 4.0 * weight(128.0, 2) + 5.0 * weight(128.0, 3);
  const double none =
      weight(164.0, 0) + 4.0 * weight(164.0, 1) + 5.0 * weight(164.0, 2) + 2.0 * weight(164.0, 3);
  const double total = both + only_a + only_b + none;
  // To the last digits of sums of such weights.
  EXPECT_NEAR(scores.at("a:-"), (both + only_a) / total, 1e-9);
  EXPECT_NEAR(scores.at("b:-"), (both + only_b) / total, 1e-9);
}

TEST(Bic, NothingIsLikelyWhereNothingIsHidden) {
  // ln(30) is more than any column's 30 ln(30 / 29).
  for (const auto& [id, score] : bic_scores(nothing_hidden())) EXPECT_LT(score, 0.5) << id;
}

TEST(Lasso, ShrinksTheLargestLeast) {
  // On all rows a coefficient is its product with y less the penalty; so the order of the causes is that of
  // their products, and a is ahead of b by 4 / sigma.
  const Scores scores = lasso_scores(two_causes());
  ASSERT_TRUE(scores.contains("a:-") && scores.contains("b:-"));
  EXPECT_GT(scores.at("a:-"), scores.at("b:-"));
  const double penalty = 6.0 - 4.0 * scores.at("b:-") / (scores.at("a:-") - scores.at("b:-"));
  EXPECT_GT(penalty, 0.0);
  EXPECT_LT(penalty, 6.0);
  const double left = 28.0 + 2.0 * penalty * penalty;
  // Other columns come in for noise of rows that are left out, with the penalty taken from their products,
  // which are 0.
  EXPECT_NEAR(scores.at("a:-"), (10.0 - penalty) / std::sqrt(left / 30.0), 1e-2);
}

TEST(Lasso, ANamesStrengthIsThatOfNoiseWhereNothingIsHidden) {
  // d's product is one sigma; nothing else has any.
  for (const auto& [id, score] : lasso_scores(nothing_hidden())) {
    EXPECT_EQ(id, "d:-");
    EXPECT_LE(score, 1.0);
  }
}

TEST(Curves, CountNamesFromTheSurestOn) {
  Method method{"by hand", 0.5};
  method.add({{"a:-", 0.9}, {"x:-", 0.7}, {"y:-", 0.2}}, {"a:-"});
  method.add({{"tape_scale:both", 0.6}, {"z:-", 0.95}}, {"chain_pitch_error:both", "b:-"}, {"z:-"});
  EXPECT_EQ(method.sets, 2);
  EXPECT_EQ(method.hidden, 3);
  EXPECT_EQ(at_threshold(method, 0.5).right, 2);
  EXPECT_EQ(at_threshold(method, 0.5).wrong, 1);
  EXPECT_EQ(at_most_wrong(method, 0).right, 1);
  EXPECT_EQ(at_most_wrong(method, 1).right, 2);
  EXPECT_THAT(curves_table({method}),
              testing::HasSubstr("| by hand | 33 | 33 | 33 | 33 | 33 | 67 | 0.5 | 67 | 50 |"));
  // The axes begin at (60, 340) and are 300 long: 0 and 50 false names in 100 sets, a third and two thirds right.
  const std::string picture = curves_svg({{"By hand", {method}}});
  EXPECT_THAT(picture, testing::HasSubstr("<polyline points=\"60.0,240.0 360.0,140.0 \""));
  EXPECT_THAT(picture, testing::HasSubstr("<circle cx=\"360.0\" cy=\"140.0\""));
}

TEST(Curves, NamesOfOneScoreComeTogether) {
  Method method{"ties", 0.5};
  method.add({{"a:-", 0.9}, {"x:-", 0.9}}, {"a:-"});
  EXPECT_EQ(at_most_wrong(method, 0).right, 0);
  EXPECT_EQ(at_most_wrong(method, 1).right, 1);
}

}  // namespace
}  // namespace chaintrue::planted

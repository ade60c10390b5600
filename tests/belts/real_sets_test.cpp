// SPDX-License-Identifier: GPL-3.0-or-later
// Published readings of real machines: anchors alone, compared with figures computed by another
// program. The readings stay in ../shared/data.
#include <gtest/gtest.h>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/repeated_pulls.hpp"
#include "tests/belts/published_readings.hpp"

namespace chaintrue::grid {
namespace {

constexpr const char* kNotHere = "../shared/data/maslow4 is not part of a checkout and is not here";

struct RealSet {
  const char* name;
  const char* file;
  std::size_t places;
  double rms_mm;  ///< of all readings, anchors alone; computed elsewhere, to 0.01
};

/// Prints only the name: GoogleTest would print the bytes.
void PrintTo(const RealSet& set, std::ostream* out) { *out << set.name; }

class RealBelts : public testing::TestWithParam<RealSet> {
 protected:
  void SetUp() override {
    const auto read = testing_support::published_readings(GetParam().file);
    if (!read) GTEST_SKIP() << kNotHere;  // the logs are shared data, not part of a checkout
    import_ = *read;
  }
  files::Maslow4Import import_;
};

INSTANTIATE_TEST_SUITE_P(Sets, RealBelts,
                         testing::Values(RealSet{"concrete", "concrete_anchors.txt", 99, 0.65},
                                         RealSet{"rebuilt", "frame_rebuilt.txt", 99, 0.88},
                                         RealSet{"mini", "mini_frame.txt", 46, 0.85},
                                         RealSet{"run_1", "ten_runs_1_to_5.txt", 100, 1.12}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(RealBelts, AnchorsAloneLeaveThePublishedResiduals) {
  ASSERT_EQ(import_.belts.points.size(), GetParam().places);
  const auto fit = fit_belts(import_.belts);
  ASSERT_TRUE(fit) << fit.error().sentence();
  // The last digit of the other program's figure.
  EXPECT_NEAR(fit->rms_mm, GetParam().rms_mm, 0.006);
  EXPECT_TRUE(fit->bad.empty());
  EXPECT_FALSE(fit->scale);
  EXPECT_EQ(fit->checks, static_cast<int>(2 * GetParam().places - 5));
}

TEST_P(RealBelts, TheTwoConventionsOfThePrintDifferByLessThanTheHeights) {
  const auto level = fit_belts(import_.belts);
  import_.belts.machine.lengths = model::BeltLengths::belt_and_arm;
  const auto slanting = fit_belts(import_.belts);
  ASSERT_TRUE(level && slanting);
  for (std::size_t i = 0; i < level->coordinates.size(); ++i) {
    // c^2 / 2 m of 100 mm of height at 700 mm, the shortest belt here: 7 mm.
    EXPECT_NEAR(level->coordinates[i].fitted_mm, slanting->coordinates[i].fitted_mm, 7.0);
  }
}

TEST(RealBeltSets, HalfOfARebuiltFramePredictsTheOther) {
  const auto import = testing_support::published_readings("frame_rebuilt.txt");
  if (!import) GTEST_SKIP() << kNotHere;  // the logs are shared data, not part of a checkout
  const auto fit = fit_belts(import->belts);
  ASSERT_TRUE(fit && fit->half_left_out);
  // The other program's figure is 1.92, for one half by the other; here it is for both.
  EXPECT_NEAR(fit->half_left_out->rms_mm, 1.92, 0.05);
}

TEST(RealBeltSets, SixPlacesAreFittedWithLargeSigmas) {
  const auto import = testing_support::published_readings("clbm_2026-01.txt");
  if (!import) GTEST_SKIP() << kNotHere;  // the logs are shared data, not part of a checkout
  ASSERT_EQ(import->belts.points.size(), 6U);
  const auto fit = fit_belts(import->belts);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->checks, 7);
  // Five owners' frames from such a start were 1567 to 1830 mm high.
  EXPECT_GT(fit->coordinates[1].sigma_mm, 20.0);
}

TEST(RealBeltSets, ATensionTestShowsTheStretchOfEachPull) {
  const auto import = testing_support::published_readings("tension_test.txt");
  if (!import) GTEST_SKIP() << kNotHere;  // the logs are shared data, not part of a checkout
  EXPECT_EQ(import->belts.points.size(), 8U);
  EXPECT_EQ(import->warnings.size(), 2U);  // the lines in brackets, and too few places for a fit
  const auto fit = fit_belts(import->belts);
  ASSERT_FALSE(fit);
  // Four positions within 10 mm.
  EXPECT_EQ(fit.error().reason, BeltsFitFailure::Reason::not_determined);
  EXPECT_NE(fit.error().sentence().find("how much the pulled belts stretch"), std::string::npos);
  const auto pulls = repeated_pulls(import->belts);
  ASSERT_EQ(pulls.size(), 4U);
  // 4.38 of 1855.75 and 5.80 of 1855.04 mm, and so on, from the owner's notes; the last pair is his
  // control, without a change of pull.
  const double by_hand[] = {0.00274, 0.00178, 0.00288, 0.00018};
  for (std::size_t i = 0; i < pulls.size(); ++i) {
    EXPECT_NEAR(pulls[i].share, by_hand[i], 1e-5) << i;
    EXPECT_GT(pulls[i].sigma, 2e-5) << i;
    EXPECT_LT(pulls[i].sigma, 2e-4) << i;
  }
}

}  // namespace
}  // namespace chaintrue::grid

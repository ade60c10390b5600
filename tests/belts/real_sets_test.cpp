// SPDX-License-Identifier: GPL-3.0-or-later
// Published readings of real machines: anchors alone, compared with figures computed by another
// program. The readings stay in ../shared/data.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/repeated_pulls.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid {
namespace {

struct RealSet {
  const char* name;
  const char* file;
  int run;
  std::size_t places;
  double rms_mm;  ///< of all readings, anchors alone; computed elsewhere, to 0.01
};

/// Prints only the name: GoogleTest would print the bytes.
void PrintTo(const RealSet& set, std::ostream* out) { *out << set.name; }

class RealBelts : public testing::TestWithParam<RealSet> {
 protected:
  void SetUp() override {
    const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4";
    if (!std::filesystem::exists(folder / GetParam().file)) {
      GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here: " << folder;
    }
    files::Maslow4Options options;
    options.run = GetParam().run;
    import_ = files::parse_maslow4(
        files::read_whole_file(folder / GetParam().file), GetParam().file, options);
  }
  files::Maslow4Import import_;
};

INSTANTIATE_TEST_SUITE_P(Sets,
                         RealBelts,
                         testing::Values(RealSet{"concrete", "concrete_anchors.txt", 1, 99, 0.65},
                                         RealSet{"rebuilt", "frame_rebuilt.txt", 1, 99, 0.88},
                                         RealSet{"mini", "mini_frame.txt", 1, 46, 0.85},
                                         RealSet{"run_1", "ten_runs_1_to_5.txt", 1, 100, 1.12}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(RealBelts, AnchorsAloneLeaveWhatAnotherProgramFoundThatTheyLeave) {
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

TEST(RealBeltSets, HalfOfARebuiltFrameForetellsTheOtherAsAnotherProgramFound) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / "frame_rebuilt.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  const auto import = files::parse_maslow4(files::read_whole_file(path), "frame_rebuilt.txt");
  const auto fit = fit_belts(import.belts);
  ASSERT_TRUE(fit && fit->half_left_out);
  // The other program's figure is 1.92, for one half by the other; here it is for both.
  EXPECT_NEAR(fit->half_left_out->rms_mm, 1.92, 0.05);
}

TEST(RealBeltSets, FiveRunsOfOneFrameScatterByWhatTheirSigmasSay) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / "ten_runs_1_to_5.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  const std::string text = files::read_whole_file(path);
  constexpr int kRuns = 5;
  std::vector<BeltsFit> fits;
  for (int run = 1; run <= kRuns; ++run) {
    files::Maslow4Options options;
    options.run = run;
    const auto import = files::parse_maslow4(text, "ten_runs.txt", options);
    ASSERT_EQ(import.belts.points.size(), 100U);
    fits.push_back(diagnosis::fit_with_causes(import.belts).value());
  }
  double ratio = 0.0;
  for (std::size_t i = 0; i < fits.front().coordinates.size(); ++i) {
    double mean = 0.0, said = 0.0, scatter = 0.0;
    for (const BeltsFit& fit : fits) mean += fit.coordinates[i].fitted_mm / kRuns;
    for (const BeltsFit& fit : fits) {
      scatter += std::pow(fit.coordinates[i].fitted_mm - mean, 2) / (kRuns - 1);
      said += std::pow(fit.coordinates[i].sigma_mm, 2) / kRuns;
    }
    ratio += scatter / said / static_cast<double>(fits.front().coordinates.size());
  }
  // 20 degrees of freedom: nineteen times in twenty between 0.48 and 1.71 of the variance.
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 1.7);
}

TEST_P(RealBelts, AFitHasTheAnchorsOfADiagnosisAndStretchIsInIt) {
  const auto fit = diagnosis::fit_with_causes(import_.belts);
  ASSERT_TRUE(fit) << fit.error().sentence();
  diagnosis::DiagnosisOptions options;
  options.next_measurements = false;
  const auto found = diagnosis::diagnose(import_.belts, options);
  ASSERT_TRUE(found);
  for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
    EXPECT_EQ(fit->coordinates[i].fitted_mm, found->belts->coordinates[i].fitted_mm);
    EXPECT_EQ(fit->coordinates[i].sigma_mm, found->belts->coordinates[i].sigma_mm);
  }
  ASSERT_FALSE(fit->causes.empty());
  EXPECT_EQ(fit->causes.front().effect, "belt_stretch");
  // Published frames stretch by 0.12 to 0.26 % at the pull of their motors, to 0.1 % each.
  EXPECT_GT(fit->causes.front().parameters.at("elongation"), 0.0005);
  EXPECT_LT(fit->causes.front().parameters.at("elongation"), 0.004);
}

TEST(RealBeltSets, MorePlacesOfOneFrameMoveItsAnchorsByNoMoreThanWasSaid) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / "concrete_anchors.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  auto import = files::parse_maslow4(files::read_whole_file(path), "concrete.txt");
  const auto all = diagnosis::fit_with_causes(import.belts);
  import.belts.points.resize(57);
  const auto first = diagnosis::fit_with_causes(import.belts);
  ASSERT_TRUE(all && first);
  for (std::size_t i = 0; i < all->coordinates.size(); ++i) {
    // Three times what the fewer say: the others are among the more.
    EXPECT_LT(std::abs(all->coordinates[i].fitted_mm - first->coordinates[i].fitted_mm),
              3.0 * first->coordinates[i].sigma_mm)
        << all->coordinates[i].name;
  }
}

TEST(RealBeltSets, SixPlacesOfAStartAreFittedAndSaidToBeUncertain) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / "clbm_2026-01.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  const auto import = files::parse_maslow4(files::read_whole_file(path), "clbm.txt");
  ASSERT_EQ(import.belts.points.size(), 6U);
  const auto fit = fit_belts(import.belts);
  ASSERT_TRUE(fit) << fit.error().sentence();
  EXPECT_EQ(fit->checks, 7);
  // Five owners' frames from such a start were 1567 to 1830 mm high.
  EXPECT_GT(fit->coordinates[1].sigma_mm, 20.0);
}

TEST(RealBeltSets, ATensionTestIsOnALineAndTellsTheStretchOfEachPull) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / "tension_test.txt";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  const auto import = files::parse_maslow4(files::read_whole_file(path), "tension_test.txt");
  EXPECT_EQ(import.belts.points.size(), 8U);
  EXPECT_EQ(import.warnings.size(), 1U);
  const auto fit = fit_belts(import.belts);
  ASSERT_FALSE(fit);
  // Four positions within 10 mm.
  EXPECT_EQ(fit.error().reason, BeltsFitFailure::Reason::not_determined);
  EXPECT_NE(fit.error().sentence().find("what the pulled ones stretch by"), std::string::npos);
  const auto pulls = repeated_pulls(import.belts);
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

struct RealCause {
  const char* name;
  const char* file;
  int run;
  double rms_mm;       ///< at most, with one cause in addition to the anchors
  double predicted_mm;  ///< at most, each half predicted by the other
};
void PrintTo(const RealCause& set, std::ostream* out) { *out << set.name; }

/// Empty if the data are not present in this checkout.
std::optional<diagnosis::Diagnosis> diagnosed(const char* file, int run) {
  const std::filesystem::path path =
      std::filesystem::path(CHAINTRUE_SHARED_DATA) / "maslow4" / file;
  if (!std::filesystem::exists(path)) return std::nullopt;
  files::Maslow4Options options;
  options.run = run;
  const auto import = files::parse_maslow4(files::read_whole_file(path), file, options);
  return diagnosis::diagnose(import.belts).value();
}

class RealBeltCauses : public testing::TestWithParam<RealCause> {};

// rms: the required figures; predicted: the required figure, otherwise no worse than anchors alone.
INSTANTIATE_TEST_SUITE_P(Sets,
                         RealBeltCauses,
                         testing::Values(RealCause{"concrete", "concrete_anchors.txt", 1, 0.46, 1.37},
                                         RealCause{"rebuilt", "frame_rebuilt.txt", 1, 0.55, 1.25},
                                         RealCause{"mini", "mini_frame.txt", 1, 0.55, 1.81},
                                         RealCause{"run_1", "ten_runs_1_to_5.txt", 1, 0.73, 1.60},
                                         RealCause{"run_2", "ten_runs_1_to_5.txt", 2, 0.73, 1.60},
                                         RealCause{"run_3", "ten_runs_1_to_5.txt", 3, 0.73, 1.60},
                                         RealCause{"run_4", "ten_runs_1_to_5.txt", 4, 0.73, 1.60},
                                         RealCause{"run_5", "ten_runs_1_to_5.txt", 5, 0.73, 1.60}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(RealBeltCauses, PulledBeltsStretchAndNothingElseIsNamed) {
  const auto found = diagnosed(GetParam().file, GetParam().run);
  if (!found) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  ASSERT_EQ(found->causes.size(), 1U) << found->sentence;
  EXPECT_EQ(found->causes[0].cause.effect->id, "belt_stretch") << found->sentence;
  EXPECT_LT(found->belts->rms_mm, GetParam().rms_mm + 0.005) << "to the digits of what is asked";
  ASSERT_TRUE(found->belts->prediction);
  EXPECT_LT(found->belts->prediction->rms_mm, GetParam().predicted_mm);
  // Four owners' sets, computed by another program with the tensions of a sled of 0.3 of the pull: 0.13 to
  // 0.26 %; with a pattern the sigma states how well they are known.
  const auto& size = found->causes[0].parameters[0];
  EXPECT_NEAR(size.value, 0.0019, 0.0007 + 2.0 * size.sigma);
}

TEST(RealBeltSets, RunsOfOneFrameAgreeInTheStretchWithinTheirSigmas) {
  double square = 0.0;
  std::optional<diagnosis::ParameterEstimate> first;
  for (int run = 1; run <= 5; ++run) {
    const auto found = diagnosed("ten_runs_1_to_5.txt", run);
    if (!found) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
    ASSERT_FALSE(found->causes.empty());
    const auto size = found->causes[0].parameters[0];
    if (!first) first = size;
    square += std::pow(size.value - first->value, 2) /
              (size.sigma * size.sigma + first->sigma * first->sigma);
  }
  // Four differences of about unit variance: chi-squared with 4 degrees of freedom, 1 in 1000.
  EXPECT_LT(square, 18.5);
}

TEST(RealBeltSets, SixPlacesOfAStartGetNoName) {
  const auto found = diagnosed("clbm_2026-01.txt", 1);
  if (!found) GTEST_SKIP() << "../shared/data/maslow4 is not part of a checkout and is not here";
  EXPECT_TRUE(found->causes.empty()) << found->sentence;
}

}  // namespace
}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
// A chaintrue_diagnosis file has the content of the diagnosis; bad ones are in
// tests/cli/cases/diagnosis_files.cases.
#include "grid/files/diagnosis_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/effects/effect.hpp"
#include "tests/support/files.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::Diagnosis;
using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;

// Every member is written, in the documented order, null where there is none, and numbers with digits
// that read back as the same double: equal text is an equal diagnosis.
TEST(DiagnosisFile, IsWrittenBackToTheByte) {
  EXPECT_EQ(write_diagnosis(sample_diagnosis()),
            testing_support::read_text(CHAINTRUE_FIXTURES "/good/diagnosis_sample.json"));
  const std::string quiet = write_diagnosis(quiet_diagnosis());
  EXPECT_EQ(write_diagnosis(parse_diagnosis(quiet, "diagnosis.json")), quiet);
}

TEST(DiagnosisFile, IsReadIntoTheMembersOfItsKeys) {
  const Diagnosis read = sample_diagnosis();
  EXPECT_EQ(read.improvement->uncalibrated.rms_mm, 3.91);
  EXPECT_EQ(read.improvement->placed->high_mm, 2.44);
  EXPECT_EQ(read.transferred->extended.low_mm, 0.30);
  const auto& removals = read.stability->removals;
  EXPECT_EQ(removals[2].index, 2U);
  EXPECT_FALSE(removals[2].stands);
  EXPECT_EQ(removals[2].verdict, diagnosis::Verdict::named_set);
  EXPECT_EQ(removals.back().what, diagnosis::Removal::What::column);
  EXPECT_EQ(removals.back().at_mm, -1100.0);
  EXPECT_EQ(removals.back().points, 4U);
  EXPECT_EQ(read.outliers[0].index, 9U);
  EXPECT_EQ(read.outliers[0].shift_mm, Eigen::Vector2d(3.0, -4.0));
  EXPECT_EQ(read.causes[0].same_as[0].cause.effect->id, "tape_scale");
  EXPECT_EQ(read.causes[0].rival->effect->id, "tooth_skip");
  EXPECT_EQ(read.points[0].lengths.left_mm, 1493.333347811595);
  EXPECT_EQ(read.points[0].tension_right_n, 28.875505083928093);
  EXPECT_EQ(read.points[0].direction_right, -1);
  EXPECT_EQ(read.seed, 18446744073709551615ULL);
}

TEST(DiagnosisFile, NeverWritesNonFiniteNumbers) {
  Diagnosis found = sample_diagnosis();
  found.noise_factor = std::nan("");
  EXPECT_THROW((void)write_diagnosis(found), std::logic_error);
}

}  // namespace
}  // namespace chaintrue::grid::files

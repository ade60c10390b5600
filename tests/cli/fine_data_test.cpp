// SPDX-License-Identifier: GPL-3.0-or-later
// Correct results for readings much better than a tape's, such as a laser tracker's, and for
// exactly stated settings.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/map_file.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

class FineData : public testing_support::CommandFixture {
 protected:
  const std::string machine_ = std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json";

  [[nodiscard]] grid::diagnosis::Diagnosis diagnosed(const std::string& machine,
                                                     double noise_mm,
                                                     const std::string& more) const {
    EXPECT_EQ(run(fmt::format("simulate --machine {} --grid 7x4 --repeats 6 --jitter-mm 8 "
                              "--length-noise-mm {} --position-noise-mm {} {} --seed 3 -o g.json",
                              machine,
                              noise_mm,
                              noise_mm,
                              more))
                  .code,
              0);
    const auto outcome = run("diagnose g.json -o d.json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return grid::files::read_diagnosis(folder_ / "d.json");
  }
};

TEST_F(FineData, NameTheCauseWithItsSize) {
  constexpr double kTruth = 0.0012;
  for (const double noise_mm : {1e-3, 1e-6}) {
    SCOPED_TRACE(noise_mm);
    const auto found = diagnosed(machine_,
                                 noise_mm,
                                 fmt::format("--draw-settings --effect "
                                             "chain_pitch_error:left:elongation={}",
                                             kTruth));
    ASSERT_EQ(found.causes.size(), 1U);
    EXPECT_EQ(found.causes[0].cause.effect->id, "chain_pitch_error");
    const auto& size = found.causes[0].parameters.at(0);
    // Four sigmas: one draw in 16 000 lies beyond them.
    EXPECT_LT(std::abs(size.value - kTruth), 4.0 * size.sigma);
    EXPECT_THAT(found.notes, testing::Contains(testing::HasSubstr("; 0.01 mm was used instead")));
  }
}

/// Positions all over the bed, a function of the shift.
std::string places(int shift) {
  std::string text = "x_mm,y_mm\n";
  for (int i = 0; i < 40; ++i)
    text +=
        fmt::format("{},{}\n", -1100 + (i * 571 + shift) % 2200, -500 + (i * 263 + shift) % 1000);
  return text;
}

// Readings with all digits, of a machine whose left motor is 4 mm from its stated position.
TEST_F(FineData, AreFittedAndCheckedToTheirLastDigits) {
  write("places.csv", places(0));
  write("others.csv", places(37));
  std::string stated = testing_support::content_of(machine_);
  stated.replace(stated.find("-1489.2"), 7, "-1485.2");
  write("stated.json", stated);
  std::string shifted = testing_support::content_of(machine_);
  const std::string zero = "\"chain_zero\": {\"left_mm\": 0";
  ASSERT_NE(shifted.find(zero), std::string::npos);
  shifted.replace(shifted.find(zero), zero.size(), zero.substr(0, zero.size() - 1) + "0.1");
  write("shifted.json", shifted);
  const std::string read = " --points others.csv -o ";
  ASSERT_EQ(run("simulate --machine " + machine_ + " --points places.csv -o g.json").code, 0);
  ASSERT_EQ(run("simulate --machine " + machine_ + read + "new.json").code, 0);
  ASSERT_EQ(run("simulate --machine shifted.json" + read + "later.json").code, 0);
  for (const char* noise_mm : {"1e-3", "1e-5", "1e-6"}) {
    SCOPED_TRACE(noise_mm);
    const std::string noise = fmt::format(" --noise-length-mm {} --noise-position-mm 0", noise_mm);
    const auto fit = run("fit g.json --machine stated.json -o m.json --force" + noise);
    ASSERT_EQ(fit.code, 0) << fit.err;
    const auto map = grid::files::read_map(folder_ / "m.json");
    // The prior pulls the motor by 4 / 3 of its stated sigma against weights of at least 1e3 per
    // mm.
    EXPECT_LT(map.contents().accuracy.leave_one_out.chain.maximum_mm, 1e-5);
    EXPECT_THAT(run("check m.json new.json" + noise).out,
                testing::HasSubstr("The map is still valid"));
    EXPECT_THAT(run("check m.json later.json" + noise).out,
                testing::HasSubstr("The map is valid after re-zeroing"));
  }
}

TEST_F(FineData, FindNothingWhereNothingIs) {
  const auto found = diagnosed(machine_, 1e-6, "--draw-settings");
  EXPECT_EQ(found.verdict, grid::diagnosis::Verdict::nothing_found) << found.sentence;
}

// 0.2 mm of scatter with a stated noise of nearly zero.
TEST_F(FineData, StatedFarBelowWhatTheDataScatterAreAnsweredInWords) {
  ASSERT_EQ(run("simulate --machine " + machine_ +
                " --grid 7x4 --repeats 6 --jitter-mm 8 --length-noise-mm 0.2 "
                "--position-noise-mm 0.3 --stated-length-noise-mm 1e-12 "
                "--stated-position-noise-mm 0 --seed 1 -o g.json")
                .code,
            0);
  const auto diagnosis = run("diagnose g.json -o d.json");
  EXPECT_EQ(diagnosis.code, 0) << diagnosis.err;
  // There is no effect: no cause may be named for the scatter.
  EXPECT_TRUE(grid::files::read_diagnosis(folder_ / "d.json").causes.empty());
  const auto fit = run("fit g.json -o m.json");
  ASSERT_EQ(fit.code, 0);
  EXPECT_THAT(fit.err,
              testing::AnyOf(testing::HasSubstr("contradict the others"),
                             testing::HasSubstr("had not quite come to rest"),
                             testing::HasSubstr("times as much as you said")));
  // A reading that was not fitted adds its own 0.2 mm; the surface follows those that were.
  const auto accuracy = grid::files::read_map(folder_ / "m.json").contents().accuracy;
  EXPECT_GT(accuracy.leave_one_out.chain.rms_mm, 0.2);
  EXPECT_GT(accuracy.blocked.chain.rms_mm, 0.2);
}

TEST_F(FineData, SettingsMayBeStatedExactly) {
  std::string text = testing_support::content_of(machine_);
  for (const char* key : {"\"motor_position_mm\": ", "\"chain_zero_mm\": "}) {
    const std::size_t value = text.find(key) + std::string(key).size();
    ASSERT_NE(text.find(key), std::string::npos);
    text.replace(value, text.find_first_of(",}\n", value) - value, "0");
  }
  write("exact.json", text);
  const auto found =
      diagnosed("exact.json", 0.2, "--effect chain_pitch_error:left:elongation=0.0012");
  ASSERT_EQ(found.causes.size(), 1U);
  EXPECT_EQ(found.causes[0].cause.effect->id, "chain_pitch_error");
}

}  // namespace
}  // namespace chaintrue

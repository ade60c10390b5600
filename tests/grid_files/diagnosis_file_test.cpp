// SPDX-License-Identifier: GPL-3.0-or-later
// A chaintrue_diagnosis file has the content of the diagnosis, in the documented words and order.
#include "grid/files/diagnosis_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "grid/files/input_error.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::Diagnosis;
using grid::testing::quiet_diagnosis;
using grid::testing::sample_diagnosis;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

ordered_json written_sample() { return ordered_json::parse(write_diagnosis(sample_diagnosis())); }

std::vector<std::string> problems_in(const ordered_json& json) {
  try {
    (void)parse_diagnosis(json.dump(), "diagnosis.json");
  } catch (const InputError& error) {
    std::vector<std::string> messages;
    for (const InputProblem& problem : error.problems()) messages.push_back(problem.message());
    return messages;
  }
  return {};
}

// Every member is written, and numbers are written with digits that read back as the same double:
// equal text is an equal diagnosis.
TEST(DiagnosisFile, ReadsBackWhatItWrote) {
  for (const Diagnosis& said : {sample_diagnosis(), quiet_diagnosis()}) {
    const std::string text = write_diagnosis(said);
    const Diagnosis read = parse_diagnosis(text, "diagnosis.json");
    EXPECT_EQ(write_diagnosis(read), text);
    EXPECT_EQ(read.seed, said.seed);
    EXPECT_EQ(read.sentence, said.sentence);
    ASSERT_EQ(read.points.size(), said.points.size());
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      EXPECT_EQ(read.points[i].before_mm, said.points[i].before_mm);
      EXPECT_EQ(read.points[i].order, said.points[i].order);
      EXPECT_EQ(read.points[i].tension_right_n, said.points[i].tension_right_n);
      EXPECT_EQ(read.points[i].direction_right, said.points[i].direction_right);
    }
    ASSERT_EQ(read.causes.size(), said.causes.size());
    for (std::size_t i = 0; i < read.causes.size(); ++i) {
      EXPECT_EQ(read.causes[i].cause, said.causes[i].cause);
      EXPECT_EQ(read.causes[i].rival, said.causes[i].rival);
      EXPECT_EQ(read.causes[i].same_as.size(), said.causes[i].same_as.size());
    }
    EXPECT_EQ(read.improvement.has_value(), said.improvement.has_value());
    EXPECT_EQ(read.transferred.has_value(), said.transferred.has_value());
    EXPECT_EQ(read.stability.has_value(), said.stability.has_value());
  }
  const Diagnosis read = parse_diagnosis(write_diagnosis(sample_diagnosis()), "diagnosis.json");
  EXPECT_EQ(read.improvement->placed->high_mm, 2.44);
  EXPECT_EQ(read.transferred->extended.low_mm, 0.30);
  const auto& removals = read.stability->removals;
  EXPECT_EQ(removals[2].index, 2U);
  EXPECT_FALSE(removals[2].stands);
  EXPECT_EQ(removals[2].verdict, diagnosis::Verdict::named_set);
  EXPECT_EQ(removals.back().what, diagnosis::Removal::What::column);
  EXPECT_EQ(removals.back().at_mm, -1100.0);
  EXPECT_EQ(removals.back().points, 4U);
  EXPECT_EQ(read.outliers[0].shift_mm, Eigen::Vector2d(3.0, -4.0));
}

TEST(DiagnosisFile, HasItsKeysInTheOrderPromised) {
  const ordered_json json = written_sample();
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys,
              ElementsAre("file_type",
                          "format_version",
                          "verdict",
                          "sentence",
                          "what_to_do",
                          "not_proved",
                          "notes",
                          "causes",
                          "hypotheses",
                          "left_over",
                          "tool_today",
                          "visiting_order",
                          "bad_points",
                          "bad_point_shifts",
                          "not_testable",
                          "bounds",
                          "settings",
                          "gain",
                          "next_measurements",
                          "extended_machine",
                          "data_corrections",
                          "noise_factor",
                          "family_wise_p",
                          "points",
                          "seed",
                          "grid_name",
                          "stated_noise",
                          "stability",
                          "bed_parts",
                          "sessions",
                          "held_out_grid"));
  EXPECT_EQ(json["verdict"], "named");
  EXPECT_EQ(json["causes"][0]["effect"], "chain_pitch_error");
  EXPECT_EQ(json["causes"][0]["side"], "left");
  EXPECT_EQ(json["causes"][0]["parameters"]["elongation"]["value"], 0.0012);
  EXPECT_EQ(json["causes"][0]["same_as"][0]["effect"], "tape_scale");
  EXPECT_EQ(json["gain"]["position_rms_mm"],
            ordered_json::parse(R"({"as_delivered": 3.91, "placed": 2.2, "calibrated": 0.94,
                                    "extended": 0.31, "extended_and_surface": 0.3,
                                    "surface_only": 0.52, "noise_floor": 0.29})"));
  EXPECT_EQ(json["bad_points"], ordered_json::array({9}));
  EXPECT_EQ(json["extended_machine"]["file_type"], "chaintrue_machine");
}

TEST(DiagnosisFile, NeedsNoStability) {
  ordered_json json = written_sample();
  json.erase("stability");
  EXPECT_THAT(problems_in(json), ::testing::IsEmpty());
}

TEST(DiagnosisFile, PointsLeftOutHaveTheirPlace) {
  ordered_json json = written_sample();
  json["stability"]["removals"][0]["point"] = nullptr;
  json["stability"]["removals"][1]["what"] = "diagonal";
  json["stability"]["removals"].back()["at_mm"] = nullptr;
  EXPECT_THAT(
      problems_in(json),
      ::testing::UnorderedElementsAre(
          HasSubstr("/stability/removals/0/point"),
          HasSubstr("/stability/removals/1/what"),
          AllOf(HasSubstr("/at_mm"), HasSubstr("a number in mm"))));
}

TEST(DiagnosisFile, SaysNullWhereThereIsNone) {
  const ordered_json json = written_sample();
  EXPECT_TRUE(json["hypotheses"][2]["side"].is_null());
  EXPECT_TRUE(json["next_measurements"][0]["x_mm"].is_null());
  EXPECT_TRUE(json["next_measurements"][1]["side"].is_null());
  const ordered_json quiet = ordered_json::parse(write_diagnosis(quiet_diagnosis()));
  EXPECT_TRUE(quiet["left_over"]["follows"].is_null());
  EXPECT_FALSE(quiet.contains("gain"));
}

TEST(DiagnosisFile, ReportsEveryProblemAtOnceAndByItsPlace) {
  ordered_json json = written_sample();
  json["verdict"] = "guessed";
  json["causes"][0]["effect"] = "chain_pich_error";
  json["causes"][0]["same_as"][0]["side"] = "left";
  json["hypotheses"][0]["probability"] = 1.5;
  json["bounds"][1].erase("upper_95");
  json["gain"]["position_rms_mm"]["calibrated"] = "wide";
  json["gain"]["position_rms_90_percent_mm"]["extended"] = {0.5, 0.1};
  json["bad_point_shifts"] = ordered_json::array();
  json["points"][3]["before_mm"] = {1.0};
  json["next_measurements"][2]["y_mm"] = nullptr;
  json["settings"][0]["setting"] = "motor_middle_x_mm";
  json["extended_machine"]["sled"]["mass_kg"] = -1;
  json["seed"] = -1;
  json["colour"] = 1;
  const auto messages = problems_in(json);
  for (const char* expected :
       {"diagnosis.json: /verdict: found \"guessed\"",
        "/causes/0/effect: found \"chain_pich_error\"",
        "/causes/0/same_as/0/side: found \"left\", expected a side on which tape_scale acts",
        "/hypotheses/0/probability: found 1.5",
        "/bounds/1/upper_95",
        "/gain/position_rms_mm/calibrated: found \"wide\"",
        "/gain/position_rms_90_percent_mm/extended: found [0.5, 0.1], expected a pair of numbers "
        "in "
        "mm, the lower one first",
        "/bad_point_shifts: found [], expected as many shifts as there are bad_points",
        "/points/3/before_mm",
        "/next_measurements/2/y_mm",
        "/settings/0/setting: found \"motor_middle_x_mm\"",
        "/extended_machine/sled/mass_kg",
        "/seed: found -1",
        "/colour"}) {
    EXPECT_THAT(messages, Contains(HasSubstr(expected)));
  }
  EXPECT_EQ(messages.size(), 14U);
}

TEST(DiagnosisFile, RefusesAFoldCountThatCannotBe) {
  ordered_json json = written_sample();
  json["gain"]["folds_agree"] = 9;
  EXPECT_THAT(
      problems_in(json),
      ElementsAre(HasSubstr("/gain/folds_agree: found 9, expected at most as many as folds")));
}

TEST(DiagnosisFile, RefusesANameWithoutACause) {
  ordered_json json = written_sample();
  json["causes"] = ordered_json::array();
  EXPECT_THAT(problems_in(json),
              ElementsAre(HasSubstr(
                  "/causes: found none, expected at least one cause with the verdict \"named\"")));
}

TEST(DiagnosisFile, RefusesAParameterOfAnotherEffect) {
  ordered_json json = written_sample();
  json["causes"][0]["parameters"]["force_n"] = {{"value", 1.0}, {"sigma", 0.1}};
  EXPECT_THAT(problems_in(json),
              ElementsAre(HasSubstr("/causes/0/parameters/force_n: found force_n, expected a "
                                    "parameter of chain_pitch_error: elongation")));
}

TEST(DiagnosisFile, NeverWritesANumberThatIsNone) {
  Diagnosis found = sample_diagnosis();
  found.noise_factor = std::nan("");
  EXPECT_THROW((void)write_diagnosis(found), std::logic_error);
}

}  // namespace
}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_effect files: reading and writing, and every sentence about a bad one, with the line and
/// the column of a formula.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "grid/files/effect_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files::effect_files {
namespace {

using model::effects::Declaration;
using model::effects::declared_effect;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string with_formula(const std::string& formula, const std::string& id = "wave") {
  return R"JSON({
  "file_type": "chaintrue_effect", "format_version": "1.0", "id": ")JSON" +
         id + R"JSON(",
  "acts_on": "chain", "sides": ["left", "right"],
  "parameters": [
    {"name": "amplitude_mm", "null": 0, "nominal": 0.2, "prior_sigma": 0.2, "lower": 0, "upper": 5},
    {"name": "phase_rad", "role": "place", "prior_sigma": 3.14, "lower": -6.3, "upper": 6.3}
  ],
  "adds_mm": ")JSON" +
         formula + R"JSON(",
  "cause": "the sprocket is not round", "remedy": "change the sprocket", "not_modelled": "its third harmonic"
})JSON";
}

const std::string kGood = "amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)";

/// In a folder of the running test: others write such files at the same time.
std::filesystem::path written(const std::string& name, const std::string& text) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path(::testing::TempDir()) /
                      (std::string("chaintrue_effects_") + test->test_suite_name() + "_" + test->name());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / name) << text;
  return folder / name;
}

/// Every problem of such files, given to a machine as --effects does.
std::vector<std::string> said_of(const std::vector<std::string>& texts) {
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < texts.size(); ++i)
    paths.push_back(written("effect_" + std::to_string(i) + ".json", texts[i]));
  std::vector<std::string> messages;
  model::Machine machine;
  try {
    declare_effects(paths, machine);
  } catch (const InputError& error) {
    for (InputProblem problem : error.problems()) {
      problem.file = std::filesystem::path(problem.file).filename().string();
      messages.push_back(problem.message());
    }
  }
  return messages;
}

std::string only_sentence(const std::string& formula) {
  const std::vector<std::string> said = said_of({with_formula(formula)});
  return said.size() == 1 ? said.front() : ::testing::PrintToString(said);
}

TEST(EffectFile, IsReadWithItsAssumptions) {
  const Declaration own = parse_effect(with_formula(kGood), "wave.json");
  EXPECT_EQ(own.id, "wave");
  EXPECT_EQ(own.adds_mm, kGood);
  ASSERT_EQ(own.parameters.size(), 2U);
  EXPECT_EQ(own.parameters[1].nominal, 0.0);
  EXPECT_EQ(own.parameters[1].null, 0.0);
  EXPECT_EQ(own.typical, "amplitude_mm = 0.2");
}

TEST(EffectFile, ComesBackFromWhatIsWritten) {
  const Declaration own = parse_effect(with_formula(kGood), "wave.json");
  const std::string text = write_effect(own);
  EXPECT_EQ(parse_effect(text, "again.json"), own);
  EXPECT_EQ(write_effect(parse_effect(text, "again.json")), text);
}

TEST(EffectFile, IsKeptInTheMachine) {
  model::Machine machine;
  declare_effects({written("wave.json", with_formula(kGood))}, machine);
  ASSERT_EQ(machine.declared.size(), 1U);
  machine.effects = {{"wave", "left", {{"amplitude_mm", 0.3}, {"phase_rad", 1.0}}}};
  const std::string text = write_machine(machine);
  const model::Machine back = parse_machine(text, "machine.json");
  EXPECT_EQ(back.declared, machine.declared);
  EXPECT_EQ(write_machine(back), text);
}

TEST(EffectFile, TheSameTwiceIsOne) {
  model::Machine machine;
  const std::string path = written("wave.json", with_formula(kGood));
  declare_effects({path, path}, machine);
  EXPECT_EQ(machine.declared.size(), 1U);
}

TEST(BadEffectFile, AnUnknownName) {
  EXPECT_EQ(only_sentence("amplitude_mm * sin(4 * pi * L / turn + phase_rad)"),
            "effect_0.json: line 8, column 43: found L, expected a name that this formula may use: "
            "amplitude_mm, phase_rad, phi, S, L0, T, H, x, y, turn, pitch, r, d, side, mm, N, pi");
}

TEST(BadEffectFile, AWrongNumberOfArguments) {
  EXPECT_EQ(only_sentence("amplitude_mm * max(sin(phase_rad))"),
            "effect_0.json: line 8, column 30: found max with 1 argument, expected max with two "
            "arguments, as in max(a, b)");
}

TEST(BadEffectFile, AUnitThatDoesNotComeOutInMm) {
  EXPECT_EQ(
      only_sentence("amplitude_mm * T * sin(phase_rad)"),
      "effect_0.json: line 8, column 15: found a formula in mm N, expected one whose units come "
      "out as mm");
  EXPECT_EQ(
      only_sentence("amplitude_mm * sin(phase_rad) + T"),
      "effect_0.json: line 8, column 45: found mm together with N, expected two values of one unit to "
      "add or to compare");
}

TEST(BadEffectFile, AFormulaThatIsNotFinite) {
  EXPECT_EQ(
      only_sentence("amplitude_mm * phase_rad * log(x / mm)"),
      "effect_0.json: line 8, column 42: found not finite, expected a formula that is finite, "
      "with its slopes, over the bed of the machine between the bounds; this is not at "
      "(-1219, -610) mm with amplitude_mm = 0, phase_rad = -6.3");
}

TEST(BadEffectFile, AFormulaThatIsNotNullAtNull) {
  EXPECT_EQ(only_sentence("amplitude_mm * phase_rad + 0.5"),
            "effect_0.json: line 8, column 15: found 0.5, expected a formula that gives 0 at null; "
            "this gives 0.5 at (-1219, -610) mm with amplitude_mm = 0, phase_rad = -6.3");
}

TEST(BadEffectFile, TwoEffectsOfOneName) {
  EXPECT_THAT(
      said_of({with_formula(kGood), with_formula("amplitude_mm * cos(L0 / turn + phase_rad)")}),
      ElementsAre("effect_1.json: /id: found wave, expected a name that no other effect has: "
                  "two of one name are declared"));
  EXPECT_THAT(said_of({with_formula(kGood, "drift")}),
              ElementsAre(HasSubstr("/id: found drift, expected another name: the catalogue has")));
}

TEST(BadEffectFile, AParameterThatNoFormulaUses) {
  EXPECT_EQ(
      only_sentence("amplitude_mm * sin(L0 / turn)"),
      "effect_0.json: /parameters/1/name: found phase_rad, expected a parameter that the formula "
      "uses, or none");
}

TEST(BadEffectFile, TenThousandNestedBrackets) {
  EXPECT_EQ(
      only_sentence(std::string(10000, '(') + "amplitude_mm * phase_rad" + std::string(10000, ')')),
      "effect_0.json: line 8, column 47: found brackets, signs and powers more than 32 deep, "
      "expected a formula that is written with fewer of them inside each other");
}

TEST(BadEffectFile, EveryFileIsReported) {
  EXPECT_EQ(said_of({with_formula("amplitude_mm +"), with_formula("phase_rad *")}).size(), 2U);
}

TEST(BadEffectFile, AMissingWordIsNamed) {
  std::string text = with_formula(kGood);
  text.replace(text.find("\"remedy\""), 8, "\"remedie\"");
  EXPECT_THAT(
      said_of({text}),
      ElementsAre(HasSubstr("/remedie: found \"change the sprocket\", expected \"remedy\"?")));
}

TEST(BadEffectFile, InAMachineItIsSaidWithItsPlace) {
  model::Machine machine;
  declare_effects({written("wave.json", with_formula(kGood))}, machine);
  std::string text = write_machine(machine);
  text.replace(text.find("L0 / turn"), 2, "L1");
  try {
    (void)parse_machine(text, "machine.json");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_THAT(
        error.problems()[0].message(),
        HasSubstr("machine.json: /declared_effects/0/adds_mm, column 29 of the formula: found L1, "
                  "expected a name that this formula may use"));
  }
}

// What a declaration says of a bed depends on the bed: finite on one machine's and not on another's.
TEST(BadEffectFile, TheBedIsTheMachinesOwn) {
  const std::string text = with_formula("amplitude_mm * phase_rad * log(2 + x / (700 * mm))");
  EXPECT_EQ(said_of({text}).size(), 0U) << "log(2 - 1.74) on the classic bed";
  model::Machine wide;
  wide.bed.width_mm = 2900.0;
  wide.motors = {{-1900.0, 1300.0}, {1900.0, 1300.0}};
  EXPECT_THROW(declare_effects({written("wave.json", text)}, wide), InputError);
}

}  // namespace
}  // namespace chaintrue::grid::files::effect_files

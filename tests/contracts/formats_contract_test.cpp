// SPDX-License-Identifier: GPL-3.0-or-later
// The contract of every file format on versions: the written version is read without a warning; an
// older one is read with a warning of what is assumed; a newer one is rejected with both versions
// in the message; text that is not a version is rejected as well.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/drawing_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/formats.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/files/sweep_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::filesystem::path fixture(const std::string& name) {
  return std::filesystem::path(CHAINTRUE_FIXTURES) / name;
}

/// The result of reading a text: problems, or warnings only.
struct Outcome {
  std::vector<std::string> problems;
  std::vector<std::string> warnings;
};

/// The reader of a format, and a file of it in the written version.
struct Sample {
  std::function<std::vector<Warning>(const std::string& text)> read;
  std::function<std::string()> text;
  /// The same file in the form of an older version; the version itself is set by the test.
  std::function<std::string(std::string text, std::string_view version)> aged = nullptr;
};

std::function<std::string()> text_of(const std::string& name) {
  return [name] { return read_whole_file(fixture(name)); };
}

std::string map_text() {
  const auto map = fit(read_grid(fixture("grids/seven_by_four.json")).grid);
  return write_map(map.value());
}

/// Maps of version 1.0 had no hash; of those of 1.1 it is taken out, since it is of the version too.
std::string aged_map(std::string text, std::string_view) {
  Problems problems("map.json");
  Json json = parse_json(text, problems);
  json.erase("content_hash");
  return print_json(json);
}

/// Diagnoses of version 1.0 have neither the remainder nor the budget of the error; those of 1.1 have
/// no belts, and those of 1.2 no next measurements of belts; this one has none of these. Those before 1.4
/// have no parts of the bed, and those before 1.5 do not say what is left without a part of the error.
/// Those before 1.6 do not say what they were made from, nor how far the machine misses as it is used, and those
/// before 1.7 no order that was found, those before 1.8 no laws, those before
/// 1.9 no points next to these, and no answers to declared effects, and those before 1.10 no wave with its
/// second harmonic, and those before 1.11 no laws of holes
/// and of belts, nor how well one predicts what was left out, and those before 1.12 no causes given a law.
std::string aged_diagnosis(std::string text, std::string_view version) {
  Problems problems("diagnosis.json");
  Json json = parse_json(text, problems);
  const bool has_laws = json.contains("unexplained") && json["unexplained"].contains("laws");
  if (has_laws) json["unexplained"].erase("causes_given_law");
  if (version == "1.11") return print_json(json);
  if (has_laws) {
    for (Json& law : json["unexplained"]["laws"]) law.erase("held_out");
  }
  if (version == "1.9" || version == "1.10") return print_json(json);
  if (has_laws) {
    for (Json& law : json["unexplained"]["laws"]) law.erase("points");
  }
  json.erase("declared");
  if (version == "1.8") return print_json(json);
  if (json.contains("unexplained")) json["unexplained"].erase("laws");
  if (version == "1.7") return print_json(json);
  json.erase("visiting_order");
  if (version == "1.6") return print_json(json);
  json.erase("made_by");
  json.erase("tool_today");
  if (version == "1.5") return print_json(json);
  json.erase("bed_parts");
  json.erase("sessions");
  for (Json& line : json["budget"]["parts"]) line.erase("without_mm");
  if (version == "1.0") {
    json.erase("unexplained");
    json.erase("budget");
  }
  return print_json(json);
}

/// Holes of version 1.0 have no machine on four belts; this one is of chains.
std::string unchanged(std::string text, std::string_view) { return text; }

/// Anchors of version 1.0 are of belts alone, those of 1.1 have no hash, those of 1.2 neither causes nor what they were
/// made from; the hash of 1.2 and 1.3 is taken out, since it is of the version too.
std::string aged_anchors(std::string text, std::string_view version) {
  Problems problems("anchors.json");
  Json json = parse_json(text, problems);
  json.erase("content_hash");
  if (version == "1.3") return print_json(json);
  json.erase("made_by");
  json["fit"].erase("causes");
  if (version == "1.0") json.erase("holes");
  return print_json(json);
}

/// Belts of version 1.0 do not say how hard they were pulled.
std::string aged_belts(std::string text, std::string_view) {
  Problems problems("belts.json");
  Json json = parse_json(text, problems);
  for (Json& point : json["points"]) point.erase("pull_ma");
  return print_json(json);
}

/// Plotters and drawings of version 1.0 say neither Marlin's pieces nor correlations.
std::string aged_plotter(std::string text, std::string_view) {
  Problems problems("plotter.json");
  Json json = parse_json(text, problems);
  json["set"].erase("segments_per_second");
  if (json.contains("found")) json["found"].erase("correlations");
  return print_json(json);
}

/// A sweep names other files by their path relative to its own.
std::vector<Warning> read_sweep_text(const std::string& text) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("formats_" + name);
  std::filesystem::create_directories(folder / "sweeps");
  std::filesystem::copy(
      fixture("machines"),
      folder / "machines",
      std::filesystem::copy_options::overwrite_existing | std::filesystem::copy_options::recursive);
  std::ofstream(folder / "sweeps" / "sweep.json") << text;
  return read_sweep(folder / "sweeps" / "sweep.json").warnings;
}

const std::map<std::string_view, Sample>& samples() {
  static const std::map<std::string_view, Sample> by_type = {
      {kMachineFormat.file_type,
       {[](const std::string& text) {
          return parse_machine_with_warnings(text, "machine.json").warnings;
        },
        text_of("good/machine_every_key.json")}},
      {kGridFormat.file_type,
       {[](const std::string& text) { return parse_grid(text, "grid.json").warnings; },
        text_of("grids/seven_by_four.json")}},
      {kHolesFormat.file_type,
       {[](const std::string& text) { return parse_holes(text, "holes.json").warnings; },
        text_of("holes/nine_holes.json"),
        unchanged}},
      {kBeltsFormat.file_type,
       {[](const std::string& text) { return parse_belts(text, "belts.json").warnings; },
        text_of("good/belts_every_key.json"),
        aged_belts}},
      {kAnchorsFormat.file_type,
       {[](const std::string& text) {
          std::vector<Warning> warnings;
          (void)parse_anchors(text, "anchors.json", &warnings);
          return warnings;
        },
        text_of("good/anchors_every_key.json"),
        aged_anchors}},
      {kMapFormat.file_type,
       {[](const std::string& text) {
          std::vector<Warning> warnings;
          (void)parse_map(text, "map.json", &warnings);
          return warnings;
        },
        map_text,
        aged_map}},
      {kDiagnosisFormat.file_type,
       {[](const std::string& text) {
          std::vector<Warning> warnings;
          (void)parse_diagnosis(text, "diagnosis.json", &warnings);
          return warnings;
        },
        text_of("good/diagnosis_every_key.json"),
        aged_diagnosis}},
      {kEffectFormat.file_type,
       {[](const std::string& text) {
          (void)parse_effect(text, "effect.json");
          return std::vector<Warning>{};
        },
        text_of("effects/second_harmonic.json")}},
      {kPlotterFormat.file_type,
       {[](const std::string& text) {
          std::vector<Warning> warnings;
          (void)parse_plotter(text, "plotter.json", &warnings);
          return warnings;
        },
        text_of("good/plotter_every_key.json"),
        aged_plotter}},
      {kDrawingFormat.file_type,
       {[](const std::string& text) {
          std::vector<Warning> warnings;
          (void)parse_drawing(text, "drawing.json", &warnings);
          return warnings;
        },
        text_of("good/drawing_every_key.json"),
        aged_plotter}},
      {kSweepFormat.file_type, {read_sweep_text, text_of("sweeps/quick.json")}}};
  return by_type;
}

Outcome outcome_of(const Sample& sample, const std::string& text) {
  Outcome outcome;
  try {
    for (const Warning& warning : sample.read(text)) outcome.warnings.push_back(warning.message());
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems())
      outcome.problems.push_back(problem.message());
  }
  return outcome;
}

/// Replaces the file's own version, not that of a machine inside it.
std::string with_version(const std::string& text, const Json& version) {
  Problems problems("sample.json");
  Json json = parse_json(text, problems);
  EXPECT_TRUE(json.contains("format_version"));
  json["format_version"] = version;
  return print_json(json);
}

std::pair<int, int> parts_of(std::string_view version) {
  const std::size_t dot = version.find('.');
  return {std::stoi(std::string(version.substr(0, dot))),
          std::stoi(std::string(version.substr(dot + 1)))};
}

std::vector<const Format*> formats_read() {
  std::vector<const Format*> read;
  std::copy_if(
      kFormats.begin(), kFormats.end(), std::back_inserter(read), [](const Format* format) {
        return format->is_read;
      });
  return read;
}

class FormatVersions : public ::testing::TestWithParam<const Format*> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(samples().contains(GetParam()->file_type)) << "no sample of this format";
    sample_ = &samples().at(GetParam()->file_type);
    text_ = sample_->text();
  }
  [[nodiscard]] Outcome of_version(const Json& version) const {
    return outcome_of(*sample_, with_version(text_, version));
  }

  const Sample* sample_ = nullptr;
  std::string text_;
};

TEST_P(FormatVersions, TheVersionThatIsWrittenIsReadWithoutAWord) {
  const Outcome outcome = outcome_of(*sample_, text_);
  EXPECT_THAT(outcome.problems, IsEmpty());
  for (const OlderVersion& older : GetParam()->older)
    EXPECT_THAT(outcome.warnings, Not(Contains(HasSubstr(std::string(older.assumed)))));
}

TEST_P(FormatVersions, AnOlderVersionIsReadAndWhatIsAssumedIsSaid) {
  for (const OlderVersion& older : GetParam()->older) {
    EXPECT_LT(parts_of(older.version), parts_of(GetParam()->version));
    ASSERT_NE(sample_->aged, nullptr) << "no sample of version " << older.version;
    const Outcome outcome = outcome_of(
        *sample_, with_version(sample_->aged(text_, older.version), std::string(older.version)));
    EXPECT_THAT(outcome.problems, IsEmpty());
    EXPECT_THAT(outcome.warnings, Contains(HasSubstr(std::string(older.assumed))));
  }
}

TEST_P(FormatVersions, ANewerVersionIsRefusedWithTheSentenceThatNamesBoth) {
  const auto [major, minor] = parts_of(GetParam()->version);
  // Ten follows nine: versions are numbers, not texts.
  for (const auto& newer :
       {std::pair(major, minor + 1), std::pair(major, minor + 9), std::pair(major + 1, 0)}) {
    const std::string version = std::to_string(newer.first) + "." + std::to_string(newer.second);
    EXPECT_THAT(
        of_version(version).problems,
        ::testing::ElementsAre(AllOf(HasSubstr("/format_version: found \"" + version + "\""),
                                     HasSubstr("this file is of version " + version +
                                               ", newer than " + std::string(GetParam()->version)),
                                     HasSubstr("take the chaintrue that wrote it"))));
  }
}

TEST_P(FormatVersions, WhatIsNoVersionThatEverWasIsRefused) {
  for (const Json& version :
       {Json("0.9"), Json("1"), Json("1."), Json("1.0 "), Json(1.0), Json()}) {
    const Outcome outcome = of_version(version);
    EXPECT_THAT(outcome.problems,
                ::testing::ElementsAre(
                    AllOf(HasSubstr("/format_version: found"),
                          HasSubstr("\"" + std::string(GetParam()->version) + "\", the version"))))
        << version;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats,
                         FormatVersions,
                         ::testing::ValuesIn(formats_read()),
                         [](const auto& tested) { return std::string(tested.param->file_type); });

TEST(FormatVersionsOfAll, NoTwoFormatsShareAType) {
  std::vector<std::string_view> types;
  for (const Format* format : kFormats) types.push_back(format->file_type);
  std::sort(types.begin(), types.end());
  EXPECT_EQ(std::adjacent_find(types.begin(), types.end()), types.end());
}

// A format with two older versions, whose samples cannot be forgotten.
struct Growing {
  double value = 0.0;
};
constexpr std::array kOlderGrowing = {OlderVersion{"1.0", "no unit stated; taken as mm"},
                                      OlderVersion{"1.9", "no side stated; taken as left"}};
constexpr Format kGrowingFormat{"chaintrue_growing", "1.10", kOlderGrowing};

Outcome growing_outcome(const Json& version) {
  static const auto record = Record<Growing>("a growing file", kGrowingFormat)
                                 .required("value", &Growing::value, number({"mm", -1.0, 1.0}));
  Json json = headed(kGrowingFormat);
  json["value"] = 0.5;
  json["format_version"] = version;
  Outcome outcome;
  Problems problems("growing.json");
  try {
    EXPECT_EQ(read_document(record, print_json(json), problems).value, 0.5);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems())
      outcome.problems.push_back(problem.message());
  }
  for (const Warning& warning : problems.warnings()) outcome.warnings.push_back(warning.message());
  return outcome;
}

TEST(FormatVersionsOfAll, EachOlderVersionSaysItsOwnAssumption) {
  EXPECT_THAT(growing_outcome("1.10").warnings, IsEmpty());
  EXPECT_THAT(growing_outcome("1.0").warnings, ::testing::ElementsAre(HasSubstr("taken as mm")));
  EXPECT_THAT(growing_outcome("1.9").warnings, ::testing::ElementsAre(HasSubstr("taken as left")));
  EXPECT_THAT(growing_outcome("1.11").problems,
              ::testing::ElementsAre(HasSubstr("version 1.11, newer than 1.10")));
  // Older, but never written.
  EXPECT_THAT(
      growing_outcome("1.2").problems,
      ::testing::ElementsAre(HasSubstr(
          "expected \"1.0\" or \"1.9\" or \"1.10\", the versions that this program reads")));
}

}  // namespace
}  // namespace chaintrue::grid::files

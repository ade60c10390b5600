// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The contract of every file format on versions: the written version is read, any other is refused.
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
#include "grid/files/machine_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/plotter_file.hpp"
#include "grid/files/sweep_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/fit.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::filesystem::path fixture(const std::string& name) {
  return std::filesystem::path(CHAINTRUE_FIXTURES) / name;
}

/// The reader of a format, and a file of it.
struct Sample {
  std::function<void(const std::string& text)> read;
  std::function<std::string()> text;
};

std::function<std::string()> text_of(const std::string& name) {
  return [name] { return read_whole_file(fixture(name)); };
}

/// A reader of text, as Sample takes it.
template <class Thing>
std::function<void(const std::string&)> by(Thing (*parse)(const std::string&, const std::string&)) {
  return [parse](const std::string& text) { (void)parse(text, "sample.json"); };
}

std::string map_text() {
  const auto map = fit(read_grid(fixture("grids/seven_by_four.json")).grid);
  return write_map(map.value());
}

/// A sweep names other files by their path relative to its own.
void read_sweep_text(const std::string& text) {
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
  (void)read_sweep(folder / "sweeps" / "sweep.json");
}

const std::map<std::string_view, Sample>& samples() {
  static const std::map<std::string_view, Sample> by_type = {
      {kMachineFormat.file_type, {by(parse_machine), text_of("good/machine_every_key.json")}},
      {kGridFormat.file_type,
       {[](const std::string& text) { (void)parse_grid(text, "grid.json"); },
        text_of("grids/seven_by_four.json")}},
      {kHolesFormat.file_type,
       {[](const std::string& text) { (void)parse_holes(text, "holes.json"); },
        text_of("holes/nine_holes.json")}},
      {kBeltsFormat.file_type,
       {[](const std::string& text) { (void)parse_belts(text, "belts.json"); },
        text_of("good/belts_every_key.json")}},
      {kAnchorsFormat.file_type, {by(parse_anchors), text_of("good/anchors_every_key.json")}},
      {kMapFormat.file_type, {by(parse_map), map_text}},
      {kDiagnosisFormat.file_type, {by(parse_diagnosis), text_of("good/diagnosis_every_key.json")}},
      {kEffectFormat.file_type,
       {[](const std::string& text) { (void)parse_effect(text, "effect.json"); },
        text_of("effects/second_harmonic.json")}},
      {kPlotterFormat.file_type, {by(parse_plotter), text_of("good/plotter_every_key.json")}},
      {kDrawingFormat.file_type, {by(parse_drawing), text_of("good/drawing_every_key.json")}},
      {kSweepFormat.file_type, {read_sweep_text, text_of("sweeps/quick.json")}}};
  return by_type;
}

std::vector<std::string> problems_of(const Sample& sample, const std::string& text) {
  std::vector<std::string> problems;
  try {
    sample.read(text);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) problems.push_back(problem.message());
  }
  return problems;
}

/// Replaces the file's own version, not that of a machine inside it.
std::string with_version(const std::string& text, const Json& version) {
  Problems problems("sample.json");
  Json json = parse_json(text, problems);
  EXPECT_TRUE(json.contains("format_version"));
  json["format_version"] = version;
  return print_json(json);
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
  }

  const Sample* sample_ = nullptr;
};

TEST_P(FormatVersions, ReadsTheWrittenVersionAndRefusesEveryOther) {
  const std::string text = sample_->text();
  EXPECT_THAT(problems_of(*sample_, text), IsEmpty());
  for (const Json& version : {Json("0.9"),
                              Json("1.1"),
                              Json("1.10"),
                              Json("2.0"),
                              Json("1"),
                              Json("1.0 "),
                              Json(1.0),
                              Json()}) {
    EXPECT_THAT(problems_of(*sample_, with_version(text, version)),
                ::testing::ElementsAre(AllOf(HasSubstr("/format_version: found"),
                                             HasSubstr("the version that this program reads"))))
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

}  // namespace
}  // namespace chaintrue::grid::files

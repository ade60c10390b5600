// SPDX-License-Identifier: GPL-3.0-or-later
// Maps, diagnoses, anchors and compensated programs say where they come from: no folder, no date, the
// same bytes for the same input; and who uses one with an input that has changed since is warned.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue::provenance_command_test {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;

class ProvenanceOfCommands : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    take("grids/seven_by_four.json", "grid.json");
  }
  void take(const std::string& fixture, const std::string& name) const {
    std::filesystem::copy_file(std::filesystem::path(CHAINTRUE_FIXTURES) / fixture, folder_ / name);
  }
  [[nodiscard]] json made_by(const std::string& file) const {
    return json::parse(content_of(folder_ / file)).at("made_by");
  }
  /// As another program has it.
  [[nodiscard]] std::string sha256(const std::string& file) const {
    return run_line("sha256sum < " + file).out.substr(0, 64);
  }
  /// The first two readings of the file change places.
  void change(const std::string& file) const {
    json grid = json::parse(content_of(folder_ / file));
    std::swap(grid["points"][0]["left_mm"], grid["points"][1]["left_mm"]);
    write(file, grid.dump(1));
  }
};

TEST_F(ProvenanceOfCommands, OfAMapAreVersionVerbOptionsAndInputs) {
  ASSERT_EQ(run("fit grid.json --outside refuse -o map.json --json").code, 0);
  const json found = made_by("map.json");
  EXPECT_EQ("chaintrue " + found.at("version").get<std::string>(),
            "chaintrue " + run_line("chaintrue --version | tr -d '\\n'").out);
  EXPECT_EQ(found.at("verb"), "fit");
  EXPECT_THAT(found.at("options"), ElementsAre("--outside refuse"));
  ASSERT_EQ(found.at("inputs").size(), 1u);
  EXPECT_EQ(found.at("inputs")[0].at("name"), "grid.json");
  EXPECT_EQ(found.at("inputs")[0].at("sha256"), sha256("grid.json"));
}

TEST_F(ProvenanceOfCommands, AFoundPlotterSaysWhatItWasMadeFrom) {
  ASSERT_EQ(run("fit " CHAINTRUE_FIXTURES "/plotter/mural_drawing.json -o found.json").code, 0);
  const json found = made_by("found.json");
  EXPECT_EQ(found.at("verb"), "fit");
  EXPECT_EQ(found.at("inputs")[0].at("name"), "mural_drawing.json");
}

TEST_F(ProvenanceOfCommands, FoldersAndOutputsLeaveNoTrace) {
  ASSERT_EQ(run("fit grid.json -o map.json").code, 0);
  const Outcome elsewhere = run_line(
      "mkdir there && cp grid.json there && cd there && chaintrue fit $PWD/grid.json -o other.json "
      "--force --verbose");
  ASSERT_EQ(elsewhere.code, 0) << elsewhere.err;
  EXPECT_EQ(content_of(folder_ / "map.json"), content_of(folder_ / "there" / "other.json"));
}

TEST_F(ProvenanceOfCommands, FilesThatOptionsNameAreInputs) {
  take("machines/classic.json", "machine.json");
  ASSERT_EQ(run("fit grid.json --machine ./machine.json -o map.json").code, 0);
  const json found = made_by("map.json");
  EXPECT_THAT(found.at("options"), ElementsAre("--machine machine.json"));
  ASSERT_EQ(found.at("inputs").size(), 2u);
  EXPECT_EQ(found.at("inputs")[1].at("sha256"), sha256("machine.json"));
}

TEST_F(ProvenanceOfCommands, AChangedInputOfADiagnosisIsSaid) {
  ASSERT_EQ(run("diagnose grid.json -o diagnosis.json").code, 0);
  EXPECT_EQ(made_by("diagnosis.json").at("inputs")[0].at("sha256"), sha256("grid.json"));
  const char* said = "grid.json is not as it was when diagnosis.json was made from it";
  EXPECT_THAT(run("plan grid.json --after diagnosis.json").err, Not(HasSubstr(said)));
  change("grid.json");
  EXPECT_THAT(run("plan grid.json --after diagnosis.json").err, HasSubstr(said));
}

TEST_F(ProvenanceOfCommands, OfAnchorsAndOfTheMapOfExportAreTheirs) {
  take("belts/thirty_one_places.json", "belts.json");
  ASSERT_EQ(run("fit belts.json -o anchors.json").code, 0);
  EXPECT_EQ(made_by("anchors.json").at("inputs")[0].at("name"), "belts.json");
  ASSERT_EQ(run("fit grid.json -o map.json").code, 0);
  const Outcome exported = run("export groundcontrol map.json -o set.ini --map-after after.json");
  if (exists("after.json")) {
    EXPECT_EQ(made_by("after.json").at("verb"), "export groundcontrol");
    EXPECT_EQ(made_by("after.json").at("inputs")[0].at("sha256"), sha256("map.json"));
  } else {
    FAIL() << exported.err;
  }
}

TEST_F(ProvenanceOfCommands, PagesShowIt) {
  ASSERT_EQ(run("fit grid.json -o map.json && chaintrue report map.json -o map.html && chaintrue "
                "diagnose grid.json -o d.json --report d.html")
                .code,
            0);
  for (const char* page : {"map.html", "d.html"}) {
    const std::string text = content_of(folder_ / page);
    EXPECT_THAT(text, HasSubstr("<summary><h2>Where this comes from</h2></summary>")) << page;
    EXPECT_THAT(text, HasSubstr(sha256("grid.json"))) << page;
  }
}

TEST_F(ProvenanceOfCommands, OfACompensatedProgramAreInItsHeadAndOnItsPage) {
  take("gcode/bracket.nc", "part (final) & old.nc");
  ASSERT_EQ(run("fit grid.json -o map.json").code, 0);
  const Outcome done =
      run("gcode compensate 'part (final) & old.nc' --map map.json --tolerance-mm 0.1 -o true.nc "
          "--report page.html");
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string text = content_of(folder_ / "true.nc");
  EXPECT_THAT(text,
              HasSubstr("gcode compensate)\n(option --map map.json)\n(option --tolerance-mm "
                        "0.1)\n(from map.json)\n"));
  // What a controller might act on does not stand in a comment.
  EXPECT_THAT(text, HasSubstr("(from part _final_ _ old.nc)\n"));
  for (const char* file : {"map.json", "'part (final) & old.nc'"})
    EXPECT_THAT(text, HasSubstr("(sha256 begins " + sha256(file).substr(0, 32) + ")\n"));
  EXPECT_THAT(content_of(folder_ / "page.html"), HasSubstr(sha256("map.json")));
}

TEST_F(ProvenanceOfCommands, VerifyingWithAnotherMapIsSaid) {
  take("gcode/bracket.nc", "part.nc");
  ASSERT_EQ(run("fit grid.json -o map.json").code, 0);
  ASSERT_EQ(run("gcode compensate part.nc --map map.json -o true.nc").code, 0);
  EXPECT_THAT(run("gcode verify part.nc true.nc --map map.json").err,
              Not(HasSubstr("compensate again")));
  ASSERT_EQ(run("fit grid.json --outside refuse -o map.json").code, 0);
  EXPECT_THAT(run("gcode verify part.nc true.nc --map map.json").err,
              HasSubstr("true.nc was not made from map.json as it is now: compensate again."));
}

}  // namespace chaintrue::provenance_command_test

// SPDX-License-Identifier: GPL-3.0-or-later
// V-plotters through the command: settings in, a test page out, what a ruler read of it in, and the
// numbers to type in out. Pens hang by tests/lab/generator, which shares no equation with the product.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "generator/hidden/plotter.hpp"
#include "grid/files/drawing_file.hpp"
#include "model/plotter/plotter_controller.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/cli/ruler.hpp"

namespace chaintrue::plotter_command_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;
using Json = nlohmann::ordered_json;

constexpr double kSpacingMm = 1500.0;
constexpr double kPulleyMm = 12.69;
constexpr double kMassBelowMm = 20.0;

/// A mural as the generator can hang one: stiff belts, pulleys as far off the wall as the pins, and a
/// tilt below half a radian.
Json stiff_mural() {
  return Json::parse(R"({
  "file_type": "chaintrue_plotter", "format_version": "1.0",
  "set": {"firmware": "mural", "machine": {
    "name": "stiff mural", "pin_spacing_mm": 1500, "motors": "gondola", "pulley_radius_mm": 6.345,
    "gondola": {"spacing_mm": 85, "mass_below_mm": 20, "mass_kg": 0.55},
    "cord": {"compliance_per_n": 0},
    "area": {"left_mm": -400, "right_mm": 400, "top_mm": -300, "bottom_mm": -1100}}}})");
}

/// What is typed into the firmware.
struct Typed {
  double top_distance_mm = kSpacingMm;
  double pulley_diameter_mm = kPulleyMm;
  double homed_offset_mm = 40.0;
};

/// A mural whose belts hang with 17 mm where 40 mm are stated (nikivanov/mural, pull request 43).
class HiddenMural {
 public:
  HiddenMural() {
    plotter_.pin_spacing_mm = kSpacingMm;
    plotter_.pulley_radius_mm = 0.5 * kPulleyMm;
    plotter_.motors_in_gondola = true;
    plotter_.spacing_mm = 85.0;
    plotter_.mass_below_mm = kMassBelowMm;
  }
  /// Where the pen comes to rest for a command in the frame of the pins.
  [[nodiscard]] generator::PenAtRest pen(const Typed& typed, double x_mm, double y_mm) const {
    model::PlotterMachine set = model::mural(typed.top_distance_mm);
    set.pulley_radius_mm = 0.5 * typed.pulley_diameter_mm;
    set.gondola.standoff_mm = 0.0;
    set.gondola.mass_below_mm = kMassBelowMm;
    set.cord.compliance_per_n = 0.0;
    const auto counted = model::paid_out(model::PlotterFirmware::mural, set, {x_mm, y_mm});
    EXPECT_TRUE(counted);
    const auto hung = [&](double counted_mm) {
      constexpr double kHungMm = 17.0;
      return kHungMm + (counted_mm - typed.homed_offset_mm) * kPulleyMm / typed.pulley_diameter_mm;
    };
    return generator::lowest_pose(plotter_, hung(counted->left_mm), hung(counted->right_mm));
  }

 private:
  generator::HiddenPlotter plotter_;
};

/// The drawing with every null filled in, to a tenth of a millimetre as a person writes.
Json filled_in(const Json& drawing, const Typed& typed, double noise_mm, std::uint64_t seed) {
  const HiddenMural mural;
  return testing_support::ruled(
      drawing, [&](double x_mm, double y_mm) { return mural.pen(typed, x_mm, y_mm); }, noise_mm, seed);
}

double largest_bow(const Json& drawing) {
  double most = 0.0;
  for (const Json& measure : drawing.at("measures")) {
    if (measure.at("kind") == "bow")
      most = std::max(most, std::abs(measure.at("value_mm").get<double>()));
  }
  return most;
}

double after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  EXPECT_NE(at, std::string::npos) << words << " in " << text;
  return at == std::string::npos ? 0.0 : std::stod(text.substr(at + words.size()));
}

class Plotter : public testing_support::CommandFixture {
 protected:
  /// The page of a plotter, planned by start.
  [[nodiscard]] Json page_of(const Json& plotter, const std::string& folder) const {
    write("plotter.json", plotter.dump(1));
    const Outcome start = run("start plotter.json " + folder);
    EXPECT_EQ(start.code, 0) << start.err;
    return Json::parse(content_of(folder_ / folder / "drawing.json"));
  }
  [[nodiscard]] Json first_drawing(std::uint64_t seed) const {
    return filled_in(page_of(stiff_mural(), "first"), {}, 0.5, seed);
  }
  [[nodiscard]] Outcome fit(const Json& drawing) const {
    write("drawing.json", drawing.dump(1));
    return run("fit drawing.json -o found.json --force");
  }
};

TEST_F(Plotter, StartMakesAPageASheetAndADrawingToFillIn) {
  const Outcome start = run("start " CHAINTRUE_FIXTURES "/plotter/mural.txt shop");
  ASSERT_EQ(start.code, 0) << start.err;
  for (const char* file : {"page.svg", "sheet.txt", "drawing.json", "plotter.json"})
    EXPECT_TRUE(exists(std::string("shop/") + file)) << file;
  EXPECT_THAT(start.err, HasSubstr("Next: chaintrue fit shop/drawing.json -o shop/found.json\n"));
  const Json drawing = Json::parse(content_of(folder_ / "shop" / "drawing.json"));
  EXPECT_EQ(drawing.at("measures").size(), 24U);
  for (const Json& measure : drawing.at("measures")) EXPECT_TRUE(measure.at("value_mm").is_null());
  const Outcome blank = run("fit shop/drawing.json -o found.json");
  EXPECT_EQ(blank.code, 3);
  EXPECT_THAT(blank.err, HasSubstr("0 measures; 12 at least"));
  // Started again it replaces what nobody filled in, and nothing else.
  EXPECT_EQ(run("start " CHAINTRUE_FIXTURES "/plotter/mural.txt shop").code, 0);
  write("shop/drawing.json", first_drawing(1).dump(1));
  const Outcome again = run("start " CHAINTRUE_FIXTURES "/plotter/mural.txt shop");
  EXPECT_EQ(again.code, 3);
  EXPECT_THAT(again.err, HasSubstr("shop/drawing.json"));
}

TEST_F(Plotter, AMuralsZero23MmOffIsNamedAndTheNextPageBowsUnder1Mm) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Json drawing = first_drawing(seed);
    EXPECT_GT(largest_bow(drawing), 8.0);
    const Outcome fitted = fit(drawing);
    ASSERT_EQ(fitted.code, 0) << fitted.err;
    EXPECT_THAT(fitted.err,
                AllOf(HasSubstr("Off by more than chance: "),
                      HasSubstr("the zero of the left cord, by +2"),
                      HasSubstr("the zero of the right cord, by +2"),
                      HasSubstr("Next: chaintrue export plotter found.json")));
    const Outcome lines = run("export plotter found.json");
    ASSERT_EQ(lines.code, 0) << lines.err;
    const Typed typed{after(lines.out, "top distance: "),
                      after(lines.out, "effective pulley diameter: "),
                      after(lines.out, "homed step offset: ")};
    // The second page is planned for these numbers, and drawn with them.
    const Outcome second = run("start found.json second" + std::to_string(seed));
    ASSERT_EQ(second.code, 0) << second.err;
    const Json page =
        Json::parse(content_of(folder_ / ("second" + std::to_string(seed)) / "drawing.json"));
    EXPECT_NEAR(page.at("set").at("homed_offset_mm").get<double>(),
                typed.homed_offset_mm,
                0.005);  // as printed
    const Json next = filled_in(page, typed, 0.0, seed);
    EXPECT_LT(largest_bow(next), 1.0);
    const Outcome sound = fit(filled_in(page, typed, 0.5, seed + 100));
    ASSERT_EQ(sound.code, 0) << sound.err;
    EXPECT_THAT(sound.err, Not(HasSubstr("zero of the left cord, by")));
  }
}

TEST_F(Plotter, TheFixtureIsAPageOfThisMural) {
  EXPECT_EQ(Json::parse(content_of(CHAINTRUE_FIXTURES "/plotter/mural_drawing.json"))["measures"],
            first_drawing(1)["measures"])
      << first_drawing(1).dump(1);
}

TEST_F(Plotter, SlipsAreNamedAndNothingIsWritten) {
  const Json drawing = first_drawing(3);
  const auto value = [](Json& slipped, std::size_t i) -> Json& {
    return slipped["measures"][i]["value_mm"];
  };
  const auto scaled = [&](double factor) {
    Json slipped = drawing;
    for (Json& measure : slipped["measures"])
      measure["value_mm"] = factor * measure["value_mm"].get<double>();
    return slipped;
  };
  Json exchanged = drawing;
  std::swap(value(exchanged, 0), value(exchanged, 6));
  Json along = drawing;
  value(along, 18) = 900.0;
  for (const auto& [slipped, words] : {std::pair{scaled(1.0 / 25.4), "read in inches"},
                                       std::pair{scaled(0.5), "the page was scaled"},
                                       std::pair{exchanged, "typed into each other's row"},
                                       std::pair{along, "that is a length along the line"}}) {
    const Outcome fitted = fit(slipped);
    EXPECT_EQ(fitted.code, 3) << words;
    EXPECT_THAT(fitted.err, HasSubstr(words));
    EXPECT_FALSE(exists("found.json")) << words;
  }
  write("mural.txt", "top distance: 110 mm\n");
  const Outcome near = run("start mural.txt shop");
  EXPECT_EQ(near.code, 3);
  EXPECT_THAT(near.err, HasSubstr("one and a half times the gondola's spacing"));
  EXPECT_FALSE(exists("shop"));
  // Without a drawing there is nothing to type in.
  write("plotter.json", stiff_mural().dump(1));
  const Outcome nothing = run("export plotter plotter.json");
  EXPECT_EQ(nothing.code, 3);
  EXPECT_THAT(nothing.err, HasSubstr("/found"));
  EXPECT_EQ(nothing.out, "");
}

TEST_F(Plotter, AMeasureThatFitsNothingIsLeftOut) {
  Json drawing = first_drawing(2);
  drawing["measures"][9]["value_mm"] = drawing["measures"][9]["value_mm"].get<double>() + 12.0;
  const Outcome fitted = fit(drawing);
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("the length E-F was left out"));
}

/// The page of a mural has these numbers, and a calibration that lets out a length and asks for a tape's.
TEST_F(Plotter, EveryNumberOfAMuralIsTakenOrRefused) {
  write("mural.txt",
        "top distance: 1500 mm\neffective pulley diameter: 12.69 mm\nhomed step offset: 40 mm\n"
        "bot mass: 0.8 kg\nbelt elongation: 3e-5 1/N\nextended: 1000 mm\nmeasured: 1004 mm\n");
  const Outcome import = run("import plotter mural.txt -o plotter.json");
  ASSERT_EQ(import.code, 0) << import.err;
  EXPECT_THAT(import.err, AllOf(HasSubstr("85 mm between its pulleys"), Not(HasSubstr("0.8 kg"))));
  const Json machine = Json::parse(content_of(folder_ / "plotter.json")).at("set").at("machine");
  EXPECT_EQ(machine.at("gondola").at("mass_kg"), 0.8);
  EXPECT_EQ(machine.at("cord").at("compliance_per_n"), 3e-5);
  EXPECT_NEAR(machine.at("pulley_radius_mm").get<double>(), 0.5 * 12.69 * 1.004, 1e-12);
  for (const auto& [line, words] :
       {std::pair{"measured: 1004 mm", "extended: missing, expected both distances"}, std::pair{"pen angle: 40", "one of top distance"}}) {
    write("bad.txt", std::string("top distance: 1500 mm\n") + line + "\n");
    const Outcome bad = run("import plotter bad.txt -o bad.json");
    EXPECT_EQ(bad.code, 3) << line;
    EXPECT_THAT(bad.err, HasSubstr(words));
    EXPECT_FALSE(exists("bad.json"));
  }
}

/// A name before --atlas draws that cause or setting alone; one that the machine does not have is refused.
TEST_F(Plotter, AnAtlasOfOneCauseIsOfThatAlone) {
  write("mural.txt", "top distance: 1500 mm\neffective pulley diameter: 12.69 mm\nhomed step offset: 40 mm\n");
  const Outcome one = run("effects gondola_mass --atlas mural.txt -o one.html");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("one.html: a picture of what may be wrong"));
  const Outcome none = run("effects nonsense --atlas mural.txt -o none.html");
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("effect: found nonsense, expected a cause or a setting of mural.txt"));
  EXPECT_FALSE(exists("none.html"));
}

TEST_F(Plotter, SettingsOfEachControllerBecomeAPlotter) {
  for (const auto& [file, words] :
       {std::pair{"plottersettings_fluidnc.yaml", "\"firmware\": \"fluidnc\""},
        std::pair{"plottersettings_marlin_log.txt", "\"firmware\": \"marlin\""},
        std::pair{"plottersettings_configuration.h", "\"firmware\": \"marlin\""},
        std::pair{"plottersettings_polargraph.properties", "\"firmware\": \"polargraph\""}}) {
    const std::string path = std::string(CHAINTRUE_FIXTURES "/good/") + file;
    const Outcome import = run("import plotter " + path + " -o plotter.json --force");
    ASSERT_EQ(import.code, 0) << file << import.err;
    EXPECT_THAT(content_of(folder_ / "plotter.json"), HasSubstr(words));
    EXPECT_THAT(import.err, HasSubstr("Next: chaintrue start plotter.json test-drawing"));
    const Outcome start = run(std::string("start plotter.json ") + file + ".folder");
    EXPECT_EQ(start.code, 0) << file << start.err;
  }
  // 325^2 + 983^2 = 1035^2: both belts paid out whole.
  ASSERT_EQ(run("import plotter " CHAINTRUE_FIXTURES
                "/good/plottersettings_marlin_log.txt -o marlin.json")
                .code,
            0);
  const Json set = Json::parse(content_of(folder_ / "marlin.json")).at("set");
  EXPECT_NEAR(
      set.at("home").at("y_mm").get<double>(), -std::sqrt(1035.0 * 1035.0 - 325.0 * 325.0), 1e-9);
  EXPECT_EQ(set.at("pins_middle").at("y_mm"), 500.0);
  EXPECT_EQ(set.at("steps_per_mm").at("left"), 80.0);
  // The same machine by its log and by its source.
  ASSERT_EQ(run("import plotter " CHAINTRUE_FIXTURES
                "/good/plottersettings_configuration.h -o source.json")
                .code,
            0);
  Json source = Json::parse(content_of(folder_ / "source.json")).at("set");
  source["machine"]["name"] = set.at("machine").at("name");
  EXPECT_EQ(source, set);
  const Outcome none = run("import plotter " CHAINTRUE_FIXTURES "/good/groundcontrol_ring.ini");
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.err, HasSubstr("no settings of a V-plotter"));
}

}  // namespace
}  // namespace chaintrue::plotter_command_test

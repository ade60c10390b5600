// SPDX-License-Identifier: GPL-3.0-or-later
// V-plotters through the command: settings in, a test page out, ruler readings in, and the numbers
// to type in out. Pens hang by tests/lab/generator, which shares no equation with the product.
#include <gmock/gmock.h>

#include <cmath>
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

/// A mural that the generator can simulate: stiff belts, pulleys as far off the wall as the pins,
/// and a tilt below half a radian.
Json stiff_mural() {
  return Json::parse(R"({
  "file_type": "chaintrue_plotter", "format_version": "1.0",
  "set": {"firmware": "mural", "machine": {
    "name": "stiff mural", "pin_spacing_mm": 1500, "motors": "gondola", "pulley_radius_mm": 6.345,
    "gondola": {"spacing_mm": 85, "mass_below_mm": 20, "mass_kg": 0.55},
    "cord": {"compliance_per_n": 0},
    "area": {"left_mm": -400, "right_mm": 400, "top_mm": -300, "bottom_mm": -1100}}}})");
}

/// The firmware's settings.
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
  generator::PenAtRest pen(const Typed& typed, double x_mm, double y_mm) const {
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

/// The drawing with every null filled in, to a tenth of a millimetre.
Json filled_in(const Json& drawing, const Typed& typed, double noise_mm, std::uint64_t seed) {
  const HiddenMural mural;
  return testing_support::ruled(
      drawing, [&](double x_mm, double y_mm) { return mural.pen(typed, x_mm, y_mm); }, noise_mm,
      seed);
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
  Json page_of(const Json& plotter, const std::string& folder) const {
    write("plotter.json", plotter.dump(1));
    done("start plotter.json " + folder);
    return Json::parse(content_of(folder_ / folder / "drawing.json"));
  }
  Json first_drawing(std::uint64_t seed) const {
    return filled_in(page_of(stiff_mural(), "first"), {}, 0.5, seed);
  }
  [[nodiscard]] Outcome fit(const Json& drawing) const {
    write("drawing.json", drawing.dump(1));
    return done("fit drawing.json -o found.json --force");
  }
};

TEST_F(Plotter, DiagnosisAndNewSettingsStraightenAMural) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Json drawing = first_drawing(seed);
    EXPECT_GT(largest_bow(drawing), 8.0);
    const Outcome fitted = fit(drawing);
    EXPECT_THAT(fitted.err, AllOf(HasSubstr("the zero of the left cord, by +2"),
                                  HasSubstr("the zero of the right cord, by +2")));
    const Outcome lines = done("export plotter found.json");
    const Typed typed{after(lines.out, "top distance: "),
                      after(lines.out, "effective pulley diameter: "),
                      after(lines.out, "homed step offset: ")};
    // The second page is planned for these numbers, and drawn with them.
    done("start found.json second" + std::to_string(seed));
    const Json page =
        Json::parse(content_of(folder_ / ("second" + std::to_string(seed)) / "drawing.json"));
    EXPECT_NEAR(page.at("set").at("homed_offset_mm").get<double>(), typed.homed_offset_mm,
                0.005);  // as printed
    const Json next = filled_in(page, typed, 0.0, seed);
    EXPECT_LT(largest_bow(next), 1.0);
    const Outcome sound = fit(filled_in(page, typed, 0.5, seed + 100));
    EXPECT_THAT(sound.err, Not(HasSubstr("zero of the left cord, by")));
  }
}

TEST_F(Plotter, FixtureIsAPageOfThisMural) {
  EXPECT_EQ(Json::parse(content_of(CHAINTRUE_FIXTURES "/plotter/mural_drawing.json"))["measures"],
            first_drawing(1)["measures"])
      << first_drawing(1).dump(1);
}

}  // namespace
}  // namespace chaintrue::plotter_command_test

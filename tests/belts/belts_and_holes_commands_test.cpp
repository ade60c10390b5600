// SPDX-License-Identifier: GPL-3.0-or-later
// Belts, holes and a program to cut, through the command; the compensated program is run on the
// simulated machine.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/json_value.hpp"
#include "grid/files/sources.hpp"
#include "tests/belts/holes_simulation.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using model::BedPoint;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;
using testing_support::without_origin;

/// Positions of X and Y words; a missing word keeps its value.
std::vector<BedPoint> corners_of(const std::string& program) {
  std::vector<BedPoint> corners;
  std::istringstream lines(program);
  for (std::string line; std::getline(lines, line);) {
    const auto x = line.find('X');
    const auto y = line.find('Y');
    if (line.empty() || line[0] != 'G' || x == std::string::npos || y == std::string::npos)
      continue;
    corners.push_back({std::stod(line.substr(x + 1)), std::stod(line.substr(y + 1))});
  }
  return corners;
}

class BeltAndHoleCommands : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    write("belts.json", grid::files::write_belts(set_.belts));
    write("holes.json", grid::files::write_holes(set_.holes.set, set_.holes.machine));
    write("part.nc",
          "G21 G90 G17\nG0 Z5\nG0 X-800 Y-400\nG1 Z-2 F500\nG1 X800 Y-400 F1500\nG1 X800 Y400\n"
          "G1 X-800 Y400\nG1 X-800 Y-400\nG0 Z5\nM30\n");
  }
  /// The true machine's tool position for a command, with the anchors of `believed` in its
  /// controller.
  BedPoint tool(const model::BeltMachine& believed, BedPoint command) const {
    const model::FramePoint meant = model::to_frame(believed, command);
    const auto span = [&](model::Belt belt) {
      const model::Anchor& anchor = believed.anchors[belt];
      return std::hypot(meant.x_mm - anchor.x_mm, meant.y_mm - anchor.y_mm);
    };
    return set_.tool(span(model::Belt::tl), span(model::Belt::tr));
  }
  /// Rms distance of the cut shape, after a best-fit placement, from the intended rectangle: for
  /// each of its points the nearest point of the outline.
  double residual_mm(const std::string& program, const model::BeltMachine& believed) const {
    std::vector<BedPoint> cut;
    BedPoint least{1e9, 1e9};
    BedPoint most{-1e9, -1e9};
    for (const BedPoint command : corners_of(program)) {
      const BedPoint at = cut.emplace_back(tool(believed, command));
      least = {std::min(least.x_mm, at.x_mm), std::min(least.y_mm, at.y_mm)};
      most = {std::max(most.x_mm, at.x_mm), std::max(most.y_mm, at.y_mm)};
    }
    EXPECT_GE(cut.size(), 4U);
    std::vector<BedPoint> wanted;
    for (BedPoint& at : cut) {
      at = {at.x_mm - 0.5 * (least.x_mm + most.x_mm), at.y_mm - 0.5 * (least.y_mm + most.y_mm)};
      BedPoint on{std::clamp(at.x_mm, -800.0, 800.0), std::clamp(at.y_mm, -400.0, 400.0)};
      const bool upright = 800.0 - std::abs(at.x_mm) < 400.0 - std::abs(at.y_mm);
      if (upright) {
        on.x_mm = std::copysign(800.0, at.x_mm);
      } else {
        on.y_mm = std::copysign(400.0, at.y_mm);
      }
      wanted.push_back(on);
    }
    return grid::rms_when_laid(cut, wanted);
  }

  const grid::SimulatedHoles set_ =
      grid::simulate_with_holes({.seed = 41, .unmodelled_mm = 3.0, .tape_mm = 0.2, .hole_mm = 0.1});
};

TEST_F(BeltAndHoleCommands, TheFitDoesNotDependOnFileOrder) {
  const Outcome fit = done("fit belts.json --with holes.json -v -o anchors.json");
  EXPECT_THAT(fit.err, HasSubstr("24 distances"));
  done("fit holes.json --with belts.json -o other.json");
  EXPECT_EQ(without_origin(content_of(folder_ / "anchors.json")),
            without_origin(content_of(folder_ / "other.json")));
  const std::string text = content_of(folder_ / "anchors.json");
  const auto found = grid::files::parse_anchors(text, "a.json");
  EXPECT_EQ(grid::files::write_anchors(found, grid::files::made_by_of(text, "a.json")), text);
  const Outcome alone = done("fit holes.json -o alone.json");
  EXPECT_THAT(alone.err, HasSubstr("24 distances"));
}

TEST_F(BeltAndHoleCommands, ACompensatedProgramCutsAccuratelyOnTheUnmodifiedController) {
  done("fit belts.json --with holes.json -o anchors.json");
  done("gcode compensate part.nc --map anchors.json -o part.true.nc");
  const model::BeltMachine& believed = set_.holes.machine;
  const double before = residual_mm(content_of(folder_ / "part.nc"), believed);
  const double after = residual_mm(content_of(folder_ / "part.true.nc"), believed);
  std::cout << "tool off the outline, mm: " << before << " as it is, " << after << " compensated\n";
  const Outcome asked = done("gcode verify part.nc part.true.nc --map anchors.json --json");
  const double stated = grid::files::Json::parse(asked.out).at("expected_mm").get<double>();
  std::cout << "stated, mm: " << stated << "\n";
  // One draw of few independent parts, and a half wave of the tool's between nine holes, which their
  // prior takes for smoother than it is: 2.1 sigmas here.
  EXPECT_LT(after, 2.5 * stated);
  EXPECT_GT(before, 1.0);  // 0.4 % of the 800 and 400 mm from the middle to an edge
  // A third of the tool's displacement from its belts: nine holes resolve a half wave between them.
  EXPECT_LT(after, 1.0);
  done("gcode verify part.nc part.true.nc --map anchors.json");
  EXPECT_EQ(run("gcode verify part.nc part.nc --map anchors.json").code, 1);
  const Outcome lengths = done("gcode lengths part.nc --map anchors.json");
  EXPECT_THAT(lengths.out, HasSubstr("line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,left_sigma_mm"));
}

TEST_F(BeltAndHoleCommands, PastedAnchorsLeaveOnlyTheBend) {
  done("fit belts.json --with holes.json -o anchors.json");
  done("gcode compensate part.nc --map anchors.json --machine anchors.json -o part.true.nc");
  const auto found = grid::files::parse_anchors(content_of(folder_ / "anchors.json"), "a.json");
  const model::BeltMachine pasted = grid::files::machine_as_pasted(found.fit);
  const double before = residual_mm(content_of(folder_ / "part.nc"), pasted);
  const double after = residual_mm(content_of(folder_ / "part.true.nc"), pasted);
  std::cout << "tool off the outline, mm: " << before << " with the pasted anchors, " << after
            << " compensated\n";
  EXPECT_LT(after, 1.0);  // as above
  EXPECT_LT(after, before);
}

TEST_F(BeltAndHoleCommands, BeltsAloneCompensateForTheAnchorsOnly) {
  done("fit belts.json -o anchors.json");
  const Outcome made = done("gcode compensate part.nc --map anchors.json -o part.true.nc");
  // The same error, and the same of the scale, from the commands that look at a program.
  const std::string words = "That is in millimetres of belt";
  EXPECT_THAT(made.err, HasSubstr(words));
  const Outcome verified = done("gcode verify part.nc part.true.nc --map anchors.json");
  EXPECT_THAT(verified.out, HasSubstr(words));
  EXPECT_THAT(run("gcode verify part.nc part.true.nc --map anchors.json --json").out,
              testing::Not(HasSubstr("\"expected_mm\": null")));
  EXPECT_THAT(run("gcode check part.nc --map anchors.json").out, HasSubstr(words));
  // Its page shows the frame of the anchors, not half of the usual bed of a chain machine.
  const Outcome page =
      done("gcode compensate part.nc --map anchors.json -o again.nc --report page.html");
  const std::string html = content_of(folder_ / "page.html");
  EXPECT_THAT(html, HasSubstr("sheet_x_min_mm"));
  EXPECT_THAT(html, testing::Not(HasSubstr("-1219.2")));
}

TEST_F(BeltAndHoleCommands, HolesAloneAreNotDiagnosed) {
  EXPECT_EQ(run("diagnose holes.json").code, 3);
}

}  // namespace
}  // namespace chaintrue

// SPDX-License-Identifier: GPL-3.0-or-later
// A machine whose tool reaches every command exactly, from an owner's tuned groundcontrol.ini: from
// the import to the numbers to type in, no error may be reported.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grid/files/diagnosis_file.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;

class Uncalibrated : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    write("groundcontrol.ini", R"([Maslow Settings]
bedheight = 1219.2
bedwidth = 2438.4
motoroffsety = 473.8636
motorspacingx = 3602.8722
[Advanced Settings]
rotationradius = 139.1003
gearteeth = 10
chainpitch = 6.35
chainsagcorrection = 28.969761
leftchaintolerance = 0.1237252
rightchaintolerance = 0.1683196
topbeamtilt = 0.0727796
chainoversprocket = Top
kinematicstype = Triangular
)");
    std::string marks = "x_mm,y_mm,commanded_x_mm,commanded_y_mm\n";
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 7; ++column) {
        const int x = -1080 + 360 * column;
        const int y = -510 + 340 * row;
        marks += fmt::format("{},{},{},{}\n", x, y, x, y);
      }
    }
    write("marks.csv", marks);
    ASSERT_EQ(run("import groundcontrol groundcontrol.ini -o machine.json").code, 0);
  }
};

TEST_F(Uncalibrated, AMachineThatIsRightIsSaidToBeRight) {
  const Outcome fit =
      run("fit marks.csv --machine machine.json --noise-length-mm 0.1 --noise-position-mm 0.3 "
          "-o map.json");
  EXPECT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(
      fit.err,
      HasSubstr("Your machine needs no map: it misses by no more than these readings can show"));
  const Outcome diagnose =
      run("diagnose marks.csv --machine machine.json --noise-length-mm 0.1 --noise-position-mm 0.3 "
          "-o diagnosis.json");
  EXPECT_EQ(diagnose.code, 0) << diagnose.err;
  const auto found = grid::files::read_diagnosis(folder_ / "diagnosis.json");
  ASSERT_TRUE(found.improvement);
  // Command and measurement have the same digits; the solution for the tool adds rounding.
  EXPECT_NEAR(found.improvement->uncalibrated.rms_mm, 0.0, 1e-9);
}

TEST_F(Uncalibrated, NoNumberOfItChanges) {
  const Outcome of_machine = run("export groundcontrol machine.json -o typed.ini");
  EXPECT_EQ(of_machine.code, 0) << of_machine.err;
  EXPECT_THAT(of_machine.err, HasSubstr("No number changes."));
  ASSERT_EQ(run("fit marks.csv --machine machine.json --noise-length-mm 0.1 --noise-position-mm "
                "0.3 -o map.json")
                .code,
            0);
  const Outcome of_map = run("export groundcontrol map.json -o again.ini");
  EXPECT_EQ(of_map.code, 0) << of_map.err;
  EXPECT_THAT(of_map.err, HasSubstr("so keep yours"));
  EXPECT_EQ(content_of(folder_ / "again.ini"), content_of(folder_ / "typed.ini"));
  EXPECT_THAT(content_of(folder_ / "typed.ini"), HasSubstr("chainsagcorrection = 28.969761\n"));
  EXPECT_THAT(content_of(folder_ / "typed.ini"), HasSubstr("rightchaintolerance = 0.1683196\n"));
}

}  // namespace
}  // namespace chaintrue

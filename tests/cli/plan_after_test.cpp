// SPDX-License-Identifier: GPL-3.0-or-later
// chaintrue plan --after, from a diagnosis whose next measurements are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "grid/files/diagnosis_file.hpp"
#include "grid/files/grid_file.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/support/sample_diagnosis.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

class PlanAfter : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    const auto sample = grid::testing::sample_diagnosis();
    grid::MeasuredGrid grid;
    grid.machine = sample.extended_machine;
    std::string csv = "x_mm,y_mm,left_mm,right_mm\n";
    for (const auto& point : sample.points) {
      grid.points.push_back({point.mark, point.lengths, std::nullopt, point.order});
      csv += std::to_string(point.mark.x_mm) + "," + std::to_string(point.mark.y_mm) + "," +
             std::to_string(point.lengths.left_mm) + "," + std::to_string(point.lengths.right_mm) +
             "\n";
    }
    write("d.json", grid::files::write_diagnosis(sample));
    write("grid.json", grid::files::write_grid(grid));
    write("grid.csv", csv);
  }
};

TEST_F(PlanAfter, ListsWhatToMeasureAndTheLinesToAdd) {
  const Outcome answer = run("plan grid.json --after d.json --svg next.svg");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out,
            "\"points\": add, each null filled in\n"
            "  {\"x_mm\": -1099.2, \"y_mm\": -499.5, \"left_mm\": null, \"right_mm\": null, "
            "\"order\": 28},\n"
            "  {\"x_mm\": 1150.0, \"y_mm\": 540.0, \"left_mm\": null, \"right_mm\": null, "
            "\"order\": 29},\n"
            "\"readings\": add, each null filled in\n"
            "  {\"what\": \"link_pitch_mm\", \"side\": \"left\", \"value\": null, \"sigma\": "
            "0.001},\n");
  EXPECT_THAT(answer.err, AllOf(HasSubstr("98 %"), HasSubstr("99.5 %"), HasSubstr("(1150, 540)")));
  EXPECT_THAT(content_of(folder_ / "next.svg"), AllOf(HasSubstr(">2</text>"), HasSubstr(">3</text>")));
}

// The CSV has six decimals of the marks: the points are still recognised.
TEST_F(PlanAfter, SpeaksCsvToACsv) {
  const Outcome answer = run("plan grid.csv --after d.json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out, "x_mm,y_mm,left_mm,right_mm\n-1099.2,-499.5,,\n1150.0,540.0,,\n");
}

TEST_F(PlanAfter, RefusesADiagnosisOfOtherPointsOrOfNone) {
  EXPECT_EQ(run("plan " CHAINTRUE_FIXTURES "/grids/seven_by_four.json --after d.json -o l.txt").code, 3);
  EXPECT_FALSE(exists("l.txt"));
  EXPECT_EQ(run("plan grid.json --after missing.json").code, 3);
  EXPECT_EQ(run("plan --after d.json").code, 2);
  EXPECT_EQ(run("plan grid.json").code, 2);
}

}  // namespace
}  // namespace chaintrue

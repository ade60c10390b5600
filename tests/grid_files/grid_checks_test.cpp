// SPDX-License-Identifier: GPL-3.0-or-later
// Laws over grids of valid machines: correct grids are accepted, and each mistake that the reader
// checks is recognised, for any machine, any points and any usual noise.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "grid/files/grid_file.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kInchMm = 25.4;

/// Random numbers that are identical everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : bits_(seed) {}
  double between(double least, double most) {
    constexpr double kUnit = 0x1p-53;
    return least + (most - least) * static_cast<double>(bits_() >> 11U) * kUnit;
  }
  int whole(int least, int most) {
    return static_cast<int>(std::floor(between(least, most + 1.0)));
  }

 private:
  std::mt19937_64 bits_;
};

model::Machine some_machine(Dice& dice) {
  model::Machine machine;
  const double half_spacing = dice.between(1300.0, 1850.0);
  const double height = dice.between(900.0, 1150.0);
  const double rise = dice.between(-20.0, 20.0);
  machine.motors = {{-half_spacing, height - rise}, {half_spacing, height + rise}};
  machine.feed = dice.whole(0, 1) == 0 ? model::Feed::over_top : model::Feed::off_bottom;
  machine.attachment = model::Ring{dice.between(60.0, 160.0)};
  machine.sled.mass_kg = dice.between(8.0, 15.0);
  return machine;
}

/// A simulated grid of this machine: marks missed by up to 8 mm, lengths to 0.5 mm.
MeasuredGrid some_grid(const model::Machine& machine, Dice& dice) {
  MeasuredGrid grid;
  const auto kinematics =
      model::make_kinematics(model::equilibrium_parameters(machine), model::Model::elastic);
  const int columns = dice.whole(3, 8);
  const int rows = dice.whole(3, 6);
  const double half_width = dice.between(200.0, 1150.0);
  const double half_height = dice.between(150.0, 550.0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      MeasuredPoint point;
      point.mark = {half_width * (2.0 * column / (columns - 1) - 1.0) + dice.between(-8.0, 8.0),
                    half_height * (2.0 * row / (rows - 1) - 1.0) + dice.between(-8.0, 8.0)};
      const auto pose = kinematics->inverse(model::identity_placement(point.mark));
      if (!pose) continue;
      point.lengths = {pose->lengths.left_mm + dice.between(-0.5, 0.5),
                       pose->lengths.right_mm + dice.between(-0.5, 0.5)};
      grid.points.push_back(point);
    }
  }
  return grid;
}

/// The messages of the problems, or of the warnings if there is no problem.
std::vector<std::string> said_of(const MeasuredGrid& grid, const GridOptions& options = {}) {
  std::vector<std::string> messages;
  try {
    for (const Warning& warning : parse_grid(write_grid(grid), "grid.json", options).warnings) {
      messages.push_back(warning.message());
    }
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) messages.push_back(problem.message());
  }
  return messages;
}

class GridOfAnyMachine : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    Dice dice(static_cast<std::uint64_t>(GetParam()));
    machine_ = some_machine(dice);
    grid_ = some_grid(machine_, dice);
    ASSERT_GE(grid_.points.size(), 8U);
  }
  model::Machine machine_;
  MeasuredGrid grid_;
};

TEST_P(GridOfAnyMachine, IsAcceptedWithoutAWord) {
  EXPECT_THAT(said_of(grid_), IsEmpty());
  grid_.machine = machine_;
  EXPECT_THAT(said_of(grid_), IsEmpty());
}

TEST_P(GridOfAnyMachine, WithColumnsSwappedIsRecognised) {
  for (MeasuredPoint& point : grid_.points)
    std::swap(point.lengths->left_mm, point.lengths->right_mm);
  EXPECT_THAT(said_of(grid_),
              ElementsAre(HasSubstr("the columns left_mm and right_mm look swapped")));
  grid_.machine = machine_;
  EXPECT_THAT(said_of(grid_),
              ElementsAre(HasSubstr("the columns left_mm and right_mm look swapped")));
}

TEST_P(GridOfAnyMachine, WithMarksInInchesIsRecognised) {
  for (MeasuredPoint& point : grid_.points)
    point.mark = {point.mark.x_mm / kInchMm, point.mark.y_mm / kInchMm};
  EXPECT_THAT(said_of(grid_),
              ElementsAre(HasSubstr("x_mm and y_mm look like inches, the lengths like mm")));
}

TEST_P(GridOfAnyMachine, WithLengthsInInchesIsRecognised) {
  for (MeasuredPoint& point : grid_.points) {
    point.lengths = {point.lengths->left_mm / kInchMm, point.lengths->right_mm / kInchMm};
  }
  EXPECT_THAT(said_of(grid_), ElementsAre(HasSubstr("look like inches")));
}

TEST_P(GridOfAnyMachine, AllInInchesIsRecognised) {
  for (MeasuredPoint& point : grid_.points) {
    point.mark = {point.mark.x_mm / kInchMm, point.mark.y_mm / kInchMm};
    point.lengths = {point.lengths->left_mm / kInchMm, point.lengths->right_mm / kInchMm};
  }
  EXPECT_THAT(said_of(grid_), ElementsAre(HasSubstr("These look like inches: multiply all of them by 25.4")));
}

TEST_P(GridOfAnyMachine, WithYDownwardsIsRecognised) {
  for (MeasuredPoint& point : grid_.points) point.mark.y_mm = -point.mark.y_mm;
  EXPECT_THAT(said_of(grid_), ElementsAre(HasSubstr("y_mm looks counted downwards")));
}

TEST_P(GridOfAnyMachine, WithAMiscountedLinkInARepeatIsNamed) {
  // With the machine the predicted difference between the two is known; a link is 6.35 mm, the
  // noise allows 2 mm and a percent of the difference.
  grid_.machine = machine_;
  MeasuredPoint again = grid_.points[3];
  const auto kinematics =
      model::make_kinematics(model::equilibrium_parameters(machine_), model::Model::elastic);
  again.mark.x_mm += 9.0;
  again.mark.y_mm -= 7.0;
  const auto pose = kinematics->inverse(model::identity_placement(again.mark));
  ASSERT_TRUE(pose.has_value());
  again.lengths = pose->lengths;
  grid_.points.push_back(again);
  EXPECT_THAT(said_of(grid_), IsEmpty());
  grid_.points.back().lengths->right_mm += 6.35;
  EXPECT_THAT(said_of(grid_),
              ElementsAre(::testing::AllOf(HasSubstr("measured twice, also at /points/3"),
                                           HasSubstr("(right)"))));
}

TEST_P(GridOfAnyMachine, AHandfulIsEnoughForACheckAndStillKnowsItsSides) {
  const GridOptions few{machine_, {}, 1};
  grid_.points.resize(2);
  EXPECT_THAT(said_of(grid_, few), IsEmpty());
  EXPECT_THAT(said_of(grid_), ElementsAre(HasSubstr("Only 2 points are filled in, and it takes at least 8: measure 6 more.")));
  // The point farthest from the middle distinguishes its sides.
  grid_.points.resize(1);
  if (std::abs(grid_.points[0].mark.x_mm) < 150.0) return;
  std::swap(grid_.points[0].lengths->left_mm, grid_.points[0].lengths->right_mm);
  EXPECT_THAT(said_of(grid_, few),
              ElementsAre(HasSubstr("the columns left_mm and right_mm look swapped")));
}

INSTANTIATE_TEST_SUITE_P(Seeds, GridOfAnyMachine, ::testing::Range(1, 6));

TEST(GridFile, CommandsAndMarksInInchesAreSuspected) {
  for (const double height : {23.5, 20.0}) {
    MeasuredGrid grid;
    grid.machine = model::Machine{};
    for (int i = 0; i < 15; ++i) {
      const model::MarkPoint mark{-47.0 + 23.5 * (i % 5), -height + height * (i / 5)};
      grid.points.push_back({mark, {}, model::BedPoint{mark.x_mm + 0.5, mark.y_mm + 0.25}, {}});
    }
    EXPECT_THAT(said_of(grid), ElementsAre(HasSubstr("are they in inches?"))) << height;
  }
}

TEST(GridFile, TheMachineGivenReplacesTheGridsOwn) {
  Dice dice(7);
  MeasuredGrid grid = some_grid(model::Machine{}, dice);
  grid.machine = model::Machine{};
  model::Machine other;
  other.name = "the other one";
  const GridOptions options{other, StatedNoise{0.1, 0.15, 30.0}, 8};
  const ReadGrid read = parse_grid(write_grid(grid), "grid.json", options);
  EXPECT_EQ(read.grid.machine->name, "the other one");
  EXPECT_EQ(read.grid.noise->length_mm, 0.1);
  EXPECT_EQ(read.grid.noise->dof, 30.0);
}

TEST(GridFile, AMachineFileIsLookedForBesideTheGrid) {
  const std::string good = std::string(CHAINTRUE_FIXTURES) + "/good/";
  EXPECT_EQ(read_grid(good + "grid_with_machine_file.json").grid.machine->name, "every key");
  // Not needed, so not read, if another is given.
  const std::string text = R"({"file_type": "chaintrue_grid", "format_version": "1.0", )"
                           R"("machine_file": "none.json", "points": []})";
  const GridOptions options{model::Machine{}, {}, 0};
  EXPECT_EQ(parse_grid(text, good + "x.json", options).grid.machine->name, "classic Maslow");
}

std::string rows_of(const std::string& row, int count) {
  std::string text = "x_mm,y_mm,left_mm,right_mm\n";
  for (int i = 0; i < 12; ++i)
    text +=
        fmt::format("{},{},{},{}\n", 100 * (i % 4), 100 * (i / 4), 1500 + 60 * i, 1900 - 30 * i);
  for (int i = 0; i < count; ++i) text += row + "\n";
  return text;
}

TEST(GridFile, ARowThatWasCopiedCountsOnce) {
  GridOptions options;
  options.fewest_points = 3;
  const ReadGrid once = parse_grid(rows_of("50,50,1511.23,1902.41", 1), "g.csv", options);
  const ReadGrid often = parse_grid(rows_of("50,50,1511.23,1902.41", 2000), "g.csv", options);
  EXPECT_EQ(write_grid(often.grid), write_grid(once.grid));
  EXPECT_THAT(once.warnings, ::testing::IsEmpty());
  ASSERT_EQ(often.warnings.size(), 1U);
  EXPECT_THAT(often.warnings.front().message(),
              HasSubstr("1999 of 2012 points are copies of others, to the last digit of both "
                        "lengths, and count once (line 15, column 1 is line 14, column 1)"));
}

TEST(GridFile, ASecondVisitThatReadsTheSameIsAVisit) {
  GridOptions options;
  options.fewest_points = 3;
  // Two visits read to half a millimetre may agree.
  EXPECT_EQ(parse_grid(rows_of("50,50,1511.5,1902", 2), "g.csv", options).grid.points.size(), 14U);
  std::string numbered = "order,x_mm,y_mm,left_mm,right_mm\n";
  for (int i = 0; i < 12; ++i)
    numbered += fmt::format(
        "{},{},{},{},{}\n", i, 100 * (i % 4), 100 * (i / 4), 1500.25 + 60 * i, 1900 - 30 * i);
  numbered += "12,0,0,1500.25,1900\n";
  EXPECT_EQ(parse_grid(numbered, "g.csv", options).grid.points.size(), 13U);
}

TEST(GridFile, AThousandRepeatsThatDisagreeAreNotAThousandLines) {
  MeasuredGrid grid;
  for (int i = 0; i < 300; ++i) {
    const double x = 10.0 * (i % 20);
    const double y = 10.0 * (i / 20);
    grid.points.push_back(
        {{x, y},
         model::ChainLengths{1700 + 0.8 * x - 0.5 * y + (i % 2) * 60.0, 1700 - 0.8 * x - 0.5 * y},
         {},
         {}});
  }
  const auto said = said_of(grid);
  ASSERT_EQ(said.size(), 21U);
  EXPECT_THAT(said.back(), HasSubstr("more points disagree with their repeats"));
}

}  // namespace
}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
// Laws over grids of valid machines: correct grids are accepted, and each mistake that the reader
// checks is recognised, for any machine, any points and any usual noise.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/files/grid_file.hpp"
#include "model/kinematics.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kInchMm = 25.4;

int whole(testing_support::Random& random, int least, int most) {
  return static_cast<int>(std::floor(random.uniform(least, most + 1.0)));
}

model::Machine some_machine(testing_support::Random& random) {
  model::Machine machine;
  const double half_spacing = random.uniform(1300.0, 1850.0);
  const double height = random.uniform(900.0, 1150.0);
  const double rise = random.uniform(-20.0, 20.0);
  machine.motors = {{-half_spacing, height - rise}, {half_spacing, height + rise}};
  machine.feed = whole(random, 0, 1) == 0 ? model::Feed::over_top : model::Feed::off_bottom;
  machine.attachment = model::Ring{random.uniform(60.0, 160.0)};
  machine.sled.mass_kg = random.uniform(8.0, 15.0);
  return machine;
}

/// A simulated grid of this machine: marks missed by up to 8 mm, lengths to 0.5 mm.
MeasuredGrid some_grid(const model::Machine& machine, testing_support::Random& random) {
  MeasuredGrid grid;
  const auto kinematics =
      model::make_kinematics(model::equilibrium_parameters(machine), model::Model::elastic);
  const int columns = whole(random, 3, 8);
  const int rows = whole(random, 3, 6);
  const double half_width = random.uniform(200.0, 1150.0);
  const double half_height = random.uniform(150.0, 550.0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      MeasuredPoint point;
      point.mark = {half_width * (2.0 * column / (columns - 1) - 1.0) + random.uniform(-8.0, 8.0),
                    half_height * (2.0 * row / (rows - 1) - 1.0) + random.uniform(-8.0, 8.0)};
      const auto pose = kinematics->inverse(model::identity_placement(point.mark));
      if (!pose) continue;
      point.lengths = {pose->lengths.left_mm + random.uniform(-0.5, 0.5),
                       pose->lengths.right_mm + random.uniform(-0.5, 0.5)};
      grid.points.push_back(point);
    }
  }
  return grid;
}

/// The names of the problems; of warnings if there is no problem, and the place of one without a name.
std::vector<std::string> said_of(const MeasuredGrid& grid, const MeasuredOptions& options = {}) {
  std::vector<std::string> names;
  try {
    for (const Warning& warning : parse_grid(write_grid(grid), "grid.json", options).warnings)
      names.emplace_back(warning.kind != ProblemKind::unexpected ? warning.name()
                                                                 : std::string_view(warning.place));
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) names.emplace_back(problem.name());
  }
  return names;
}

class GridOfAnyMachine : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    testing_support::Random random(static_cast<std::uint64_t>(GetParam()));
    machine_ = some_machine(random);
    grid_ = some_grid(machine_, random);
    ASSERT_GE(grid_.points.size(), 8U);
  }
  model::Machine machine_;
  MeasuredGrid grid_;
};

TEST_P(GridOfAnyMachine, IsAcceptedWithoutMessages) {
  EXPECT_THAT(said_of(grid_), IsEmpty());
  grid_.machine = machine_;
  EXPECT_THAT(said_of(grid_), IsEmpty());
}

TEST_P(GridOfAnyMachine, WithColumnsSwappedIsRecognised) {
  for (MeasuredPoint& point : grid_.points)
    std::swap(point.lengths->left_mm, point.lengths->right_mm);
  EXPECT_THAT(said_of(grid_), ElementsAre("sides_swapped"));
  grid_.machine = machine_;
  EXPECT_THAT(said_of(grid_), ElementsAre("sides_swapped"));
}

TEST_P(GridOfAnyMachine, InInchesIsRecognised) {
  // Marks, then the lengths as well, then the lengths alone.
  for (MeasuredPoint& point : grid_.points)
    point.mark = {point.mark.x_mm / kInchMm, point.mark.y_mm / kInchMm};
  EXPECT_THAT(said_of(grid_), ElementsAre("other_unit"));
  for (MeasuredPoint& point : grid_.points)
    point.lengths = {point.lengths->left_mm / kInchMm, point.lengths->right_mm / kInchMm};
  EXPECT_THAT(said_of(grid_), ElementsAre("other_unit"));
  for (MeasuredPoint& point : grid_.points)
    point.mark = {point.mark.x_mm * kInchMm, point.mark.y_mm * kInchMm};
  EXPECT_THAT(said_of(grid_), ElementsAre("other_unit"));
}

TEST_P(GridOfAnyMachine, WithYDownwardsIsRecognised) {
  for (MeasuredPoint& point : grid_.points) point.mark.y_mm = -point.mark.y_mm;
  EXPECT_THAT(said_of(grid_), ElementsAre("axes"));
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
  EXPECT_THAT(said_of(grid_), ElementsAre(::testing::StartsWith("/points/")));
}

TEST_P(GridOfAnyMachine, AHandfulIsEnoughForACheckAndStillKnowsItsSides) {
  const MeasuredOptions few{.machine = machine_, .few = true};
  grid_.points.resize(2);
  EXPECT_THAT(said_of(grid_, few), IsEmpty());
  EXPECT_THAT(said_of(grid_), ElementsAre("too_few"));
  // The point farthest from the middle distinguishes its sides.
  grid_.points.resize(1);
  if (std::abs(grid_.points[0].mark.x_mm) < 150.0) return;
  std::swap(grid_.points[0].lengths->left_mm, grid_.points[0].lengths->right_mm);
  EXPECT_THAT(said_of(grid_, few), ElementsAre("sides_swapped"));
}

INSTANTIATE_TEST_SUITE_P(Seeds, GridOfAnyMachine, ::testing::Range(1, 6));

}  // namespace
}  // namespace chaintrue::grid::files

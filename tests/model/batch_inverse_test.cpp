// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/batch_inverse.hpp"

#include <gmock/gmock.h>

#include <random>
#include <vector>

#include "tests/model/reference_tables.hpp"

namespace chaintrue::model {
namespace {

TEST(BatchInverse, AgreesWithTheReferenceTables) {
  for (const char* name :
       {"table_over_top.json", "table_off_bottom.json", "table_over_top_rho0.json"}) {
    const nlohmann::json table = reference_table(name);
    const BatchInverse batch(parameters_of(table["params"]));
    std::vector<BedPoint> points;
    for (const auto& r : table["bed"]) points.push_back(point_of(r));
    std::vector<BatchInverse::Result> results(points.size());
    batch.lengths(points, results);
    for (std::size_t i = 0; i < points.size(); ++i) {
      SCOPED_TRACE(testing::Message()
                   << name << " at (" << points[i].x_mm << ", " << points[i].y_mm << ")");
      ASSERT_TRUE(results[i]);
      EXPECT_NEAR(results[i]->left_mm,
                  number(table["bed"][i]["d_elastic"][0]),
                  1e-10);  // the scalar's figure
      EXPECT_NEAR(results[i]->right_mm, number(table["bed"][i]["d_elastic"][1]), 1e-10);
    }
  }
}

// Beyond the bed too: what the block does not settle, the scalar answers, failures included.
TEST(BatchInverse, GivesTheScalarsAnswersEverywhere) {
  constexpr std::uint64_t kSeed = 77;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937_64 engine(kSeed);
  const auto uniform = [&engine](double from, double to) {
    return from + (to - from) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  };
  for (const double mass_kg : {11.6, 0.6}) {
    for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
      Machine machine;
      machine.sled.mass_kg = mass_kg;
      machine.feed = feed;
      EquilibriumParameters parameters = equilibrium_parameters(machine);
      parameters.motors.right.y_mm += 30.0;
      parameters.side_force_n = 0.02 * parameters.sled_weight_n;
      parameters.beam_flexibility_mm_per_n = 0.005;
      const auto scalar = make_kinematics(parameters);
      const BatchInverse batch(parameters);
      std::vector<BedPoint> points(1001);  // no multiple of the block
      for (BedPoint& p : points) p = {uniform(-1600.0, 1600.0), uniform(-2500.0, 1200.0)};
      std::vector<BatchInverse::Result> results(points.size());
      batch.lengths(points, results);
      int poses = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const PoseResult pose = scalar->inverse(points[i]);
        SCOPED_TRACE(testing::Message()
                     << "at (" << points[i].x_mm << ", " << points[i].y_mm << ")");
        ASSERT_EQ(pose.has_value(), results[i].has_value());
        if (!pose) {
          EXPECT_EQ(pose.error(), results[i].error());
          continue;
        }
        ++poses;
        EXPECT_NEAR(results[i]->left_mm, pose->lengths.left_mm, 2e-11);  // promised in the header
        EXPECT_NEAR(results[i]->right_mm, pose->lengths.right_mm, 2e-11);
      }
      EXPECT_GT(poses, 700);
    }
  }
}

TEST(BatchInverse, RefusesBracketsAndSpansThatDiffer) {
  Machine machine;
  const BatchInverse batch(equilibrium_parameters(machine));
  std::vector<BedPoint> points(3);
  std::vector<BatchInverse::Result> results(2);
  EXPECT_THROW(batch.lengths(points, results), std::invalid_argument);
  machine.attachment = Brackets{};
  EXPECT_THROW(BatchInverse(equilibrium_parameters(machine)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
/// A mechanism that no product code knows is compensated like any other: its controller has wrong
/// positions of the nails; the output keeps to the path on the calibrated machine, the original
/// program does not.
#include <gtest/gtest.h>

#include "grid/map/mechanism_map.hpp"
#include "tests/contracts/toy_mechanism.hpp"
#include "tests/gcode/compensated_program.hpp"

namespace chaintrue::gcode {
namespace {

/// A controller that pays out what a mechanism says.
class Believes final : public model::ControllerKinematics {
 public:
  explicit Believes(model::ToyMechanism mechanism) : mechanism_(std::move(mechanism)) {}
  [[nodiscard]] tl::expected<model::ChainLengths, model::PoseFailure> lengths(
      model::BedPoint command) const override {
    const auto found = mechanism_.first_lengths({command.x_mm, command.y_mm});
    if (!found) return tl::unexpected(model::PoseReason::above_sprockets);
    return *found;
  }
  [[nodiscard]] tl::expected<model::BedPoint, model::PoseFailure> command(
      model::ChainLengths lengths) const override {
    const auto found = mechanism_.locate_by_first(lengths);
    if (!found) return tl::unexpected(model::PoseReason::not_converged);
    return model::BedPoint{found->x_mm, found->y_mm};
  }

 private:
  model::ToyMechanism mechanism_;
};

TEST(MechanismPath, CompensatesAndVerifiesAStraightPathOfAnUnknownMechanism) {
  const grid::FittedMechanism fitted{std::make_shared<const model::ToyMechanism>(-1003.0, 1206.0),
                                     0.01 * Eigen::Matrix3d::Identity(), 0.3, 60.0};
  const auto map =
      grid::MechanismMap::of(fitted, {{-500.0, -1400.0}, {500.0, -1400.0}, {0.0, -600.0}});
  const Believes controller(model::ToyMechanism(-1000.0, 1200.0));
  const Corrector corrector(map, controller, firmware(model::ControllerKind::ideal));
  const std::string program = "G21 G90\nG0 X-300 Y-1000\nG1 X280 Y-1150 F1000\nM2\n";
  const auto output = compensate(program, corrector);
  ASSERT_TRUE(output) << output.error().message();
  EXPECT_TRUE(output->findings.problems.empty());
  // Nails that are 3 and 6 mm off move the tool by about as much.
  EXPECT_GT(output->summary.largest_correction_mm, 1.0);
  EXPECT_TRUE(verified(program, output->text, corrector).holds()) << output->text;
  EXPECT_FALSE(verified(program, program, corrector).holds());
  const auto far = compensate("G21 G90\nG0 X-300 Y-1000\nG1 X2000 Y-1000 F1000\nM2\n", corrector);
  ASSERT_TRUE(far);
  EXPECT_FALSE(far->findings.problems.empty());
}

}  // namespace
}  // namespace chaintrue::gcode

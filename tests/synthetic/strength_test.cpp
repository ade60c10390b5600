// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/strength.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/synthetic/effect_picture.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::Machine;
using model::effects::EffectSide;
using model::effects::find_effect;

StatedNoise noise_of(double length_mm, double position_mm) {
  StatedNoise noise;
  noise.length_mm = length_mm;
  noise.position_mm = position_mm;
  return noise;
}

TEST(Signature, OfPaperEffectsEqualsTheMapsShift) {
  const Machine machine;
  const std::vector<model::Visit> visits = regular_session(machine, 5, 4);
  const auto shift =
      signature(machine, {{"tape_scale", "both", {{"scale", 0.001}}}}, visits).tool_shift_mm();
  for (std::size_t i = 0; i < visits.size(); ++i) {
    // Marks are written a thousandth further out. The tool sent to a written position by a map of
    // them goes to the mark, which is nearer to the middle; first order in 1.2 mm is accurate to
    // 1e-12 because paper and lengths are independent.
    EXPECT_NEAR(shift[i].x(), 0.001 * visits[i].position.x_mm, 1e-9);
    EXPECT_NEAR(shift[i].y(), 0.001 * visits[i].position.y_mm, 1e-9);
  }
}

TEST(Signature, OfMachineEffectsEqualsTheToolsShift) {
  const Machine machine;
  const std::vector<model::Visit> visits = regular_session(machine, 5, 4);
  const model::AppliedEffect stretch{"chain_stretch", "", {{"compliance_per_n", 1e-7}}};
  const auto shift = signature(machine, {stretch}, visits).tool_shift_mm();
  Machine stretching = machine;
  stretching.effects = {stretch};
  const model::ReadingModel stated(machine), real(stretching);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const auto paid_out = stated.at(visits[i].position);
    const auto tool = real.find(paid_out->lengths, visits[i].position);
    ASSERT_TRUE(tool);
    // Second order: 0.08 mm times a relative change of the Jacobian of 0.08 / 500.
    EXPECT_NEAR(shift[i].x(), tool->pose.position.x_mm - visits[i].position.x_mm, 5e-5);
    EXPECT_NEAR(shift[i].y(), tool->pose.position.y_mm - visits[i].position.y_mm, 5e-5);
  }
}

// More points, less noise, larger effects: delta changes accordingly.
TEST(Strength, FollowsNoiseAndPoints) {
  const Machine machine;
  const auto& kink = *find_effect("angular_kink");
  const auto session = regular_session(machine, 7, 4);
  const StrengthTable table(machine, session, noise_of(0.2, 0.3));
  const EffectStrength s = table.strength(kink, EffectSide::left);
  // 4.5 mm/rad is the usual size.
  EXPECT_NEAR(s.detectable_size * s.signal_to_noise / 4.5, kDetectableSignalToNoise,
              1e-9);  // rounding
  EXPECT_GT(s.share_left, 0.0);
  EXPECT_LE(s.share_left, 1.0);
  const StrengthTable twice(machine, session, noise_of(0.4, 0.6));
  // The settings' stated sigmas do not double, so that more than half of it remains.
  EXPECT_GT(twice.strength(kink, EffectSide::left).signal_to_noise, 0.5 * s.signal_to_noise);
  EXPECT_LT(twice.strength(kink, EffectSide::left).signal_to_noise, s.signal_to_noise);
  std::vector<model::Visit> repeated = session;
  for (const model::Visit& visit : session) {
    repeated.push_back({visit.position, visit.order + static_cast<int>(session.size())});
  }
  const StrengthTable more(machine, repeated, noise_of(0.2, 0.3));
  // Every point twice: at most sqrt 2, as the settings are known better too.
  EXPECT_GT(more.strength(kink, EffectSide::left).signal_to_noise, s.signal_to_noise);
  EXPECT_LE(more.strength(kink, EffectSide::left).signal_to_noise,
            std::sqrt(2.0) * s.signal_to_noise * (1.0 + 1e-12));
}

TEST(Strength, MirroredEffectsAreEquallyStrong) {
  const Machine machine;
  const StrengthTable table(machine, regular_session(machine, 7, 4), noise_of(0.2, 0.3));
  const auto& pitch = *find_effect("chain_pitch_error");
  EXPECT_NEAR(table.strength(pitch, EffectSide::left).signal_to_noise,
              table.strength(pitch, EffectSide::right).signal_to_noise, 1e-6);
}

// effects.md: chain_pitch_error of both chains equals tape_scale of both axes if the motors'
// positions have not been taped.
TEST(Strength, FindsTheClassOfPitchAndTape) {
  Machine machine;
  machine.uncertainty = {1000.0, 1000.0, 1.0};
  const StrengthTable table(machine, regular_session(machine, 10, 6), noise_of(0.2, 0.3));
  const EffectStrength s = table.strength(*find_effect("chain_pitch_error"), EffectSide::both);
  ASSERT_EQ(s.inseparable.size(), 1U);
  EXPECT_EQ(s.inseparable.front().effect->id, "tape_scale");
  EXPECT_EQ(s.inseparable.front().side, EffectSide::both);
}

TEST(Strength, TheSprocketsRadiusIsNeverNamed) {
  const Machine machine;
  const EffectPicture picture = picture_effect(machine, *find_effect("sprocket_radius"),
                                               EffectSide::none, {0.17}, noise_of(0.2, 0.3));
  ASSERT_EQ(picture.strengths.size(), 3U);
  EXPECT_EQ(picture.strengths[0].columns * picture.strengths[0].rows, 28);
  EXPECT_EQ(picture.strengths[1].columns * picture.strengths[1].rows, 60);
  EXPECT_EQ(picture.strengths[2].columns * picture.strengths[2].rows, 200);
  for (const StrengthAt& at : picture.strengths) EXPECT_FALSE(at.strength.named_size.has_value());
}

TEST(EffectPicture, SkewedPaperShearsTheSquare) {
  const EffectPicture picture = picture_effect(Machine{}, *find_effect("axes_skew"),
                                               EffectSide::none, {0.01}, noise_of(0.2, 0.3));
  const ShiftedSquare& square = picture.squares.front();
  // x shifts by y g: sides sqrt(100^2 + 1), diagonals of the sheared square; marks move by first
  // order exactly.
  EXPECT_NEAR(square.side_mm[0], 100.0, 1e-9);
  EXPECT_NEAR(square.side_mm[1], std::hypot(100.0, 1.0), 1e-9);
  EXPECT_NEAR(square.diagonal_mm[0], std::hypot(101.0, 100.0), 1e-9);
  EXPECT_NEAR(square.diagonal_mm[1], std::hypot(99.0, 100.0), 1e-9);
}

}  // namespace
}  // namespace chaintrue::grid::synthetic

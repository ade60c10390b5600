// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Each equation of the catalogue, recomputed here from the equilibrium; their order; the rules of
/// hysteresis.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model {
namespace {

using ::testing::ElementsAre;

// Sums of a few numbers of 3000 mm, done in another order: some units of 4.5e-13.
constexpr double kRoundingMm = 5e-12;

const std::vector<BedPoint> kPlaces = {{-1219.2, -609.6}, {1219.2, -609.6}, {0.0, 0.0},
                                       {-1219.2, 609.6},  {310.0, -45.0},   {1219.2, 609.6},
                                       {-250.0, 500.0},   {310.0, -45.0}};

std::vector<Visit> visits_of(const std::vector<BedPoint>& places) {
  std::vector<Visit> visits;
  for (const BedPoint& p : places) visits.push_back({p, static_cast<int>(visits.size())});
  return visits;
}

Machine machine_with(const std::vector<AppliedEffect>& effects) {
  Machine machine;
  machine.effects = effects;
  return machine;
}

std::vector<ChainLengths> read(const Machine& machine, const std::vector<Visit>& visits) {
  const auto lengths = readings(ReadingModel(machine), visits);
  EXPECT_TRUE(lengths.has_value());
  return lengths.value_or(std::vector<ChainLengths>(visits.size()));
}

Pose pose_at(const EquilibriumParameters& parameters, BedPoint p) {
  const auto pose = make_kinematics(parameters)->inverse(p);
  EXPECT_TRUE(pose.has_value());
  return pose.value_or(Pose{});
}

TEST(MarkFrame, ScalesAndSkewsMarks) {
  for (const auto& [effect, x_mm, y_mm] :
       {std::tuple(AppliedEffect{"tape_scale", "x", {{"scale", 0.001}}}, 1001.0, 500.0),
        {AppliedEffect{"tape_scale", "y", {{"scale", -0.001}}}, 1000.0, 499.5},
        {AppliedEffect{"axes_skew", "", {{"angle_rad", 0.002}}}, 1001.0, 500.0}}) {
    SCOPED_TRACE(effect.effect + effect.side);
    const MarkPoint written = MarkFrame(machine_with({effect})).written({1000.0, 500.0});
    EXPECT_NEAR(written.x_mm, x_mm, kRoundingMm);
    EXPECT_NEAR(written.y_mm, y_mm, kRoundingMm);
  }
}

TEST(MarkFrame, ScalesBeforeItSkews) {
  const MarkFrame mark_frame(machine_with(
      {{"axes_skew", "", {{"angle_rad", 0.01}}}, {"tape_scale", "both", {{"scale", 0.02}}}}));
  const MarkPoint written = mark_frame.written({1000.0, 500.0});
  EXPECT_NEAR(written.x_mm, 1000.0 * 1.02 + 500.0 * 1.02 * 0.01, kRoundingMm);
  EXPECT_NEAR(written.y_mm, 500.0 * 1.02, kRoundingMm);
  const MarkPoint back = mark_frame.place(written);
  EXPECT_NEAR(back.x_mm, 1000.0, kRoundingMm);
  EXPECT_NEAR(back.y_mm, 500.0, kRoundingMm);
}

TEST(MachineEffects, AddToTheMachinesOwnNumbers) {
  const std::vector<AppliedEffect> all = {{"side_pull", "", {{"force_n", 2.5}}},
                                          {"ring_radius", "", {{"offset_mm", -1.5}}},
                                          {"beam_flex", "", {{"flexibility_mm_per_n", 0.008}}},
                                          {"chain_sag", "", {{"relative_weight", 0.25}}},
                                          {"sprocket_radius", "", {{"offset_mm", 0.17}}},
                                          {"chain_stretch", "", {{"compliance_per_n", 3e-6}}}};
  const Machine machine = machine_with(all);
  EquilibriumParameters expected = equilibrium_parameters(Machine{});
  expected.attachment = Ring{139.1 - 1.5};
  expected.sprocket_radius_mm = 6.35 * 10 / (2.0 * std::numbers::pi) + 0.17;
  expected.chain_weight_n_per_mm *= 1.25;
  expected.chain_compliance_per_n = 5.17e-6 + 3e-6;
  expected.beam_flexibility_mm_per_n = 0.008;
  expected.side_force_n = 2.5;
  const auto lengths = read(machine, visits_of(kPlaces));
  for (std::size_t i = 0; i < kPlaces.size(); ++i) {
    const Pose pose = pose_at(expected, kPlaces[i]);
    EXPECT_NEAR(lengths[i].left_mm, pose.lengths.left_mm, kRoundingMm);
    EXPECT_NEAR(lengths[i].right_mm, pose.lengths.right_mm, kRoundingMm);
  }
}

TEST(SidePull, TakesItsForceFromTheBalanceOfTheSled) {
  const ReadingModel model(machine_with({{"side_pull", "", {{"force_n", 4.0}}}}));
  const auto reading = model.at({200.0, 100.0});
  ASSERT_TRUE(reading);
  // Forces are some 100 N: rounding.
  EXPECT_NEAR(reading->pose.chains.left.horizontal_n - reading->pose.chains.right.horizontal_n, 4.0,
              1e-12);
}

// A yielding beam equals the rigid machine with its motors moved along the chains' pulls.
TEST(BeamFlex, EqualsARigidMachineWithItsMotorsPulledIn) {
  constexpr double k = 0.01;
  const ReadingModel flexing(machine_with({{"beam_flex", "", {{"flexibility_mm_per_n", k}}}}));
  for (const BedPoint p : kPlaces) {
    const auto reading = flexing.at(p);
    ASSERT_TRUE(reading);
    EquilibriumParameters moved = equilibrium_parameters(Machine{});
    const ChainState& l = reading->pose.chains.left;
    const ChainState& r = reading->pose.chains.right;
    moved.motors.left.x_mm += k * l.tension_at_sprocket_n * std::cos(l.angle_rad);
    moved.motors.left.y_mm -= k * l.tension_at_sprocket_n * std::sin(l.angle_rad);
    moved.motors.right.x_mm -= k * r.tension_at_sprocket_n * std::cos(r.angle_rad);
    moved.motors.right.y_mm -= k * r.tension_at_sprocket_n * std::sin(r.angle_rad);
    const Pose rigid = pose_at(moved, p);
    // Both equilibria are solved to 1e-10 mm.
    EXPECT_NEAR(reading->lengths.left_mm, rigid.lengths.left_mm, 1e-9);
    EXPECT_NEAR(reading->lengths.right_mm, rigid.lengths.right_mm, 1e-9);
  }
}

// (L0 + plane + eccentricity + kink + hysteresis) / (1 + e) + zero + drift + skip + miscount + shift, each
// term by hand.
TEST(ChainAndReading, AddInTheCataloguesOrderAndDivideLast) {
  Machine machine =
      machine_with({{"link_miscount", "left", {{"links", -1.0}, {"visit", 6.0}}},
                    {"chain_pitch_error", "both", {{"elongation", 0.0012}}},
                    {"chain_pitch_error", "right", {{"elongation", -0.0004}}},
                    {"tooth_skip", "right", {{"links", 2.0}, {"first_visit", 4.0}}},
                    {"zero_shift", "left", {{"shift_mm", -1.7}, {"first_visit", 5.0}}},
                    {"direction_hysteresis", "both", {{"half_width_mm", 0.3}}},
                    {"drift", "right", {{"rate_mm_per_visit", -0.02}}},
                    {"angular_kink", "left", {{"slope_mm_per_rad", 4.0}, {"knee_rad", 0.7}}},
                    {"sprocket_eccentricity", "right", {{"amplitude_mm", 0.4}, {"phase_rad", 0.8}}},
                    {"chain_plane_offset", "", {{"distance_mm", 35.0}}},
                    {"chain_stretch", "", {{"compliance_per_n", 2e-6}}}});
  machine.chain_zero = {1.25, -0.75};
  EquilibriumParameters parameters = equilibrium_parameters(machine);
  parameters.chain_compliance_per_n += 2e-6;
  const std::vector<Visit> visits = visits_of(kPlaces);
  const auto lengths = read(machine, visits);
  double last_left = 0.0, last_right = 0.0, sign_left = 1.0, sign_right = 1.0;
  for (std::size_t n = 0; n < visits.size(); ++n) {
    const Pose pose = pose_at(parameters, visits[n].position);
    const auto plane = [](double s) { return std::sqrt(s * s + 35.0 * 35.0) - s; };
    double left = pose.lengths.left_mm + plane(pose.chains.left.free_length_mm);
    double right = pose.lengths.right_mm + plane(pose.chains.right.free_length_mm);
    right += 0.4 * std::sin(2.0 * std::numbers::pi * pose.lengths.right_mm / 63.5 + 0.8);
    left += 4.0 * std::max(0.0, pose.chains.left.angle_rad - 0.7);
    if (n > 0 && left != last_left) sign_left = left > last_left ? 1.0 : -1.0;
    if (n > 0 && right != last_right) sign_right = right > last_right ? 1.0 : -1.0;
    last_left = left;
    last_right = right;
    left = (left + 0.3 * sign_left) / 1.0012 + 1.25;
    right = (right + 0.3 * sign_right) / 1.0008 - 0.75;
    right += -0.02 * static_cast<double>(n) + (n >= 4 ? 12.7 : 0.0);
    left += (n == 6 ? -6.35 : 0.0) + (n >= 5 ? -1.7 : 0.0);
    // sqrt(S^2 + z^2) - S loses 1e-12 relative to S here; the sine's argument of 300 rad rounds to
    // 6e-14 of 0.4 mm.
    EXPECT_NEAR(lengths[n].left_mm, left, 1e-11) << "visit " << n;
    EXPECT_NEAR(lengths[n].right_mm, right, 1e-11) << "visit " << n;
  }
}

TEST(Hysteresis, FirstVisitIsPaidOutAndNoChangeKeepsTheSign) {
  const Machine machine =
      machine_with({{"direction_hysteresis", "left", {{"half_width_mm", 0.5}}}});
  const BedPoint near_left{-800.0, 0.0}, far{800.0, 0.0};
  const std::vector<Visit> visits = visits_of({far, far, near_left, near_left, far});
  const auto with = read(machine, visits);
  const auto without = read(Machine{}, visits);
  std::vector<double> added;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    added.push_back(std::round((with[i].left_mm - without[i].left_mm) * 1e6) / 1e6);
    EXPECT_EQ(with[i].right_mm, without[i].right_mm);
  }
  EXPECT_THAT(added, ElementsAre(0.5, 0.5, -0.5, -0.5, 0.5));
}

TEST(Hysteresis, FollowsTheVisitNumberNotTheListOrder) {
  const Machine machine =
      machine_with({{"direction_hysteresis", "both", {{"half_width_mm", 0.5}}}});
  const std::vector<Visit> forward = {{{-500.0, 0.0}, 3}, {{0.0, 0.0}, 7}, {{500.0, 0.0}, 20}};
  const std::vector<Visit> listed_backwards = {forward[2], forward[1], forward[0]};
  const auto a = read(machine, forward);
  const auto b = read(machine, listed_backwards);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a[i].left_mm, b[2 - i].left_mm);
    EXPECT_EQ(a[i].right_mm, b[2 - i].right_mm);
  }
}

// A wave of the sprocket can reverse the direction of a small move: the direction is taken from the
// length after the wave.
TEST(Hysteresis, LooksAtTheLengthAfterTheSprocketsWave) {
  const std::vector<AppliedEffect> both = {
      {"direction_hysteresis", "left", {{"half_width_mm", 0.5}}},
      {"sprocket_eccentricity", "left", {{"amplitude_mm", 5.0}, {"phase_rad", 0.0}}}};
  const std::vector<AppliedEffect> wave = {both[1]};
  std::vector<BedPoint> places;
  for (int i = 0; i < 40; ++i) places.push_back({-300.0 + 5.0 * i, 0.0});
  // A wave of 5 mm over 63.5 mm changes the slope of 1 mm/mm only to 1 - 0.49 and never reverses
  // it; a third effect that takes chain back along the way reverses it together with the wave.
  std::vector<AppliedEffect> with = both, without = wave;
  const AppliedEffect kink{
      "angular_kink", "left", {{"slope_mm_per_rad", 60.0}, {"knee_rad", -1.5}}};
  with.push_back(kink);
  without.push_back(kink);
  const std::vector<Visit> visits = visits_of(places);
  const auto a = read(machine_with(with), visits);
  const auto b = read(machine_with(without), visits);
  double sign = 1.0;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    if (i > 0) sign = b[i].left_mm > b[i - 1].left_mm ? 1.0 : -1.0;
    EXPECT_NEAR(a[i].left_mm - b[i].left_mm, 0.5 * sign, kRoundingMm) << i;
  }
}

TEST(Readings, RefuseTwoVisitsOfOneNumber) {
  const ReadingModel model{Machine{}};
  EXPECT_THROW(
      static_cast<void>(readings(model, std::vector<Visit>{{{0.0, 0.0}, 1}, {{10.0, 0.0}, 1}})),
      std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/plotter/plotter_controller.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace chaintrue::model {
namespace {

/// The firmware's constants: from the left pin, x to the right, y down.
struct MuralBot {
  double pins_mm = 0.0;
  double d_t = 0.0;  ///< between the tangent points
  double d_p = 0.0;  ///< pen below their middle
  double d_m = 0.0;  ///< mass below their middle
  double weight_n = 0.0;
};

/// A leg of the bot: from a pin down to a tangent point, in the wall's plane.
struct Leg {
  ByCommand across_mm, down_mm;
  ByCommand angle() const { return atan2(down_mm, across_mm); }
};

struct MuralPose {
  Leg left, right;
  ByCommand force_left_n, force_right_n;
};

MuralPose pose_at(const MuralBot& bot, const ByCommand& x, const ByCommand& y,
                  const ByCommand& tilt) {
  const double half = 0.5 * bot.d_t;
  const ByCommand c = cos(tilt), s = sin(tilt);
  MuralPose pose;
  pose.left = {x - (half * c - bot.d_p * s), y - (half * s + bot.d_p * c)};
  pose.right = {bot.pins_mm - (x + half * c + bot.d_p * s), y + half * s - bot.d_p * c};
  const ByCommand l = pose.left.angle(), r = pose.right.angle();
  pose.force_left_n = bot.weight_n * cos(r) / sin(l + r);
  pose.force_right_n = bot.weight_n * cos(l) / sin(l + r);
  return pose;
}

/// The tilt at which the moments of a pose's forces are 0.
ByCommand level_tilt(const MuralBot& bot, const MuralPose& pose) {
  const double half = 0.5 * bot.d_t;
  const ByCommand l = pose.left.angle(), r = pose.right.angle();
  return atan2(
      half * (pose.force_left_n * sin(l) - pose.force_right_n * sin(r)),
      half * (pose.force_right_n * cos(r) + pose.force_left_n * cos(l)) + bot.d_m * bot.weight_n);
}

bool is_settled(const ByCommand& change) {
  constexpr double kConverged = 1e-14;
  return std::abs(change.value) <= kConverged && std::abs(change.d[0]) <= kConverged &&
         std::abs(change.d[1]) <= kConverged;
}

}  // namespace

tl::expected<PerSide<ByCommand>, PlotterFailure> mural_lengths(const PlotterMachine& as_set,
                                                               BedPoint command) {
  if (is_point(as_set.gondola)) throw std::invalid_argument("a mural whose gondola is a point");
  constexpr int kMostPasses = 200;
  const double q = as_set.pulley_radius_mm / std::numbers::sqrt2;
  const Gondola& g = as_set.gondola;
  const MuralBot bot{as_set.pin_spacing_mm, g.spacing_mm - 2.0 * q, g.pen_below_mm + q,
                     g.mass_below_mm + q, plotter::statics_of(as_set).weight_n};
  const ByCommand x = ByCommand::variable(command.x_mm, 0) + 0.5 * bot.pins_mm;
  const ByCommand y = -ByCommand::variable(command.y_mm, 1);
  ByCommand tilt = 0.0, change = 1.0;
  MuralPose pose = pose_at(bot, x, y, tilt);
  for (int pass = 0; pass < kMostPasses && !is_settled(change); ++pass) {
    change = level_tilt(bot, pose) - tilt;
    tilt = tilt + change;
    pose = pose_at(bot, x, y, tilt);
  }
  // Iterations that oscillate for ever do so only above any place where the bot can hang.
  if (!(std::abs(change.value) < 1e-9)) return tl::unexpected(PlotterReason::not_converged);
  const auto length = [&](const Leg& leg, const ByCommand& force_n) {
    return sqrt(leg.across_mm * leg.across_mm + leg.down_mm * leg.down_mm +
                g.standoff_mm * g.standoff_mm) /
           (1.0 + as_set.cord.compliance_per_n * force_n);
  };
  return PerSide<ByCommand>{length(pose.left, pose.force_left_n),
                            length(pose.right, pose.force_right_n)};
}

std::string_view name(PlotterFirmware firmware) {
  constexpr std::array<std::string_view, 4> kNames = {"fluidnc", "marlin", "polargraph", "mural"};
  return kNames.at(static_cast<std::size_t>(firmware));
}

tl::expected<ChainLengths, PlotterFailure> paid_out(PlotterFirmware firmware,
                                                    const PlotterMachine& as_set,
                                                    BedPoint command) {
  const double half = 0.5 * as_set.pin_spacing_mm;
  if (!(std::abs(command.x_mm) < half)) return tl::unexpected(PlotterReason::outside_the_pins);
  if (!(command.y_mm < -0.5 * std::abs(as_set.pin_rise_mm)))
    return tl::unexpected(PlotterReason::above_the_pins);
  const auto counted = [&](ChainLengths own) {
    for (const Side side : kSides)
      own[side] = own[side] * (1.0 + 1e-3 * as_set.scale_mm_per_m[side]) + as_set.zero_mm[side];
    return own;
  };
  if (firmware == PlotterFirmware::mural) {
    return mural_lengths(as_set, command).map([&](const PerSide<ByCommand>& own) {
      return counted({own.left.value, own.right.value});
    });
  }
  const double up = firmware == PlotterFirmware::fluidnc ? 0.5 * as_set.pin_rise_mm : 0.0;
  return counted({std::hypot(command.x_mm + half, command.y_mm + up),
                  std::hypot(command.x_mm - half, command.y_mm - up)});
}

}  // namespace chaintrue::model

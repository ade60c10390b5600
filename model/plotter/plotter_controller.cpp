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
  double across_mm = 0.0;
  double down_mm = 0.0;
  [[nodiscard]] double angle() const { return std::atan2(down_mm, across_mm); }
};

struct MuralPose {
  Leg left, right;
  double force_left_n = 0.0, force_right_n = 0.0;
};

MuralPose pose_at(const MuralBot& bot, double x, double y, double tilt) {
  const double half = 0.5 * bot.d_t;
  const double c = std::cos(tilt), s = std::sin(tilt);
  MuralPose pose;
  pose.left = {x - (half * c - bot.d_p * s), y - (half * s + bot.d_p * c)};
  pose.right = {bot.pins_mm - (x + half * c + bot.d_p * s), y + half * s - bot.d_p * c};
  const double l = pose.left.angle(), r = pose.right.angle();
  pose.force_left_n = bot.weight_n * std::cos(r) / std::sin(l + r);
  pose.force_right_n = bot.weight_n * std::cos(l) / std::sin(l + r);
  return pose;
}

/// The tilt at which the moments of a pose's forces are 0.
double level_tilt(const MuralBot& bot, const MuralPose& pose) {
  const double half = 0.5 * bot.d_t;
  const double l = pose.left.angle(), r = pose.right.angle();
  return std::atan2(half * (pose.force_left_n * std::sin(l) - pose.force_right_n * std::sin(r)),
                    half * (pose.force_right_n * std::cos(r) + pose.force_left_n * std::cos(l)) +
                        bot.d_m * bot.weight_n);
}

tl::expected<ChainLengths, PlotterFailure> mural_lengths(const PlotterMachine& as_set,
                                                         BedPoint command) {
  if (is_point(as_set.gondola)) throw std::invalid_argument("a mural whose gondola is a point");
  constexpr int kMostPasses = 200;
  constexpr double kConvergedRad = 1e-14;
  const double q = as_set.pulley_radius_mm / std::numbers::sqrt2;
  const Gondola& g = as_set.gondola;
  const MuralBot bot{as_set.pin_spacing_mm,
                     g.spacing_mm - 2.0 * q,
                     g.pen_below_mm + q,
                     g.mass_below_mm + q,
                     plotter::statics_of(as_set).weight_n};
  const double x = command.x_mm + 0.5 * bot.pins_mm, y = -command.y_mm;
  double tilt = 0.0, change = 1.0;
  MuralPose pose = pose_at(bot, x, y, tilt);
  for (int pass = 0; pass < kMostPasses && std::abs(change) > kConvergedRad; ++pass) {
    change = level_tilt(bot, pose) - tilt;
    tilt += change;
    pose = pose_at(bot, x, y, tilt);
  }
  // Iterations that oscillate for ever do so only above any place where the bot can hang.
  if (!(std::abs(change) < 1e-9)) return tl::unexpected(PlotterReason::not_converged);
  const auto length = [&](const Leg& leg, double force_n) {
    return std::hypot(leg.across_mm, leg.down_mm, g.standoff_mm) /
           (1.0 + as_set.cord.compliance_per_n * force_n);
  };
  return ChainLengths{length(pose.left, pose.force_left_n), length(pose.right, pose.force_right_n)};
}

}  // namespace

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
  if (firmware == PlotterFirmware::mural) return mural_lengths(as_set, command).map(counted);
  const double up = firmware == PlotterFirmware::fluidnc ? 0.5 * as_set.pin_rise_mm : 0.0;
  return counted({std::hypot(command.x_mm + half, command.y_mm + up),
                  std::hypot(command.x_mm - half, command.y_mm - up)});
}

}  // namespace chaintrue::model

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of controllers.
#include "tools/gcode/firmware.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

constexpr const char* kIgnores = "ignores";
constexpr const char* kStops = "stops with an error at";

// The codes that they implement, each between blanks.
constexpr const char* kMaslowCodes =
    " G0 G1 G2 G3 G4 G10 G20 G21 G38 G40 G90 G91 M0 M1 M2 M3 M4 M5 M6 M30 M106 M107 ";
constexpr const char* kFluidNcCodes =
    " G0 G1 G2 G3 G4 G10 G17 G18 G19 G20 G21 G28 G28.1 G30 G30.1 G38.2 G38.3 G38.4 G38.5 G38.6 "
    "G38.7 G38.8 G38.9 G40 G43.1 G49 G53 G54 G55 G56 G57 G58 G59 G61 G80 G90 G91 G91.1 G92 "
    "G92.1 G93 G94 M0 M1 M2 M3 M4 M5 M6 M7 M7.1 M8 M8.1 M9 M30 M62 M63 M64 M65 M67 M68 ";
constexpr const char* kMarlinCodes =
    " G0 G1 G2 G3 G4 G28 G90 G91 G92 M0 M1 M17 M18 M20 M21 M22 M23 M24 M25 M28 M29 M82 M83 M84 "
    "M85 M92 M106 M107 M110 M114 M115 M117 M118 M119 M200 M201 M203 M204 M205 M206 M210 M211 "
    "M220 M280 M300 M400 M410 M500 M501 M502 M503 M665 ";

constexpr Firmware maslow(const char* name) {
  return {.name = name,
          .single_precision = true,
          .tick_s = 0.01,
          .codes = kMaslowCodes,
          .clamps_to_bed = true,
          .planned_moves = 1,
          .unknown = kIgnores,
          .arcs = ArcRule::maslow};
}

constexpr Firmware fluidnc(const char* name, double piece_mm, bool pieces_at_most,
                           bool phantom_moves) {
  return {.name = name,
          .single_precision = true,
          .chain_linear_piece_mm = piece_mm,
          .pieces_at_most = pieces_at_most,
          .codes = kFluidNcCodes,
          .planned_moves = 16,
          .acceleration_mm_per_s2 = 25.0,
          .unknown = kStops,
          .arcs = ArcRule::grbl,
          .phantom_moves = phantom_moves};
}

constexpr Firmware kFluidNc = fluidnc("fluidnc_wallplotter", 10.0, false, true);
constexpr Firmware kFourBelts = fluidnc("maslow4", 5.0, true, false);

/// In the order of model::ControllerKind.
constexpr Firmware kFirmwares[] = {
    {.name = "ideal", .tool_lengths = true}, maslow("maslow_classic"), maslow("holey"), kFluidNc};

/// In the order of model::PlotterFirmware.
constexpr Firmware kPlotters[] = {
    kFluidNc,
    {.name = "marlin",
     .single_precision = true,
     .pieces_per_second = 5.0,
     .first_feed_mm_per_min = 1500.0,
     .codes = kMarlinCodes,
     .planned_moves = 16,
     .unknown = kIgnores,
     .semicolon_comments = true},
    {.name = "polargraph",
     .single_precision = true,
     .chain_linear_piece_mm = 2.0,
     .pieces_at_most = true,
     .reads_gcode = false},
    {.name = "mural", .chain_linear_piece_mm = 1.0, .pieces_at_most = true, .reads_gcode = false},
};

}  // namespace

const Firmware& firmware(model::ControllerKind kind) {
  return kFirmwares[static_cast<std::size_t>(kind)];
}

const Firmware& firmware_of_four_belts() { return kFourBelts; }

const Firmware& firmware(model::PlotterFirmware plotter) {
  return kPlotters[static_cast<std::size_t>(plotter)];
}

bool is_chain_linear(const Firmware& firmware) {
  return firmware.chain_linear_piece_mm > 0.0 || firmware.pieces_per_second > 0.0;
}

double pieces_of(const Firmware& firmware, double length_mm, double feed_mm_per_min) {
  if (firmware.pieces_per_second > 0.0) {
    const double feed = feed_mm_per_min > 0.0 ? feed_mm_per_min : firmware.first_feed_mm_per_min;
    return std::max(1.0, std::floor(firmware.pieces_per_second * 60.0 * length_mm / feed));
  }
  const double pieces = length_mm / firmware.chain_linear_piece_mm;
  return std::max(1.0, firmware.pieces_at_most ? std::ceil(pieces) : std::floor(pieces));
}

Code taken_for(const Firmware& firmware, Code code) {
  if (firmware.arcs == ArcRule::maslow && code.letter == 'G') code.tenths -= code.tenths % 10;
  return code;
}

bool knows_code(const Firmware& firmware, Code code) {
  const std::string word = fmt::format(" {} ", name(taken_for(firmware, code)));
  return firmware.codes.empty() || firmware.codes.find(word) != std::string_view::npos;
}

std::optional<ClampBox> clamp_box(const model::Machine& machine) {
  if (!firmware(machine.controller.kind).clamps_to_bed) return std::nullopt;
  const model::ControllerSettings& settings = machine.controller.settings;
  return ClampBox{0.5 * settings.bed_width_mm.value_or(machine.bed.width_mm),
                  0.5 * settings.bed_height_mm.value_or(machine.bed.height_mm)};
}

CommandWay::CommandWay(const Firmware& firmware, const model::ControllerKinematics& kinematics,
                       Point from, Point to, double feed_mm_per_min, double doubt_mm)
    : firmware_(firmware), kinematics_(kinematics), from_(from), to_(to) {
  if (!is_chain_linear(firmware)) return;
  const double length = level_mm(to - from) - doubt_mm;
  pieces_ = static_cast<int>(std::min(pieces_of(firmware, length, feed_mm_per_min), 1e6));
}

std::optional<Point> CommandWay::at(double t) {
  const Point place = between(from_, to_, t);
  if (!is_chain_linear(firmware_)) return place;
  const int piece = std::min(static_cast<int>(t * pieces_), pieces_ - 1);
  if (piece != piece_) {
    const auto lengths = [&](int end) -> std::optional<model::ChainLengths> {
      const auto found =
          kinematics_.lengths(between(from_, to_, static_cast<double>(end) / pieces_));
      return found ? std::optional(*found) : std::nullopt;
    };
    start_ = piece == piece_ + 1 && piece_ >= 0 ? end_ : lengths(piece);
    end_ = lengths(piece + 1);
    piece_ = piece;
  }
  if (!start_ || !end_) return std::nullopt;
  const double u = t * pieces_ - piece;
  const auto command =
      kinematics_.command({start_->left_mm + u * (end_->left_mm - start_->left_mm),
                           start_->right_mm + u * (end_->right_mm - start_->right_mm)});
  if (!command) return std::nullopt;
  return Point{command->x_mm, command->y_mm, place.z_mm};
}

}  // namespace chaintrue::gcode

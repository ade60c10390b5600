// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of controllers.
#include "tools/gcode/firmware.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

constexpr const char* kIgnores = "ignores";
constexpr const char* kStops = "stops with an error at";

constexpr int kMaslowG[] = {0, 10, 20, 30, 40, 100, 200, 210, 380, 400, 900, 910};
constexpr int kMaslowM[] = {0, 10, 20, 30, 40, 50, 60, 300, 1060, 1070};
constexpr int kFluidNcG[] = {0,   10,  20,  30,  40,  100, 170, 180, 190, 200, 210, 280, 281, 300,
                             301, 382, 383, 384, 385, 386, 387, 388, 389, 400, 431, 490, 530, 540,
                             550, 560, 570, 580, 590, 610, 800, 900, 910, 911, 920, 921, 930, 940};
constexpr int kFluidNcM[] = {
    0, 10, 20, 30, 40, 50, 60, 70, 71, 80, 81, 90, 300, 620, 630, 640, 650, 670, 680};

constexpr int kMarlinG[] = {0, 10, 20, 30, 40, 280, 900, 910, 920};
constexpr int kMarlinM[] = {0,    10,   170,  180,  200,  210,  220,  230,  240,  250,  280,
                            290,  820,  830,  840,  850,  920,  1060, 1070, 1100, 1140, 1150,
                            1170, 1180, 1190, 2000, 2010, 2030, 2040, 2050, 2060, 2100, 2110,
                            2200, 2800, 3000, 4000, 4100, 5000, 5010, 5020, 5030, 6650};

constexpr CodeSet kMaslowCodes{kMaslowG, kMaslowM};
constexpr CodeSet kFluidNcCodes{kFluidNcG, kFluidNcM};
constexpr CodeSet kMarlinCodes{kMarlinG, kMarlinM};

constexpr Firmware maslow(model::ControllerKind kind, const char* name) {
  return {.kind = kind,
          .name = name,
          .single_precision = true,
          .tick_s = 0.01,
          .codes = &kMaslowCodes,
          .clamps_to_bed = true,
          .planned_moves = 1,
          .unknown = kIgnores,
          .arcs = ArcRule::maslow};
}

constexpr Firmware kFirmwares[] = {
    {.kind = model::ControllerKind::ideal, .name = "ideal", .tool_lengths = true},
    maslow(model::ControllerKind::maslow_classic, "maslow_classic"),
    maslow(model::ControllerKind::holey, "holey"),
    {.kind = model::ControllerKind::fluidnc_wallplotter,
     .name = "fluidnc_wallplotter",
     .single_precision = true,
     .chain_linear_piece_mm = 10.0,
     .codes = &kFluidNcCodes,
     .planned_moves = 16,
     .acceleration_mm_per_s2 = 25.0,
     .unknown = kStops,
     .arcs = ArcRule::grbl,
     .phantom_moves = true},
};

constexpr Firmware kFourBelts{.kind = model::ControllerKind::fluidnc_wallplotter,
                              .name = "maslow4",
                              .single_precision = true,
                              .chain_linear_piece_mm = 5.0,
                              .pieces_at_most = true,
                              .codes = &kFluidNcCodes,
                              .planned_moves = 16,
                              .acceleration_mm_per_s2 = 25.0,
                              .unknown = kStops,
                              .arcs = ArcRule::grbl};

constexpr Firmware kMarlin{.name = "marlin",
                           .single_precision = true,
                           .pieces_per_second = 5.0,
                           .first_feed_mm_per_min = 1500.0,
                           .codes = &kMarlinCodes,
                           .planned_moves = 16,
                           .unknown = kIgnores,
                           .semicolon_comments = true};

constexpr Firmware kMural{
    .name = "mural", .chain_linear_piece_mm = 1.0, .pieces_at_most = true, .reads_gcode = false};

constexpr Firmware kPolargraph{.name = "polargraph",
                               .single_precision = true,
                               .chain_linear_piece_mm = 2.0,
                               .pieces_at_most = true,
                               .reads_gcode = false};

}  // namespace

const Firmware& firmware(model::ControllerKind kind) {
  return *std::find_if(std::begin(kFirmwares),
                       std::end(kFirmwares) - 1,
                       [&](const Firmware& candidate) { return candidate.kind == kind; });
}

const Firmware& firmware_of_four_belts() { return kFourBelts; }

const Firmware& firmware(model::PlotterFirmware plotter) {
  switch (plotter) {
    case model::PlotterFirmware::fluidnc:
      return firmware(model::ControllerKind::fluidnc_wallplotter);
    case model::PlotterFirmware::marlin:
      return kMarlin;
    case model::PlotterFirmware::polargraph:
      return kPolargraph;
    case model::PlotterFirmware::mural:
      break;
  }
  return kMural;
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
  if (firmware.codes == nullptr) return true;
  const auto tenths = code.letter == 'G' ? firmware.codes->g : firmware.codes->m;
  return std::find(tenths.begin(), tenths.end(), taken_for(firmware, code).tenths) != tenths.end();
}

std::optional<ClampBox> clamp_box(const model::Machine& machine) {
  if (!firmware(machine.controller.kind).clamps_to_bed) return std::nullopt;
  const model::ControllerSettings& settings = machine.controller.settings;
  return ClampBox{0.5 * settings.bed_width_mm.value_or(machine.bed.width_mm),
                  0.5 * settings.bed_height_mm.value_or(machine.bed.height_mm)};
}

CommandWay::CommandWay(const Firmware& firmware,
                       const model::ControllerKinematics& kinematics,
                       model::BedPoint from,
                       model::BedPoint to,
                       double feed_mm_per_min,
                       double doubt_mm)
    : firmware_(firmware), kinematics_(kinematics), from_(from), to_(to) {
  if (!is_chain_linear(firmware)) return;
  const double length = std::hypot(to.x_mm - from.x_mm, to.y_mm - from.y_mm) - doubt_mm;
  pieces_ = static_cast<int>(std::min(pieces_of(firmware, length, feed_mm_per_min), 1e6));
}

std::optional<model::BedPoint> CommandWay::at(double t) {
  if (!is_chain_linear(firmware_)) return on_line(t);
  const int piece = std::min(static_cast<int>(t * pieces_), pieces_ - 1);
  if (piece != piece_) {
    const auto lengths = [&](int end) -> std::optional<model::ChainLengths> {
      const auto found = kinematics_.lengths(on_line(static_cast<double>(end) / pieces_));
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
  return command ? std::optional(*command) : std::nullopt;
}

}  // namespace chaintrue::gcode

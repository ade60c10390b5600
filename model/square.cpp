// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/square.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "model/controllers/payout.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::model {
namespace {

double distance_mm(BedPoint a, BedPoint b) { return std::hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm); }

/// Distance of p to the left of the line from a to b: outwards, for a clockwise outline.
double outwards_mm(BedPoint a, BedPoint b, BedPoint p) {
  const double dx = b.x_mm - a.x_mm, dy = b.y_mm - a.y_mm;
  return (dx * (p.y_mm - a.y_mm) - dy * (p.x_mm - a.x_mm)) / std::hypot(dx, dy);
}

std::array<BedPoint, 4> corners_of(const SquareTask& task) {
  const double x = task.corner.x_mm, y = task.corner.y_mm - (task.below ? task.size_mm : 0.0);
  const double s = task.size_mm;
  return {{{x, y}, {x, y + s}, {x + s, y + s}, {x + s, y}}};
}

/// The corners' mean, and the length-weighted direction of the sides relative to the commanded
/// ones.
void place(CutSquare& square, const std::array<BedPoint, 4>& commanded,
           const std::array<BedPoint, 4>& cut) {
  double dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    square.offset.x_mm += 0.25 * (cut[i].x_mm - commanded[i].x_mm);
    square.offset.y_mm += 0.25 * (cut[i].y_mm - commanded[i].y_mm);
    const std::size_t j = (i + 1) % 4;
    const double ax = commanded[j].x_mm - commanded[i].x_mm,
                 ay = commanded[j].y_mm - commanded[i].y_mm;
    const double bx = cut[j].x_mm - cut[i].x_mm, by = cut[j].y_mm - cut[i].y_mm;
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  square.rotation_rad = std::atan2(cross, dot);
}

}  // namespace

std::vector<BedPoint> outline_of(const SquareTask& task) {
  if (!(task.size_mm > 0.0 && std::isfinite(task.size_mm)) || task.points_per_side < 2) {
    throw std::invalid_argument(
        fmt::format("a square of size_mm = {} with {} points to a side: expected a positive size "
                    "and two points or more",
                    task.size_mm, task.points_per_side));
  }
  const std::array<BedPoint, 4> corners = corners_of(task);
  std::vector<BedPoint> outline;
  for (std::size_t i = 0; i < 4; ++i) {
    const BedPoint a = corners[i], b = corners[(i + 1) % 4];
    for (int n = 0; n < task.points_per_side; ++n) {
      const double share = static_cast<double>(n) / (task.points_per_side - 1);
      outline.push_back({a.x_mm + share * (b.x_mm - a.x_mm), a.y_mm + share * (b.y_mm - a.y_mm)});
    }
  }
  return outline;
}

CutSquare measured_square(const SquareTask& task, std::vector<BedPoint> cut) {
  CutSquare square;
  square.commanded = outline_of(task);
  if (cut.size() != square.commanded.size()) {
    throw std::invalid_argument(fmt::format("{} points of a square cut, of an outline of {}",
                                            cut.size(), square.commanded.size()));
  }
  square.cut = std::move(cut);
  const std::size_t count = square.cut.size() / 4;
  std::array<BedPoint, 4> cut_corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const BedPoint from = square.cut[i * count], to = square.cut[(i + 1) * count - 1];
    cut_corners[i] = from;
    CutSide& side = square.sides[i];
    side.length_mm = distance_mm(from, to);
    for (std::size_t n = i * count; n < (i + 1) * count; ++n) {
      const double bow = outwards_mm(from, to, square.cut[n]);
      if (std::abs(bow) > std::abs(side.bow_mm)) side.bow_mm = bow;
    }
  }
  square.rising_diagonal_mm = distance_mm(cut_corners[0], cut_corners[2]);
  square.falling_diagonal_mm = distance_mm(cut_corners[1], cut_corners[3]);
  place(square, corners_of(task), cut_corners);
  return square;
}

tl::expected<CutSquare, SquareFailure> predict_square(const Machine& machine,
                                                      const Machine& controller_machine,
                                                      const SquareTask& task, Model model) {
  const std::vector<BedPoint> outline = outline_of(task);
  const auto controller = make_controller_kinematics(controller_machine);
  const ReadingModel world(machine, model);
  std::vector<BedPoint> cut;
  for (const BedPoint p : outline) {
    const auto lengths = controller->lengths(p);
    if (!lengths) return tl::unexpected(lengths.error().at(SquarePlace{p, true}));
    const auto tool = world.find(*lengths, p);
    if (!tool) return tl::unexpected(tool.error().at(SquarePlace{p}));
    cut.push_back(tool->pose.position);
  }
  return measured_square(task, std::move(cut));
}

}  // namespace chaintrue::model

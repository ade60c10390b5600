// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/effect_picture.hpp"

#include "grid/containers.hpp"
#include "grid/plane_vectors.hpp"

namespace chaintrue::grid::synthetic {
namespace {

using model::Visit;

constexpr int kColumns = 7;
constexpr int kRows = 4;
// 28, 60 and 200 marks.
constexpr std::array<std::array<int, 2>, 3> kGrids = {{{7, 4}, {10, 6}, {20, 10}}};
constexpr double kSquareMm = 100.0;

ShiftedSquare square_at(const Machine& machine, const AppliedEffect& applied, BedPoint centre) {
  ShiftedSquare square;
  square.centre = centre;
  constexpr double kHalfMm = 0.5 * kSquareMm;
  constexpr double kCorners[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  std::vector<Visit> visits;
  for (const auto& [x, y] : kCorners) {
    visits.push_back(
        {{centre.x_mm + x * kHalfMm, centre.y_mm + y * kHalfMm}, as_int(visits.size())});
  }
  const std::vector<Vector2d> shift = signature(machine, {applied}, visits).tool_shift_mm();
  std::array<Vector2d, 4> cut;
  for (const auto i : each_index(cut)) {
    square.corner_shift_mm[i] = shift[i];
    cut[i] = vector_of(visits[i].position) + shift[i];
  }
  for (const auto i : each_index(cut))
    square.side_mm[i] = (cut[(i + 1) % cut.size()] - cut[i]).norm();
  square.diagonal_mm = {(cut[2] - cut[0]).norm(), (cut[3] - cut[1]).norm()};
  return square;
}

}  // namespace

EffectPicture picture_effect(const Machine& machine, const Effect& effect, EffectSide side,
                             const std::vector<double>& values, const StatedNoise& noise) {
  EffectPicture picture;
  const AppliedEffect applied = model::effects::applied(effect, side, values);
  picture.applied = applied;
  picture.noise = noise;
  picture.columns = kColumns;
  picture.rows = kRows;
  const std::vector<Visit> visits = regular_session(machine, kColumns, kRows);
  const StrengthTable table(machine, visits, noise);
  const std::vector<Vector2d> stated = signature(machine, {applied}, visits).tool_shift_mm();
  const std::vector<Vector2d> calibrated = table.calibrated_shift_mm(applied);
  for (const auto i : each_index(visits)) {
    picture.marks.push_back({identity_placement(visits[i].position), stated[i], calibrated[i]});
  }
  // In the middle, and towards a lower corner, where most effects are largest.
  picture.squares.push_back(square_at(machine, applied, {0.0, 0.0}));
  picture.squares.push_back(
      square_at(machine, applied, {-0.42 * machine.bed.width_mm, -0.38 * machine.bed.height_mm}));
  for (const auto& [columns, rows] : kGrids) {
    const bool same = columns == kColumns && rows == kRows;
    const StrengthTable other =
        same ? table : StrengthTable(machine, regular_session(machine, columns, rows), noise);
    picture.strengths.push_back({columns, rows, other.strength(effect, side)});
  }
  return picture;
}

}  // namespace chaintrue::grid::synthetic

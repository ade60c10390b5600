// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/gcode/expected_error.hpp"

#include <algorithm>
#include <cmath>

#include "grid/map/largest_error.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

/// A map's error changes over the spacing of its points, some hundred millimetres.
constexpr double kSquareMm = 20.0;
/// Weight of a plunge among cuts.
constexpr double kPlungeMm = 1.0;
/// A whole circle in chords that stay within a square.
constexpr double kChordsPerRadian = 4.0;

/// One part of the cuts while its squares are added.
class Sum {
 public:
  void add(double length_mm, const Eigen::Matrix2Xd& spread_mm, std::size_t line) {
    const double sigma_mm = spread_mm.norm();
    largest_.add(Eigen::Vector2d::Zero(), spread_mm);
    part_.rms_mm += length_mm * sigma_mm * sigma_mm;
    part_.length_mm += length_mm;
    if (sigma_mm <= weakest_mm_) return;
    weakest_mm_ = sigma_mm;
    part_.weakest_line = line;
  }
  ErrorAlong finished() const {
    ErrorAlong part = part_;
    if (part.length_mm > 0.0) part.rms_mm = std::sqrt(part.rms_mm / part.length_mm);
    part.largest_mm = largest_.bound_mm();
    return part;
  }

 private:
  ErrorAlong part_;
  grid::LargestError largest_;
  double weakest_mm_ = -1.0;
};

}  // namespace

CutPlaces::Square& CutPlaces::square_at(At at, std::size_t line) {
  if (last_ == nullptr || at != last_at_) {
    last_ = &squares_.try_emplace(at, Square{0.0, line}).first->second;
    last_at_ = at;
  }
  return *last_;
}

void CutPlaces::add(std::size_t line, const Point& from, const Point& to) {
  const double length = level_mm(to - from);
  const double pieces = std::max(1.0, std::ceil(length / kSquareMm));
  for (double i = 0.5; i < pieces; i += 1.0) {
    const Point place = between(from, to, i / pieces);
    const At at{static_cast<int>(std::floor(place.x_mm / kSquareMm)),
                static_cast<int>(std::floor(place.y_mm / kSquareMm))};
    square_at(at, line).length_mm += std::max(length, kPlungeMm) / pieces;
  }
}

void CutPlaces::add(const Move& move) {
  if (move.kind == MoveKind::rapid) return;
  if (!move.arc) return add(move.line, move.from, move.to);
  const double chords = std::ceil(kChordsPerRadian * std::fabs(move.arc->sweep_rad)) + 1.0;
  Point from = move.from;
  for (double i = 1.0; i <= chords; i += 1.0) {
    const Point to = at(move, i / chords);
    add(move.line, from, to);
    from = to;
  }
}

std::optional<ExpectedError> CutPlaces::expected(const grid::LengthMap& map) const {
  Sum measured;
  Sum outside;
  for (const auto& [at, square] : squares_) {
    const model::BedPoint middle{kSquareMm * (at.first + 0.5), kSquareMm * (at.second + 0.5)};
    const auto answer = map.query(middle);
    // A square's middle may be off the map although the cut is not.
    if (!answer) continue;
    if (!answer->tool_sigma_mm) return std::nullopt;
    (answer->status == grid::MapStatus::extrapolated ? outside : measured)
        .add(square.length_mm, map.tool_spread(middle), square.line);
  }
  return ExpectedError{measured.finished(), outside.finished()};
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/synthetic/design.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <tuple>

#include "grid/containers.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::synthetic {
namespace {

constexpr double kRoundNumberMm = 100.0;
constexpr int kBands = 5;

/// `words` in the order of the enumerators.
template <class Enum>
std::optional<Enum> enumerator_of(std::string_view word,
                                  std::initializer_list<std::string_view> words) {
  const auto* found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) return std::nullopt;
  return static_cast<Enum>(found - words.begin());
}

// From the bed's centre to the outermost marks.
double half_span(double bed_mm, const std::optional<double>& margin_mm) {
  const double span = margin_mm
                          ? bed_mm - 2.0 * *margin_mm
                          : std::max(std::floor(bed_mm / kRoundNumberMm), 1.0) * kRoundNumberMm;
  if (!(span > 0.0)) {
    throw precondition("design: a margin of {} mm leaves nothing of {} mm", *margin_mm, bed_mm);
  }
  return 0.5 * std::min(span, bed_mm);
}

// The i-th of count positions from -1 to 1.
double position(DesignKind kind, int i, int count) {
  const double share = as_double(i) / (count - 1);
  return kind == DesignKind::chebyshev ? -std::cos(std::numbers::pi * share) : 2.0 * share - 1.0;
}

bool within(Region region, MarkPoint p) {
  switch (region) {
    case Region::left:
      return p.x_mm <= 0.0;
    case Region::right:
      return p.x_mm >= 0.0;
    case Region::top:
      return p.y_mm >= 0.0;
    case Region::bottom:
      return p.y_mm <= 0.0;
    case Region::whole:
      break;
  }
  return true;
}

int band(double value, double half) {
  const int index = static_cast<int>(std::floor((value / half + 1.0) / 2.0 * kBands));
  return std::clamp(index, 0, kBands - 1);
}

std::vector<Mark> lattice(const Design& design, double half_x, double half_y) {
  if (design.columns < 2 || design.rows < 2) {
    throw precondition("design: {} x {} marks, at least 2 x 2 are needed", design.columns,
                       design.rows);
  }
  std::vector<Mark> result;
  for (int row = 0; row < design.rows; ++row) {
    for (int column = 0; column < design.columns; ++column) {
      const bool corner =
          (row == 0 || row == design.rows - 1) && (column == 0 || column == design.columns - 1);
      if (design.without_corners && corner) continue;
      result.push_back({{half_x * position(design.kind, column, design.columns),
                         half_y * position(design.kind, row, design.rows)},
                        column,
                        row});
    }
  }
  return result;
}

std::vector<MarkPoint> scattered(const Design& design, double half_x, double half_y,
                                 Random& random) {
  if (design.points < 1) throw precondition("design: {} points", design.points);
  std::vector<MarkPoint> result;
  // Corners that are left out are a fifth of the half span wide.
  const auto in_corner = [&](MarkPoint p) {
    return std::abs(p.x_mm) > 0.8 * half_x && std::abs(p.y_mm) > 0.8 * half_y;
  };
  while (result.size() < as_size(design.points)) {
    const double x = random.uniform(-half_x, half_x);
    const double y = random.uniform(-half_y, half_y);
    if (within(design.region, {x, y}) && !(design.without_corners && in_corner({x, y}))) {
      result.push_back({x, y});
    }
  }
  return result;
}

}  // namespace

std::vector<Mark> marks(const Bed& bed, const Design& design, Random& random) {
  const double half_x = half_span(bed.width_mm, design.margin_mm);
  const double half_y = half_span(bed.height_mm, design.margin_mm);
  std::vector<Mark> result;
  if (design.kind == DesignKind::regular || design.kind == DesignKind::chebyshev) {
    result = lattice(design, half_x, half_y);
  } else {
    const std::vector<MarkPoint> places =
        design.kind == DesignKind::given ? design.given : scattered(design, half_x, half_y, random);
    for (const MarkPoint& p : places) {
      result.push_back({p, band(p.x_mm, 0.5 * bed.width_mm), band(p.y_mm, 0.5 * bed.height_mm)});
    }
  }
  std::erase_if(result, [&](const Mark& mark) { return !within(design.region, mark.place); });
  return result;
}

void put_in_order(std::vector<Mark>& marks, VisitingOrder order, Random& random) {
  if (order == VisitingOrder::random) {
    random.shuffle(marks);
    return;
  }
  const bool by_column =
      order == VisitingOrder::columns || order == VisitingOrder::serpentine_columns;
  const bool turning =
      order == VisitingOrder::serpentine_rows || order == VisitingOrder::serpentine_columns;
  const auto key = [&](const Mark& mark) {
    const int line = by_column ? mark.column : mark.row;
    const double along = by_column ? mark.place.y_mm : mark.place.x_mm;
    return std::tuple{line, turning && line % 2 == 1 ? -along : along};
  };
  stable_sort(marks, ascending(key));
}

std::optional<DesignKind> design_kind(std::string_view word) {
  return enumerator_of<DesignKind>(word, {"regular", "chebyshev", "random", "given"});
}

std::optional<Region> region(std::string_view word) {
  return enumerator_of<Region>(word, {"whole", "left", "right", "top", "bottom"});
}

std::optional<VisitingOrder> visiting_order(std::string_view word) {
  return enumerator_of<VisitingOrder>(
      word, {"rows", "columns", "serpentine_rows", "serpentine_columns", "random"});
}

}  // namespace chaintrue::grid::synthetic

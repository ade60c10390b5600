// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tiles are tabulated once they have been evaluated often enough.
#include "tools/gcode/command_field.hpp"

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

/// With 8 cells on a side a cell is 30 mm: the correction of a smooth map is interpolated to 1e-6
/// mm.
constexpr double kTileMm = 240.0;
/// 7.5 mm cells resolve a wave with the period of a sprocket's turn (63.5 mm).
constexpr int kMostCells = 32;

/// Evaluations for the nodes, and for the five checks in every cell.
int cost(int cells) { return (cells + 1) * (cells + 1) + 5 * cells * cells; }

int tiles(double length_mm) {
  return std::max(1, static_cast<int>(std::ceil(length_mm / kTileMm)));
}

}  // namespace

CommandField::CommandField(const Corrector& corrector, double bound_mm)
    : corrector_(corrector),
      bound_mm_(bound_mm),
      bounds_(corrector.map().domain()),
      columns_(tiles(bounds_.x_max - bounds_.x_min)),
      rows_(tiles(bounds_.y_max - bounds_.y_min)),
      tiles_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

CommandField::Tile* CommandField::tile(model::BedPoint target) {
  const double u = (target.x_mm - bounds_.x_min) / (bounds_.x_max - bounds_.x_min);
  const double v = (target.y_mm - bounds_.y_min) / (bounds_.y_max - bounds_.y_min);
  if (!(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) return nullptr;
  const int column = std::min(static_cast<int>(u * columns_), columns_ - 1);
  const int row = std::min(static_cast<int>(v * rows_), rows_ - 1);
  return &tiles_[static_cast<std::size_t>(row * columns_ + column)];
}

void CommandField::tabulate(Tile& tile) {
  const auto index = static_cast<int>(&tile - tiles_.data());
  const auto share = [](double low, double high, int part, int parts) {
    return low + (high - low) * part / parts;
  };
  const int column = index % columns_;
  const int row = index / columns_;
  const interp::Rectangle area{share(bounds_.x_min, bounds_.x_max, column, columns_),
                               share(bounds_.x_min, bounds_.x_max, column + 1, columns_),
                               share(bounds_.y_min, bounds_.y_max, row, rows_),
                               share(bounds_.y_min, bounds_.y_max, row + 1, rows_)};
  bool everywhere = true;
  auto table = interp::CompiledPair::compile(area, tile.cells, tile.cells, [&](double x, double y) {
    // A tile's last node may miss the bounds by a rounding.
    const model::BedPoint place{std::clamp(x, bounds_.x_min, bounds_.x_max),
                                std::clamp(y, bounds_.y_min, bounds_.y_max)};
    const auto command = corrector_.command(place);
    everywhere = everywhere && command.has_value();
    return command ? std::array{command->x_mm - place.x_mm, command->y_mm - place.y_mm}
                   : std::array{0.0, 0.0};
  });
  // The error of a distance is at most that of X and of Y together.
  if (everywhere && std::sqrt(2.0) * table.error().bound <= bound_mm_) {
    tile.table = std::move(table);
    return;
  }
  tile.cells = everywhere ? 2 * tile.cells : kMostCells + 1;
  tile.computed = 0;
}

tl::expected<model::BedPoint, CorrectionFailure> CommandField::command(model::BedPoint target) {
  Tile* const here = tile(target);
  // Beyond the measured points a map may refuse, place by place.
  if (here == nullptr || corrector_.map().status(target) >= grid::MapStatus::extrapolated) {
    return corrector_.command(target);
  }
  if (!here->table && here->cells <= kMostCells && ++here->computed > cost(here->cells)) {
    tabulate(*here);
  }
  if (!here->table) return corrector_.command(target);
  const auto add = here->table->value(target.x_mm, target.y_mm);
  return model::BedPoint{target.x_mm + add[0], target.y_mm + add[1]};
}

}  // namespace chaintrue::gcode

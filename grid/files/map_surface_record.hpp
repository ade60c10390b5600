// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The surfaces of a map in a chaintrue_map file. Private to grid/files.
#pragma once

#include <optional>
#include <vector>

#include "grid/files/json_reader.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

using Numbers = std::vector<double>;

struct SplinePart {
  interp::Rectangle rectangle;
  int x_intervals = 0;
  int y_intervals = 0;
  model::PerSide<double> scale;
  model::PerSide<Eigen::VectorXd> coefficients_mm;
};

/// A ModelSurface as its file has it: the basis by its intervals, and the triangle alone of the
/// covariance.
struct ModelPart {
  model::Machine machine;
  model::SheetPlacement sheet;
  std::vector<model::Setting> settings;
  SplinePart residual;
  std::vector<Numbers> covariance_factor;
  std::optional<LatticeResidual> lattice;
};

[[nodiscard]] const Record<interp::Rectangle>& rectangle_record();
[[nodiscard]] const Record<ModelPart>& model_part_record();
[[nodiscard]] const Record<DirectSurface>& direct_surface_record();

[[nodiscard]] ModelPart part_of(const ModelSurface& surface);
[[nodiscard]] ModelSurface surface_of(const ModelPart& part);

}  // namespace chaintrue::grid::files

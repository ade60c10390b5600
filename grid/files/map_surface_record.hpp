// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The surfaces of a map in a chaintrue_map file. Private to grid/files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/files/json_reader.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

using Numbers = std::vector<double>;

struct SplinePart {
  interp::Rectangle rectangle;
  int x_intervals = 0;
  int y_intervals = 0;
  double scale_left = 0.0;
  double scale_right = 0.0;
  Numbers left_mm;
  Numbers right_mm;
};

struct LatticePart {
  Numbers x_nodes_mm;
  Numbers y_nodes_mm;
  std::vector<Numbers> left_mm;  // rows of constant x
  std::vector<Numbers> right_mm;
  std::vector<Numbers> doubt_mm;
  double interpolation_sigma_mm = 0.0;
};

struct ModelPart {
  model::Machine machine;
  model::SheetPlacement sheet;
  std::vector<std::string> unknown_settings;
  SplinePart residual;
  std::vector<Numbers> covariance_factor;
  std::optional<LatticePart> lattice;
};

struct DirectPart {
  Numbers x_nodes_mm;
  Numbers y_nodes_mm;
  std::vector<Numbers> left_mm;  // rows of constant x
  std::vector<Numbers> right_mm;
  interp::TensorEnds ends;
  double interpolation_sigma_mm = 0.0;
};

[[nodiscard]] const Record<interp::Rectangle>& rectangle_record();
[[nodiscard]] const Record<ModelPart>& model_part_record();
[[nodiscard]] const Record<DirectPart>& direct_part_record();

[[nodiscard]] ModelPart part_of(const ModelSurface& surface);
[[nodiscard]] DirectPart part_of(const DirectSurface& surface);
[[nodiscard]] ModelSurface surface_of(const ModelPart& part);
[[nodiscard]] DirectSurface surface_of(const DirectPart& part);

}  // namespace chaintrue::grid::files

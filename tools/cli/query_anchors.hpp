// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue query of an anchors file: four belt lengths for places of the sheet, and the place for
/// two.
#pragma once

#include <string>
#include <vector>

#include "model/coordinates.hpp"
#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

struct AnchorsQuery {
  InputFile file;
  std::vector<model::BedPoint> points;
  std::vector<double> inverse;  ///< of the upper two belts; empty where points are asked
  std::string output = "-";
  bool json = false;
};
/// Returns an exit code. \throws grid::files::InputError.
[[nodiscard]] int query_anchors(const AnchorsQuery& query);

}  // namespace chaintrue::cli

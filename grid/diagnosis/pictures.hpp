// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The data of a diagnosis' pictures: every point and distance with its residual before and after
/// naming. Lengths and shifts in mm, angles in rad, tensions in N.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "interp/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::diagnosis {

/// A point of the grid in the pictures: shifts of the tool [mm], measured less predicted.
struct PointPicture {
  std::size_t index = 0;
  MarkPoint mark;
  std::optional<int> order;
  bool bad = false;
  Vector2d before_mm = Vector2d::Zero();       ///< of the calibrated machine
  Vector2d after_mm = Vector2d::Zero();        ///< with the causes named
  Vector2d noise_sigma_mm = Vector2d::Zero();  ///< one sigma of the tool, along x and y
  /// Chain residuals [mm], measured less predicted.
  Vector2d chain_before_mm = Vector2d::Zero();
  Vector2d chain_after_mm = Vector2d::Zero();
  /// The strip: chains' residuals that the best cause and its rival explain, settings refitted.
  Vector2d best_mm = Vector2d::Zero();
  Vector2d rival_mm = Vector2d::Zero();
  ChainLengths lengths;
  double angle_left_rad = 0.0;
  double angle_right_rad = 0.0;
  double tension_left_n = 0.0;
  double tension_right_n = 0.0;
  /// +1 if the chain was paid out to get here, -1 if it was taken in; 0 without an order.
  int direction_left = 0;
  int direction_right = 0;
};

/// A hole in the pictures, where the calibrated machine puts it.
struct HolePicture {
  std::string name;
  MarkPoint commanded;
  MarkPoint mark;
};

/// A distance in the pictures: residuals are read less predicted [mm], the holes where the machine
/// puts them.
struct DistancePicture {
  std::size_t index = 0;  ///< into the set's distances
  std::string from;       ///< a hole's name
  std::string to;         ///< a hole's name, or an edge: left, right, top, bottom
  bool bad = false;
  double read_mm = 0.0;  ///< without the hook
  double before_mm = 0.0;
  double after_mm = 0.0;
  double noise_sigma_mm = 0.0;  ///< of the tape and of the holes at its ends
  double best_mm = 0.0;         ///< what the best cause explains, settings refitted
  double rival_mm = 0.0;
};

/// "A-B", "A to the top edge".
std::string words_of_ends(const DistancePicture& distance);

}  // namespace chaintrue::grid::diagnosis

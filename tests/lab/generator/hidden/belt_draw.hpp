// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A session of four belts with a hidden cause, drawn from a seed: the truth, and the data that the
/// owner would have. Shares no code with the product.
///
/// The strength of a cause is the norm, in sigmas of one belt's reading, of its change of the
/// readings after projection on the five anchor coordinates and the position of each point. The
/// noise is chosen to give the required strength.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "generator/hidden/belt_law.hpp"
#include "generator/hidden/belts.hpp"

namespace chaintrue::generator {

struct BeltSecret {
  std::string effect;  ///< belt_stretch, belt_scale, ...; empty: nothing
  std::string side;    ///< tl, tr, bl, br, all; empty: none
  double size = 0.0;   ///< elongation, share, mm, teeth, mm per visit
  double direction_rad = 0.0;
  int first_visit = 0;
  double strength = 0.0;
  std::vector<std::array<int, 2>> bad;  ///< point and belt (tl, tr, bl, br) of bad readings
  std::optional<SizedLaw> law;
};

struct BeltRecipe {
  std::string effect;  ///< empty: any of the seven that one pull shows at their usual sizes
  bool nothing = false;
  double least_strength = 6.0;
  double most_strength = 40.0;
  int bad_readings = 0;  ///< of one belt each, at separate points
  /// All points once with each: sizes and the strength are those of the first.
  std::vector<double> pulls = {1.0};
  /// A law or a field as well; of recipes with one pull.
  std::optional<LawFamily> law{};
};

struct BeltDraw {
  BeltSecret secret;
  BeltFrame frame;                      ///< the true one, before anything moved
  std::vector<FourLengths> lengths_mm;  ///< slanting, belts alone; in the order of the visits
  std::vector<double> pulls;            ///< at each, as the recipe has them
  double noise_mm = 0.0;
};
BeltDraw draw_belts(const BeltRecipe& recipe, std::uint64_t seed);

}  // namespace chaintrue::generator

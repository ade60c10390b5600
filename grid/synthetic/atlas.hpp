// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The effect of each cause on a drawing: a lattice of lines over the machine's area and a square
/// in its middle, drawn by a controller that does not know the cause. Causes are the settings of
/// the mechanism and the effects of its catalogue, at their usual size and at multiples of it.
///
/// For a command q the controller pays out f(q) of the machine as set; the tool comes to rest where
/// the true machine reads the same,
///
///   f_is(p, visit) = f_set(q)                                                              (1)
///
/// and on a sheet with effects of the paper one reads the numbers of the mark at p. A visit is a
/// line of the drawing; with belts it continues from the places of the calibration. Two chains and
/// two cords are drawn as they are set. Four belts find their anchors first: an effect acts on
/// kAtlasPlaces places, the anchors that fit best are taken, and the two upper belts place the tool
/// with them; an anchor that is wrong is drawn as it is set.
///
/// \code
///   const Atlas atlas = atlas_of(*model::make_plotter_mechanism(machine));
///   for (const AtlasPicture& picture : atlas.pictures) draw(atlas.lines, picture);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/belts/belt_machine.hpp"
#include "model/effects/effect.hpp"
#include "model/mechanism.hpp"

namespace chaintrue::grid::synthetic {

inline constexpr int kAtlasPlaces = 36;

/// A polyline as commanded, in the mechanism's frame; of belts about the middle between the anchors.
struct AtlasLine {
  std::vector<ToolPosition> points;
  bool is_of_square = false;
};

struct AtlasFrame {
  double size = 0.0;  ///< of the cause's first size, in its own unit; of a setting, true less set
  /// As AtlasLine::points; empty if the machine cannot hold the tool.
  std::vector<std::vector<std::optional<ToolPosition>>> lines;
};

struct AtlasPicture {
  /// Null for a setting.
  const Effect* effect = nullptr;
  EffectSide side = EffectSide::none;
  std::string_view parameter;  ///< its size's name, or the setting
  double null = 0.0;           ///< the size without effect
  /// Sizes rise; the usual one is among them.
  std::vector<AtlasFrame> frames{};
  std::size_t usual = 0;  ///< of the frames
  /// For the usual frame.
  double largest_shift_mm = 0.0;
};

struct Atlas {
  std::vector<AtlasLine> lines;
  bool calibrates_first = false;  ///< four belts
  /// Settings in the order of the mechanism, then effects in that of its catalogue. Those that cannot
  /// act on the machine are left out.
  std::vector<AtlasPicture> pictures;
  /// Causes that can act, but with whose usual size the machine or its calibration fails:
  /// "anchor_moved:tl".
  std::vector<std::string> not_drawn;
};

/// For two chains or a V-plotter; only for one cause, by the name of its setting or effect, if
/// `cause` is not empty.
Atlas atlas_of(const Mechanism& mechanism, std::string_view cause = {});
/// For four belts. \throws std::invalid_argument for anchors that are not known.
Atlas atlas_of(const BeltMachine& machine, std::string_view cause = {});

}  // namespace chaintrue::grid::synthetic

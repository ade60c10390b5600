// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Patterns that are in no catalogue and act in addition to a cause: one scalar field of height 1
/// that enters the two chains at a fixed ratio, as for anything that acts on one chain, one axis or
/// the sled's height.
///
/// Two groups. Those of smooth fields (pattern.cpp): dents and waves, at the lengths of the
/// required figures and at short ones. Other families (other_patterns.cpp): written independently
/// of the analysis and not used in its development.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"
#include "generator/hidden/strength.hpp"

namespace chaintrue::generator {

enum class PatternGroup {
  smooth,       ///< dents of 180 to 320 mm (one sigma), waves of 500 to 900 mm
  short_scale,  ///< dents of 90 to 150 mm, waves of 250 to 450 mm
  broad,        ///< dents of 400 to 900 mm, waves of 1200 to 3000 mm: as smooth as effects are
  other,        ///< other families
};

enum class PatternFamily {
  dent,
  wave,
  fold,         ///< linear on either side of a line, bent along it
  column_band,  ///< one upright strip of the bed
  chain_angle,  ///< a function of one chain's angle
  edge_heave,   ///< rises towards one edge of the bed
  patch,        ///< constant over a part of the bed and outside it, a short slope between
  length_steps  ///< along one chain's length: a few levels with slopes between
};

/// Argument of a field: the tool's position, and the chains' or belts' angles and lengths there.
struct PatternSite {
  Vec2 place;
  std::array<double, 4> angle_rad{};
  std::array<double, 4> length_mm{};
};
[[nodiscard]] std::vector<PatternSite> sites_of(std::span<const Visit> visits,
                                                const std::vector<Rest>& at_rest);

struct Pattern {
  PatternFamily family = PatternFamily::dent;
  double height_mm = 1.0;
  Lengths entry{1.0, 0.0};     ///< its share in each chain; a unit vector
  Vec2 centre;                 ///< of a dent or patch; a point of a line
  double direction_rad = 0.0;  ///< a wave's run; across a line
  double extent_mm = 0.0;      ///< one sigma, wavelength, width
  double phase_rad = 0.0;
  std::size_t chain = 0;          ///< whose angle or length it depends on
  std::array<double, 8> knots{};  ///< further parameters of a family
};

/// For height 1: that is about its maximum over the bed.
[[nodiscard]] double field(const Pattern& pattern, const PatternSite& site);
/// The other families.
[[nodiscard]] double other_field(const Pattern& pattern, const PatternSite& site);

/// Family, position and extent; of height 1.
[[nodiscard]] Pattern draw_family(PatternGroup group, Dice& dice);
[[nodiscard]] Pattern draw_other_family(Dice& dice);

/// Its addition to the chains at each site.
[[nodiscard]] std::vector<Lengths> extra_lengths(const Pattern& pattern,
                                                 std::span<const Visit> visits,
                                                 const std::vector<Rest>& at_rest);

/// A pattern with its strength in the data and its collinearity with the hidden causes.
struct SizedPattern {
  Pattern pattern;
  double delta = 0.0;
  double rho = 0.0;  ///< largest |cosine| with the given signatures, or with any effect
};
struct PatternRules {
  PatternGroup group = PatternGroup::smooth;
  /// Height 1 to 2 mm; a strength outside this range is drawn again.
  double least_delta = 6.0;
  double most_delta = 30.0;
  /// Collinear with some effect of the catalogue: |cosine| 0.9 to 0.98. Otherwise below 0.5 with
  /// `alongside`.
  bool near = false;
};
/// \throws std::runtime_error if 20 000 draws find none.
[[nodiscard]] SizedPattern draw_pattern(const Yardstick& yardstick,
                                        const PatternRules& rules,
                                        std::span<const Signature> alongside,
                                        Dice& dice);

}  // namespace chaintrue::generator

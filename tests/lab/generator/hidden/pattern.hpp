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

#include <span>
#include <vector>

#include "generator/hidden/disturbance.hpp"
#include "generator/hidden/random.hpp"
#include "generator/hidden/strength.hpp"

namespace chaintrue::generator {

enum class PatternGroup {
  smooth,       ///< dents of 180 to 320 mm (one sigma), waves of 500 to 900 mm
  short_scale,  ///< dents of 90 to 150 mm, waves of 250 to 450 mm
  broad,        ///< dents of 400 to 900 mm, waves of 1200 to 3000 mm: as smooth as effects are
  other,        ///< other families
};

/// Its addition to the chains, for a height of 1 to 2 mm, with its strength in the data and its collinearity with the
/// hidden causes.
struct SizedPattern {
  Disturbance disturbance;
  double delta = 0.0;
  double rho = 0.0;  ///< largest |cosine| with the given signatures, or with any effect
};

/// Family, position and extent; of height 1, which is about its maximum over the bed.
Field draw_family(PatternGroup group, Dice& dice);
/// The other families.
Field draw_other_family(Dice& dice);

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
SizedPattern draw_pattern(const Yardstick& yardstick, const PatternRules& rules,
                          std::span<const Signature> alongside, Dice& dice);

}  // namespace chaintrue::generator

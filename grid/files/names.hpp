// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of values, the same in files and on the command line.
///
/// \code
///   const auto end = named(kEndConditions, "clamped");   // empty for a word that is none of them
/// \endcode
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/visiting_order.hpp"
#include "model/kinematics.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Those of an enumeration, in the order of its enumerators.
template <class E>
struct NamesOf : Words {
  using Words::Words;
};

inline const NamesOf<ControllerKind> kControllerKinds = {"ideal", "maslow_classic", "holey",
                                                         "fluidnc_wallplotter"};
inline const NamesOf<Feed> kFeeds = {"over_top", "off_bottom"};
inline const NamesOf<Model> kModels = {"straight",     "wrap",    "firmware",  "one_shot",
                                       "inextensible", "elastic", "elastic_3d"};
inline const NamesOf<interp::EndCondition> kEndConditions = {"not_a_knot", "natural", "parabolic",
                                                             "clamped"};
/// What a map does beyond its points.
inline const NamesOf<Outside> kOutsideWays = {"continued", "refuse", "fade", "linear", "clamp"};
/// From the top left.
inline const Words kVisitingOrders = {"rows", "columns", "serpentine_rows", "serpentine_columns"};

template <class E>
std::optional<E> named(const NamesOf<E>& names, std::string_view word) {
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end()) return std::nullopt;
  return static_cast<E>(found - names.begin());
}

inline std::optional<VisitingOrder> visiting_order(std::string_view word) {
  if (!contains(kVisitingOrders, word)) return std::nullopt;
  return VisitingOrder{.rows = word.ends_with("rows"), .serpentine = word.starts_with("serp")};
}

}  // namespace chaintrue::grid::files

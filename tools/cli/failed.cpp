// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/failed.hpp"

#include <array>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/map/check.hpp"
#include "grid/map/fit.hpp"
#include "grid/planning/measurement_plan.hpp"

namespace chaintrue::cli {
namespace {

/// `last` is the enumerator of the last name, which ensures that every enumerator has a name.
template <auto kLast, class Names>
std::string_view name_in(const Names& names, decltype(kLast) reason) {
  static_assert(std::tuple_size_v<Names> == static_cast<std::size_t>(kLast) + 1);
  return names.at(static_cast<std::size_t>(reason));
}

}  // namespace

std::string_view name_of(grid::BeltsFitReason reason) {
  static constexpr std::array<std::string_view, 6> kNames = {"too_few_points",
                                                             "not_determined",
                                                             "no_frame",
                                                             "hole_without_anchors",
                                                             "too_many_distances",
                                                             "tape_contradicts"};
  return name_in<grid::BeltsFitReason::tape_contradicts>(kNames, reason);
}

std::string_view name_of(grid::CheckReason reason) {
  static constexpr std::array<std::string_view, 6> kNames = {
      "too_many_readings", "no_machine", "no_lengths", "unreachable", "no_noise", "nowhere"};
  return name_in<grid::CheckReason::nowhere>(kNames, reason);
}

std::string_view name_of(grid::FitReason reason) {
  static constexpr std::array<std::string_view, 7> kNames = {"no_machine",
                                                             "not_a_grid",
                                                             "no_lengths",
                                                             "point_unreachable",
                                                             "rank_deficient",
                                                             "impossible_readings",
                                                             "not_converged"};
  return name_in<grid::FitReason::not_converged>(kNames, reason);
}

std::string_view name_of(grid::PlanReason reason) {
  static constexpr std::array<std::string_view, 4> kNames = {
      "no_machine", "unreachable", "too_few_places", "no_map"};
  return name_in<grid::PlanReason::no_map>(kNames, reason);
}

std::string_view name_of(diagnosis::DiagnosisReason reason) {
  static constexpr std::array<std::string_view, 6> kNames = {"no_machine",
                                                             "no_lengths",
                                                             "too_few_points",
                                                             "no_noise",
                                                             "point_unreachable",
                                                             "contradictory_settings"};
  return name_in<diagnosis::DiagnosisReason::contradictory_settings>(kNames, reason);
}

}  // namespace chaintrue::cli

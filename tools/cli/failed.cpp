// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/failed.hpp"

#include <cstddef>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/map/check.hpp"
#include "grid/map/fit.hpp"
#include "grid/planning/measurement_plan.hpp"

namespace chaintrue::cli {
namespace {

/// `kLast` is the enumerator of the last name, which ensures that every enumerator has a name.
template <auto kLast, std::size_t n>
std::string_view name_in(decltype(kLast) reason, const std::string_view (&names)[n]) {
  static_assert(n == static_cast<std::size_t>(kLast) + 1);
  return names[static_cast<std::size_t>(reason)];
}

}  // namespace

std::string_view name_of(grid::BeltsFitReason reason) {
  return name_in<grid::BeltsFitReason::tape_contradicts>(
      reason, {"too_few_points", "not_determined", "no_frame", "hole_without_anchors",
               "too_many_distances", "tape_contradicts"});
}

std::string_view name_of(grid::CheckReason reason) {
  return name_in<grid::CheckReason::nowhere>(
      reason,
      {"too_many_readings", "no_machine", "no_lengths", "unreachable", "no_noise", "nowhere"});
}

std::string_view name_of(grid::FitReason reason) {
  return name_in<grid::FitReason::not_converged>(
      reason, {"no_machine", "not_a_grid", "no_lengths", "point_unreachable", "rank_deficient",
               "impossible_readings", "not_converged"});
}

std::string_view name_of(grid::PlanReason reason) {
  return name_in<grid::PlanReason::no_map>(
      reason, {"no_machine", "unreachable", "too_few_places", "no_map"});
}

std::string_view name_of(diagnosis::DiagnosisReason reason) {
  return name_in<diagnosis::DiagnosisReason::contradictory_settings>(
      reason, {"no_machine", "no_lengths", "too_few_points", "no_noise", "point_unreachable",
               "contradictory_settings"});
}

}  // namespace chaintrue::cli

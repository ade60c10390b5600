// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/slips.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/input_checks/point_slips.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Distances that are all longer, or all shorter, by the same.
std::optional<DiagnosisFailure> suspected_hook(const MeasuredHoles& set) {
  const auto hook_mm = suspected_hook_offset_mm(set);
  if (!hook_mm) return std::nullopt;
  return DiagnosisFailure{
      DiagnosisFailure::Reason::contradictory_settings,
      fmt::format(
          "all distances are about {:.0f} mm {} than commanded, long ones and short ones "
          "alike: it looks as if the tape's hook offset, stated as {:g} mm, is {:.0f} mm. "
          "State it (\"tape\": {{\"hook_offset_mm\": {:.0f}}}) before causes are looked for",
          std::abs(*hook_mm),
          *hook_mm > 0.0 ? "longer" : "shorter",
          set.tape.hook_offset_mm,
          set.tape.hook_offset_mm + *hook_mm,
          set.tape.hook_offset_mm + *hook_mm)};
}

}  // namespace

std::optional<DiagnosisFailure> suspected_slip(const Measured& measured) {
  for (std::size_t k = 1; k < measured.files().size(); ++k) {
    for (std::size_t before = 0; before < k; ++before) {
      const MeasuredFile& first = measured.files()[before];
      const MeasuredFile& other = measured.files()[k];
      if (!same_readings(first, other)) continue;
      return DiagnosisFailure{
          DiagnosisFailure::Reason::contradictory_settings,
          fmt::format("{} holds the same readings as {}, to the last digit: a copy says nothing more. Leave it out",
                      other.name,
                      first.name)};
    }
  }
  for (const MeasuredHoles* set : measured.holes()) {
    if (auto hook = suspected_hook(*set)) return hook;
  }
  for (const MeasuredGrid* grid : measured.grids()) {
    const auto whole = input_checks::point_slips(*grid).whole;
    if (!whole || whole->is_doubtful) continue;
    return DiagnosisFailure{DiagnosisFailure::Reason::contradictory_settings,
                            fmt::format("{}, expected {}", whole->found, whole->expected)};
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid::diagnosis

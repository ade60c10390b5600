// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/gross_errors.hpp"

#include <fmt/format.h>

#include <cmath>

#include "grid/input_checks/point_checks.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Distances that are all longer, or all shorter, by the same.
std::optional<DiagnosisFailure> suspected_tape_zero(const MeasuredHoles& set) {
  const auto tape_zero_mm = suspected_tape_zero_offset_mm(set);
  if (!tape_zero_mm) return std::nullopt;
  return DiagnosisFailure{
      DiagnosisFailure::Reason::contradictory_settings,
      fmt::format(
          "all distances are about {:.0f} mm {} than commanded, long ones and short ones by the "
          "same: it looks as if the tape's hook offset, given as {:g} mm, is {:.0f} mm. Write it "
          "down (\"tape\": {{\"hook_offset_mm\": {:.0f}}}) before causes are looked for",
          std::abs(*tape_zero_mm),
          *tape_zero_mm > 0.0 ? "longer" : "shorter",
          set.tape.tape_zero_offset_mm,
          set.tape.tape_zero_offset_mm + *tape_zero_mm,
          set.tape.tape_zero_offset_mm + *tape_zero_mm)};
}

}  // namespace

std::optional<DiagnosisFailure> suspected_slip(const Measured& measured) {
  for (std::size_t k = 1; k < measured.files().size(); ++k) {
    for (std::size_t before = 0; before < k; ++before) {
      const MeasuredFile& first = measured.files()[before];
      const MeasuredFile& other = measured.files()[k];
      if (!same_readings(first, other)) continue;
      return DiagnosisFailure{DiagnosisFailure::Reason::contradictory_settings,
                              fmt::format("{} holds the same readings as {}, to the last digit: a "
                                          "copy adds nothing. Leave it out",
                                          other.name,
                                          first.name)};
    }
  }
  for (const MeasuredHoles* set : measured.holes()) {
    if (auto tape_zero = suspected_tape_zero(*set)) return tape_zero;
  }
  for (const MeasuredGrid* grid : measured.grids()) {
    const auto whole = input_checks::check_points(*grid).whole;
    // A turned sheet looks like axes that are not square and a law beside it.
    if (!whole || (whole->is_doubtful && whole->kind != ProblemKind::axes)) continue;
    return DiagnosisFailure{DiagnosisFailure::Reason::contradictory_settings, whole->sentence()};
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/slips.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "model/reading_model.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kFarOffMm = 50.0;  // ten times what settings and effects do together
constexpr double kMends = 0.2;      // of the misfit may be left

using Read = NumberedPlace (*)(NumberedPlace);

struct Slip {
  std::string_view words;
  Read mended;
};

constexpr double kMmPerInch = 25.4;

constexpr Slip kSlips[] = {
    {"the two chains' columns look exchanged",
     [](NumberedPlace p) {
       std::swap(p.lengths.left_mm, p.lengths.right_mm);
       return p;
     }},
    {"the x axis looks turned round; positive x is to the right",
     [](NumberedPlace p) {
       p.mark.x_mm = -p.mark.x_mm;
       return p;
     }},
    {"the y axis looks turned round; positive y is up the sheet",
     [](NumberedPlace p) {
       p.mark.y_mm = -p.mark.y_mm;
       return p;
     }},
    {"the lengths look like inches",
     [](NumberedPlace p) {
       p.lengths.left_mm *= kMmPerInch;
       p.lengths.right_mm *= kMmPerInch;
       return p;
     }},
    {"the marks look like inches",
     [](NumberedPlace p) {
       p.mark.x_mm *= kMmPerInch;
       p.mark.y_mm *= kMmPerInch;
       return p;
     }},
};

/// Root mean square of what the stated machine leaves; nothing where it cannot reach a point.
std::optional<double> misfit_mm(const ObservationSet& session, Read read) {
  const model::ReadingModel model(session.stated);
  double sum = 0.0;
  double count = 0.0;
  for (const NumberedPlace& place : session.places) {
    if (!session.parts[place.part].reads_chains()) continue;
    const NumberedPlace p = read(place);
    const auto reading = model.at(model::identity_placement(p.mark));
    if (!reading) return std::nullopt;
    sum += std::pow(p.lengths.left_mm - reading->lengths.left_mm, 2) +
           std::pow(p.lengths.right_mm - reading->lengths.right_mm, 2);
    count += 1.0;
  }
  return std::sqrt(sum / count);
}

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

std::optional<DiagnosisFailure> suspected_slip(const ObservationSet& session) {
  for (const auto& [part, tape] : parts_of<observation::TapeDistances>(session)) {
    if (auto hook = suspected_hook(tape->set())) return hook;
  }
  if (!session.reads_chains()) return std::nullopt;
  const auto plain = misfit_mm(session, [](NumberedPlace p) { return p; });
  if (plain && *plain < kFarOffMm) return std::nullopt;
  for (const Slip& slip : kSlips) {
    const auto mended = misfit_mm(session, slip.mended);
    if (!mended || (plain && *mended > kMends * *plain) || (!plain && *mended > kFarOffMm))
      continue;
    return DiagnosisFailure{
        DiagnosisFailure::Reason::contradictory_settings,
        fmt::format("the points are far off what the stated machine says, and {}: with that mended "
                    "they are within {:.0f} mm",
                    slip.words,
                    std::ceil(*mended))};
  }
  return std::nullopt;
}

}  // namespace chaintrue::grid::diagnosis

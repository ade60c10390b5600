// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/naming.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "grid/diagnosis/order_search.hpp"
#include "grid/diagnosis/stability.hpp"
#include "grid/failed.hpp"
#include "grid/input_checks/point_checks.hpp"
#include "grid/parallel.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Distances that are all too long, or all too short, by the same amount.
std::optional<std::string> suspected_tape_zero(const MeasuredHoles& set) {
  const auto tape_zero_mm = suspected_tape_zero_offset_mm(set);
  if (!tape_zero_mm) return std::nullopt;
  const double entered_mm = set.tape.tape_zero_offset_mm;
  return fmt::format(
      "all distances are about {:.0f} mm {} than commanded, whatever their length: the tape's "
      "hook offset, entered as {:g} mm, is probably {:.0f} mm. Correct it (\"tape\": "
      "{{\"hook_offset_mm\": {:.0f}}}), then diagnose again",
      std::abs(*tape_zero_mm), *tape_zero_mm > 0.0 ? "longer" : "shorter", entered_mm,
      entered_mm + *tape_zero_mm, entered_mm + *tape_zero_mm);
}

/// Slips of a whole file, which resemble no effect, in data that no file reader has checked.
std::optional<std::string> suspected_slip(const Measured& measured) {
  for (std::size_t k = 1; k < measured.files().size(); ++k) {
    for (const std::size_t before : each_below(k)) {
      const MeasuredFile& first = measured.files()[before];
      const MeasuredFile& other = measured.files()[k];
      if (!same_readings(first, other)) continue;
      return fmt::format(
          "{} has the same readings as {}, to the last digit, and a copy adds nothing. Leave it "
          "out",
          other.name, first.name);
    }
  }
  for (const MeasuredHoles* set : measured.holes()) {
    if (auto tape_zero = suspected_tape_zero(*set)) return tape_zero;
  }
  for (const MeasuredGrid* grid : measured.grids()) {
    const auto whole = input_checks::check_points(*grid).whole;
    // A rotated sheet looks like axes that are not square, plus a law.
    if (whole && (!whole->is_doubtful || whole->kind == ProblemKind::axes))
      return whole->sentence();
  }
  return std::nullopt;
}

constexpr int kNamingSteps = 4;  // of a diagnosis (diagnose.cpp)
constexpr WorkStep kComparing{"the causes against each other", 1, kNamingSteps};
constexpr WorkStep kLeavingOut{"the name without each reading", 2, kNamingSteps};

tl::expected<Analysis, DiagnosisFailure> analysed_in(const VisitingOrderFound& order,
                                                     const Measured& measured,
                                                     DiagnosisOptions options) {
  options.order_assumed = true;
  options.orders_tried = as_int(line_by_line_orders().size());
  auto session = diagnosis::observations_of(visited_in(measured, order.order).value());
  if (!session) return failed(session);
  return analyse(*std::move(session), options);
}

/// An analysis, and the order of visits that it found and uses.
struct AnalysedInOrder {
  Analysis analysis;
  std::optional<VisitingOrderFound> order;
};

tl::expected<AnalysedInOrder, DiagnosisFailure> analysed_in_order(const Measured& measured,
                                                                  ObservationSet session,
                                                                  const DiagnosisOptions& options) {
  const bool has_several = measured.files().size() > 1;
  std::optional<VisitingOrderFound> order;
  if (has_several && (order = find_order_of_first(measured, options))) {
    if (auto ordered = analysed_in(*order, measured, options))
      return AnalysedInOrder{*std::move(ordered), order};
  }
  auto analysis = analyse(std::move(session), options);
  if (!analysis) return failed(analysis);
  if (!has_several && (order = find_visiting_order(measured, *analysis))) {
    if (auto ordered = analysed_in(*order, measured, options))
      return AnalysedInOrder{*std::move(ordered), order};
  }
  return AnalysedInOrder{*std::move(analysis), std::nullopt};
}

}  // namespace

tl::expected<Naming, DiagnosisFailure> name_causes(const Measured& measured,
                                                   const DiagnosisOptions& options, NamingFor use) {
  auto session = observations_of(measured);
  if (!session) return failed(session);
  if (const auto slip = suspected_slip(measured))
    return failed(DiagnosisFailure::Reason::contradictory_settings, *slip);
  tell(options.progress, kComparing);
  auto analysed = analysed_in_order(measured, *std::move(session), options);
  if (!analysed) return failed(analysed);
  Naming naming{std::move(analysed->analysis), analysed->order, {}, {}, {}, {}};
  Analysis& a = naming.analysis;
  if (use == NamingFor::causes && a.decision.listed.empty()) return naming;
  naming.laws = laws_found(a);
  tell(options.progress, kLeavingOut);
  if (options.stability) naming.stability = examine_stability(a);
  naming.refusal = refuse_name_of_one_reading(naming.stability, a);
  if (naming.refusal) naming.stability.reset();
  const std::size_t named = a.decision.listed.size();
  naming.causes_given_law = name_given_law(naming.laws, calibrated_rules(), a);
  if (naming.stability && a.decision.listed.size() != named)
    naming.stability = examine_stability(a);
  return naming;
}

NamingAndPlainFit name_and_fit(const Measured& measured, const DiagnosisOptions& options,
                               NamingFor use, JointFitOptions fit_options) {
  // One of the two reports progress.
  fit_options.progress = {};
  std::optional<tl::expected<Naming, DiagnosisFailure>> naming;
  std::optional<tl::expected<JointFit, FitFailure>> plain;
  for_each_index(2, [&](std::size_t k) {
    if (k == 0)
      naming = name_causes(measured, options, use);
    else
      plain = joint_fit(measured, fit_options);
  });
  return {*std::move(naming), *std::move(plain)};
}

}  // namespace chaintrue::grid::diagnosis

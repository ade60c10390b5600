// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/naming.hpp"

#include <utility>

#include "grid/diagnosis/causes_given_law.hpp"
#include "grid/diagnosis/gross_errors.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/diagnosis/single_reading.hpp"
#include "grid/diagnosis/stability.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kNamingSteps = 4;  // of a diagnosis (diagnose.cpp)
constexpr WorkStep kComparing{"the causes against each other", 1, kNamingSteps};
constexpr WorkStep kLeavingOut{"the name without each reading", 2, kNamingSteps};

/// What is named once a claimed law is known; what is not any more is no name.
std::vector<CauseGivenLaw> name_given_law(const LawsFound& laws, Analysis& a) {
  const auto rows = rows_of_claimed_law(a, laws);
  if (!rows) return {};
  const Analysis given = analyse_without(a, *rows);
  std::vector<CauseGivenLaw> changed = causes_that_change(a, given);
  take_names_back(given, a);
  return changed;
}

tl::expected<Analysis, DiagnosisFailure> analysed_in(const VisitingOrderFound& order,
                                                     const Measured& measured,
                                                     DiagnosisOptions options) {
  options.order_assumed = true;
  options.orders_tried = static_cast<int>(line_by_line_orders().size());
  auto session = diagnosis::observations_of(visited_in(measured, order.order).value());
  if (!session) return tl::unexpected(session.error());
  return analyse(*std::move(session), options);
}

/// An analysis, and the order of visits that it found and goes by.
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
  if (!analysis) return tl::unexpected(analysis.error());
  if (!has_several && (order = find_visiting_order(measured, *analysis))) {
    if (auto ordered = analysed_in(*order, measured, options))
      return AnalysedInOrder{*std::move(ordered), order};
  }
  return AnalysedInOrder{*std::move(analysis), std::nullopt};
}

}  // namespace

tl::expected<Naming, DiagnosisFailure> name_causes(const Measured& measured,
                                                   const DiagnosisOptions& options,
                                                   NamingFor use) {
  auto session = observations_of(measured);
  if (!session) return tl::unexpected(session.error());
  if (const auto slip = suspected_slip(measured)) return tl::unexpected(*slip);
  tell(options.progress, kComparing);
  auto analysed = analysed_in_order(measured, *std::move(session), options);
  if (!analysed) return tl::unexpected(analysed.error());
  Naming naming{std::move(analysed->analysis), analysed->order, {}, {}, {}, {}};
  Analysis& a = naming.analysis;
  if (use == NamingFor::causes && a.decision.listed.empty()) return naming;
  naming.laws = laws_found(a);
  tell(options.progress, kLeavingOut);
  if (options.stability) naming.stability = examine_stability(a);
  naming.refusal = refuse_name_of_one_reading(naming.stability, a);
  if (naming.refusal) naming.stability.reset();
  const std::size_t named = a.decision.listed.size();
  naming.causes_given_law = name_given_law(naming.laws, a);
  if (naming.stability && a.decision.listed.size() != named) naming.stability = examine_stability(a);
  return naming;
}

}  // namespace chaintrue::grid::diagnosis

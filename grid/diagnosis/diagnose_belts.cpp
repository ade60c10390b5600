// SPDX-License-Identifier: GPL-3.0-or-later

#include "grid/belts/belts_error.hpp"
#include "grid/diagnosis/belts_report.hpp"
#include "grid/diagnosis/causes_given_law.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

DiagnosisFailure failure_of(const BeltsFitFailure& failure) {
  using Of = BeltsFitFailure::Reason;
  using Reason = DiagnosisFailure::Reason;
  return {failure.reason == Of::too_few_points || failure.reason == Of::not_determined
              ? Reason::too_few_points
              : Reason::contradictory_settings,
          failure.sentence()};
}

}  // namespace

tl::expected<Diagnosis, DiagnosisFailure> diagnose(const MeasuredBelts& belts,
                                                   const DiagnosisOptions& options,
                                                   const PointIndices& indices) {
  auto analysed = analyse(belts, options);
  if (!analysed) return tl::unexpected(failure_of(analysed.error()));
  BeltsAnalysis& a = *analysed;
  // Belongs to the decision before the verdict.
  const auto fit = fit_with_causes(a);
  const auto error = fit ? error_of_belts(*fit) : std::nullopt;
  const BeltRules rules(a);
  judge(rules, a);
  const LawsFound found = laws_found(analysis_of_laws(a));
  std::vector<CauseGivenLaw> given_law = name_given_law(found, rules, a);
  Diagnosis d;
  if (error) d.tool_today = error->today;
  d.observations = Observations::belts;
  d.grid_name = belts.name;
  take_findings(a, d);
  take_belts_findings(a, d);
  take_laws(found.laws, d);
  for (Law& law : d.unexplained->laws) {
    for (LawResidual& point : law.points) point.index = index_in_file(indices, point.index);
  }
  d.unexplained->causes_given_law = std::move(given_law);
  d.bed_parts = bed_part_findings(a);
  for (Outlier& bad : d.outliers) bad.index = index_in_file(indices, bad.index);
  const BeltsNext next = options.next_measurements ? next_measurements(a, indices) : BeltsNext{};
  d.belts->second_pass = next.second_pass;
  if (options.next_measurements) d.next_measurements = measurements_of(a, next, indices);
  put_into_words(a, next, d);
  for (std::string& note : parts_in_words(d)) d.notes.push_back(std::move(note));
  return d;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later

#include "grid/belts/belts_error.hpp"
#include "grid/diagnosis/belts_report.hpp"
#include "grid/diagnosis/causes_given_law.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kBeltWorkSteps = 2;
constexpr WorkStep kFitting{"anchors alone", 1, kBeltWorkSteps};
constexpr WorkStep kComparingBelts{"the causes against each other", 2, kBeltWorkSteps};

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
  tell(options.progress, kFitting);
  const auto alone = fit_belts(belts);
  if (!alone) return tl::unexpected(failure_of(alone.error()));
  tell(options.progress, kComparingBelts);
  auto analysed = analyse(belts, options);
  if (!analysed) return tl::unexpected(analysed.error());
  BeltsAnalysis& a = *analysed;
  // Belongs to the decision before the verdict.
  const auto fit = fit_with_causes(a, belts, *alone);
  const auto error = fit ? error_of_belts(*fit) : std::nullopt;
  const BeltRules rules(a);
  judge(rules, a);
  const LawsFound found = laws_found(analysis_of_laws(a));
  std::vector<CauseGivenLaw> given_law = name_given_law(found, rules, a);
  const FitGivenCauses given = explained(a);
  Diagnosis d;
  if (error) d.tool_today = error->today;
  d.observations = Observations::belts;
  d.grid_name = belts.name;
  take_findings(a, d);
  d.unexplained = unexplained(a);
  std::vector<Law> laws = found.laws;
  for (Law& law : laws) {
    for (LawResidual& point : law.points) point.index = index_in_file(indices, point.index);
  }
  take_laws(std::move(laws), d);
  d.unexplained->causes_given_law = std::move(given_law);
  d.bed_parts = bed_part_findings(a);
  d.outliers = bad_belts(given);
  for (Outlier& bad : d.outliers) bad.index = index_in_file(indices, bad.index);
  d.belts = belts_findings(a, given, belts, *alone);
  const BeltsNext next = options.next_measurements ? next_measurements(a, indices) : BeltsNext{};
  d.belts->second_pass = next.second_pass;
  if (options.next_measurements)
    d.next_measurements = measurements_of(next, belts, *alone, a.decision, indices);
  put_belts_into_words(belts, *alone, next, d);
  for (std::string& note : parts_in_words(d)) d.notes.push_back(std::move(note));
  return d;
}

}  // namespace chaintrue::grid::diagnosis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/diagnosis.hpp"

#include <cmath>
#include <cstdint>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/gain.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/diagnosis/normal_plot.hpp"
#include "grid/diagnosis/single_reading.hpp"
#include "grid/diagnosis/slips.hpp"
#include "grid/diagnosis/stability.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::named:
      return "named";
    case Verdict::named_set:
      return "named_set";
    case Verdict::several_causes:
      return "several_causes";
    case Verdict::model_discrepancy:
      return "unknown_pattern";
    case Verdict::noise_larger_than_stated:
      return "noise_larger_than_stated";
    case Verdict::outliers:
      return "bad_points";
    case Verdict::nothing_found:
      break;
  }
  return "nothing_found";
}

std::string_view name(Observations observations) {
  return observations == Observations::points ? "points" : "distances";
}

namespace {

tl::expected<Diagnosis, DiagnosisFailure> diagnose(
    const tl::expected<Session, DiagnosisFailure>& session, const DiagnosisOptions& options) {
  if (!session) return tl::unexpected(session.error());
  if (const auto slip = suspected_slip(*session)) return tl::unexpected(*slip);
  auto analysis = analyse(*session, options);
  if (!analysis) return tl::unexpected(analysis.error());
  Diagnosis d;
  if (options.stability) d.stability = examine_stability(*session, *analysis, options);
  if (auto refused = refuse_name_of_one_reading(*session, options, d.stability, *analysis)) {
    d.notes.push_back(std::move(*refused));
    d.stability.reset();
  }
  d.observations = session->distances ? Observations::distances : Observations::points;
  d.seed = options.seed;
  d.verdict = analysis->decision.verdict;
  d.noise_factor = std::sqrt(analysis->estimate.noise_square);
  d.family_wise_p = analysis->family_wise_p;
  d.causes = causes_found(*session, *analysis, options.order_assumed);
  d.hypotheses = hypotheses(*analysis);
  d.terms = terms(*session, options, *analysis);
  d.not_testable = analysis->candidates.not_testable;
  d.bounds = bounds(*session, *analysis, d.not_testable);
  d.settings = settings_found(*session, *analysis);
  d.outliers = outliers_found(*session, *analysis);
  d.separations = separations(*analysis);
  d.points = pictures(*session, *analysis);
  d.holes = hole_pictures(*session, *analysis);
  d.distances = distance_pictures(*session, *analysis);
  d.left_over = left_over(*session, *analysis, options.seed);
  d.normal_plot = normal_plot(*session, *analysis, options.seed);
  if (options.gain) d.gain = measure_gain(*session, *analysis, options);
  extend(*session, *analysis, options.accept_class, d);
  if (options.next_measurements) d.next_measurements = next_measurements(*session, *analysis);
  put_into_words(*session, d);
  return d;
}

}  // namespace

tl::expected<Diagnosis, DiagnosisFailure> diagnose(const MeasuredGrid& grid,
                                                   const DiagnosisOptions& options) {
  return diagnose(make_session(grid), options);
}

tl::expected<Diagnosis, DiagnosisFailure> diagnose(const MeasuredHoles& set,
                                                   const DiagnosisOptions& options) {
  auto found = diagnose(make_session(set), options);
  if (!found) return found;
  found->grid_name = set.name;
  if (set.machine->controller.kind == model::ControllerKind::ideal) {
    found->notes.emplace_back(
        "The controller is stated as ideal: it believes the machine that its file states. These "
        "holes were cut believing the machine as it is stated now; fit them on that, and use the "
        "extended machine for what is cut with it.");
  }
  found->stated_tape = StatedTape{set.tape.sigma_mm, set.hole_sigma_mm, set.noise_dof};
  return found;
}

}  // namespace chaintrue::grid::diagnosis

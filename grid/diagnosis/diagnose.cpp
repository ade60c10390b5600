// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "grid/belts/belts_error.hpp"
#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/held_out_improvement.hpp"
#include "grid/diagnosis/law_model.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/naming.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/failed.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/parallel.hpp"
#include "grid/plotter/drawing_fit.hpp"
#include "interp/eigen.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

std::string_view name(Verdict verdict) {
  return word_of(verdict, {"named", "named_set", "several_causes", "unknown_pattern",
                           "noise_larger_than_stated", "bad_points", "nothing_found"});
}

std::string_view name(Observations observations) {
  return word_of(observations, {"points", "distances", "readings", "belts", "measures"});
}

namespace {

using Says = DeclaredAnswer::Says;

template <class T>
const T* find_of(const std::vector<T>& all, const CauseId& cause) {
  return find_where(all, having(&T::cause, cause));
}

/// The leading model without this cause.
RegressorSet others_than(const Analysis& a, const CauseId& cause) {
  RegressorSet others;
  for (const int k : a.decision.regressors) {
    if (regressor(a, k).cause != cause) others.push_back(k);
  }
  return others;
}

/// Whether the readings are more probable without it than with its values in the file.
bool is_refuted(const Analysis& a, const CauseId& cause) {
  const auto g = signature(a.session, a.state, a.system, {cause, nominal_values(*cause.effect)});
  if (!g) return false;
  const LawModel model(a, marginalised_system(a),
                       {others_than(a, cause), a.decision.best_discrepancy});
  const auto log_density = [](const LawModel::Downdated& rows) {
    return rows.without({}).log_density;
  };
  const double odds = kLawClaimed / (1.0 - kLawClaimed);
  return log_density(LawModel::Downdated(model)) - log_density({model, *g}) > std::log(odds);
}

Says said_of(const Analysis& a, const Diagnosis& found, const CauseId& cause, double probability) {
  if (find_of(found.causes, cause) != nullptr && probability >= kLawClaimed) return Says::confirmed;
  if (probability > 1.0 - kLawClaimed) return Says::open;
  const Bound* bound = find_of(found.bounds, cause);
  const double usual = std::abs(cause.effect->parameters.front().nominal);
  if ((bound != nullptr && bound->upper_95 < usual) || is_refuted(a, cause)) return Says::denied;
  return find_of(found.not_testable, cause) != nullptr ? Says::not_testable : Says::open;
}

/// An answer for each side of each declared effect, in the order of the machine's. `found` with its causes,
/// bounds and what is not testable.
std::vector<DeclaredAnswer> declared_answers(const Analysis& a, const Diagnosis& found) {
  std::vector<DeclaredAnswer> answers;
  const auto is_declared = [](const CauseId& cause) {
    return declaration_of(*cause.effect) != nullptr;
  };
  for (const CauseId& cause : a.candidates.testable) {
    if (!is_declared(cause)) continue;
    const double probability = probability_of(a, cause);
    answers.push_back({cause, said_of(a, found, cause, probability), probability});
  }
  for (const NotTestable& one : a.candidates.not_testable) {
    if (is_declared(one.cause)) answers.push_back({one.cause, Says::not_testable, 0.0});
  }
  return answers;
}

// Progress of a diagnosis; held_out_improvement.cpp reports its own.
constexpr int kWorkSteps = 4;
constexpr WorkStep kPlanning{"what to measure next", 4, kWorkSteps};

Observations kind_read(const ObservationSet& session) {
  if (!session.has_distances()) return Observations::points;
  return session.reads_chains() ? Observations::both : Observations::distances;
}

/// In the order of the observations: grids, then sets of holes.
std::vector<std::string> names_of_sessions(const Measured& measured) {
  std::vector<std::string> names;
  for (const bool grids : {true, false}) {
    for (const MeasuredFile& file : measured.files()) {
      if ((file.grid() != nullptr) == grids) names.push_back(file.name);
    }
  }
  return names;
}

/// Sessions whose chain zeros differ from those of the first.
void note_zeros(const std::vector<std::string>& names, const Analysis& a, Diagnosis& d) {
  for (std::size_t k = 0; k < names.size() && k < a.session.parts.size(); ++k) {
    std::array<estimation::SessionZero, 2> zeros;
    const ColumnSet& columns = a.session.parts[k].zero_columns;
    for (const auto z : each_index(columns)) {
      zeros[z] = {a.estimate.setting_change(columns[z]),
                  std::sqrt(a.estimate.covariance(columns[z], columns[z]))};
    }
    const std::string words = words_of(zeros);
    if (!words.empty())
      d.notes.push_back(fmt::format("{}: the chains' zeros differ from those in {}: {}.", names[k],
                                    names.front(), words));
  }
}

/// Notes on the stated noise and the files.
void state_input(const Measured& measured, Diagnosis& d) {
  d.grid_name = measured.name();
  for (const MeasuredGrid* grid : measured.grids()) {
    if (!d.stated_noise) d.stated_noise = grid->noise;
  }
  const auto holes = measured.holes();
  if (holes.empty()) return;
  const MeasuredHoles& set = *holes.front();
  if (set.machine && set.machine->controller.kind == model::ControllerKind::ideal) {
    d.notes.emplace_back(
        "The machine file has no controller of its own (kind ideal), so the holes were cut with "
        "the file as it is now. Fit them with that file, and use the extended machine only for "
        "what is cut with it.");
  }
  d.stated_tape = StatedTape{set.tape.sigma_mm, set.hole_sigma_mm, set.noise_dof};
}

/// The error today and the noise of the readings are those of the map that `fit` makes of them.
void take_from_map(const Measured& measured, const Naming& naming, JointFit plain,
                   const DiagnosisOptions& options, Diagnosis& d) {
  CausesFitOptions own;
  own.accept_class = options.accept_class;
  const CausesFit fit = fit_on_causes(measured, naming, std::move(plain), own,
                                      [&] { return naming_improves_the_map(d.improvement); });
  d.tool_today = error_in_use(fit.fit.map);
  if (d.improvement && d.observations == Observations::points)
    d.improvement->noise_floor_mm = noise_at_tool_mm(fit.fit.map);
}

/// A map cannot resolve less than the spacing of the marks, so a claimed law causes at least its
/// error at the marks. The part that the settings would absorb is not an error of the tool, so the
/// law causes at most the whole error there.
void count_law(Diagnosis& d) {
  const Law* law = claimed_law(d);
  if (!d.tool_today || law == nullptr || d.observations != Observations::points) return;
  const double most_mm = d.budget ? d.budget->uncalibrated_mm : d.tool_today->rms_mm;
  const double law_mm = std::min(law->rms_mm, most_mm);
  d.tool_today->rms_mm = std::max(d.tool_today->rms_mm, law_mm);
  d.tool_today->maximum_mm = std::max(d.tool_today->maximum_mm, law_mm);
}

}  // namespace

std::string_view name(DeclaredAnswer::Says says) {
  return word_of(says, {"confirmed", "denied", "open", "not_testable"});
}

tl::expected<Diagnosis, DiagnosisFailure> diagnose(const Measured& measured,
                                                   const DiagnosisOptions& options) {
  NamingAndPlainFit found =
      options.improvement
          ? name_and_fit(measured, options, NamingFor::report, {})
          : NamingAndPlainFit{
                name_causes(measured, options, NamingFor::report),
                tl::unexpected(FitFailure(FitReason::not_converged, "no map was asked for"))};
  if (!found.naming) return failed(found.naming);
  Naming& naming = *found.naming;
  const Analysis& a = naming.analysis;
  const LawsFound& laws = naming.laws;
  Diagnosis d;
  d.visiting_order = naming.order;
  d.observations = kind_read(a.session);
  d.stability = std::move(naming.stability);
  if (naming.refusal) d.notes.push_back(*std::move(naming.refusal));
  take_findings(a, d);
  const std::vector<std::string> sessions = names_of_sessions(measured);
  // Independent tasks: each fills its own fields. The slowest come first.
  const std::function<void()> work[] = {
      [&] {
        if (!options.improvement) return;
        d.improvement = measure_improvement(a);
        if (found.plain) take_from_map(measured, naming, *std::move(found.plain), options, d);
      },
      [&] {
        if (!options.next_measurements) return;
        d.next_measurements = next_measurements(a);
        if (d.next_measurements.empty()) d.next_measurements = next_for_laws(a, laws);
      },
      [&] {
        d.left_over = left_over(a);
        d.unexplained = unexplained(a);
        take_laws(laws.laws, d);
        d.unexplained->causes_given_law = std::move(naming.causes_given_law);
      },
      [&] { d.budget = error_budget(a); },
      [&] {
        d.settings = settings_found(a);
        d.outliers = outliers_found(a);
        d.points = point_pictures(a);
        d.holes = hole_pictures(a);
        d.distances = distance_pictures(a);
        d.bed_parts = bed_part_findings(a);
        d.sessions = session_findings(a, sessions);
      },
  };
  for_each_index(std::size(work), [&](std::size_t k) { work[k](); });
  d.declared = declared_answers(a, d);
  if (options.improvement) count_law(d);
  tell(options.progress, kPlanning);
  apply_causes(a, d);
  put_into_words(a, d);
  if (d.visiting_order) {
    const std::string whose = measured.files().size() > 1 ? measured.files().front().name : "";
    d.notes.insert(d.notes.begin(), in_words(*d.visiting_order, whose));
  }
  note_zeros(sessions, a, d);
  state_input(measured, d);
  return d;
}

namespace {

constexpr WorkStep kComparingDrawing{"the causes against each other", 1, 1};

/// Slips and bad input, as a fit refuses them. A drawing that no settings explain has a cause,
/// which the diagnosis looks for.
std::optional<DiagnosisFailure> refused(const TestDrawing& drawing) {
  using Reason = DiagnosisFailure::Reason;
  const auto fit = fit_drawing(drawing);
  if (fit) return std::nullopt;
  const DrawingReason why = fit.error().reason;
  if (why == DrawingReason::no_settings_fit || why == DrawingReason::not_converged)
    return std::nullopt;
  return DiagnosisFailure{why == DrawingReason::too_few ? Reason::too_few_points
                          : why == DrawingReason::cross_out_of_reach
                              ? Reason::point_unreachable
                              : Reason::contradictory_settings,
                          fit.error().sentence()};
}

std::vector<DrawnSetting> drawn_settings(const Analysis& a) {
  const auto parameters = a.session.mechanism->parameters();
  std::vector<DrawnSetting> settings;
  for (const auto k : each_index(parameters)) {
    const auto at = as_index(k);
    DrawnSetting own{std::string(parameters[k].name), a.session.stated_value(at),
                     a.system.setting(at) + a.estimate.setting_change(at),
                     std::sqrt(a.estimate.covariance(at, at))};
    own.off = std::abs(own.found - own.set) > kOffSigmas * own.sigma;
    settings.push_back(std::move(own));
  }
  return settings;
}

std::vector<DrawnValue> drawn_values(const Analysis& a, const TestDrawing& drawing) {
  const Flags& outliers = marginalised_system(a).outliers;
  std::vector<DrawnValue> values(drawing.measures.size());
  for (const auto u : each_index(a.session.units)) {
    const SystemUnit& unit = a.system.units[u];
    const std::size_t index = a.session.units[u].index;
    DrawnValue& own = values[index];
    own.name = words_of(drawing, index);
    own.measured_mm = drawing.measures[index].value_mm;
    own.explained_mm = own.measured_mm - unit.unwhitened(a.estimate.left)(0);
    own.rejected = outliers[u];
  }
  return values;
}

}  // namespace

tl::expected<Diagnosis, DiagnosisFailure> diagnose(const TestDrawing& drawing,
                                                   const DiagnosisOptions& options) {
  if (auto failure = refused(drawing)) return tl::unexpected(*std::move(failure));
  tell(options.progress, kComparingDrawing);
  auto readings = drawn_measures_of(drawing).value();
  ObservationSet session = estimation::observation_set(
      {}, {std::make_shared<const observation::DrawnMeasures>(std::move(readings))},
      make_plotter_mechanism(drawing.machine));
  session.fewest_units = kFewestMeasures;
  auto analysis = analyse(std::move(session), options);
  if (!analysis) return failed(analysis);
  const Analysis& a = *analysis;
  Diagnosis d;
  d.observations = Observations::drawing;
  d.grid_name = drawing.name;
  take_findings(a, d);
  d.outliers = outliers_found(a);
  d.drawing = DrawingFindings{drawing.machine.name, drawn_settings(a), drawn_values(a, drawing)};
  put_into_words(a, d);
  return d;
}

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

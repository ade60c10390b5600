// SPDX-License-Identifier: GPL-3.0-or-later

#include <cmath>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/plotter/drawing_fit.hpp"

namespace chaintrue::grid::diagnosis {
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
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto at = as_index(k);
    DrawnSetting own{std::string(parameters[k].name), a.session.stated_value(at),
                     a.system.setting(at) + a.estimate.setting_change(at),
                     std::sqrt(a.estimate.setting_covariance(at, at))};
    own.off = std::abs(own.found - own.set) > kOffSigmas * own.sigma;
    settings.push_back(std::move(own));
  }
  return settings;
}

std::vector<DrawnValue> drawn_values(const Analysis& a, const TestDrawing& drawing) {
  const Flags& outliers = marginalised_system(a).outliers;
  std::vector<DrawnValue> values(drawing.measures.size());
  for (std::size_t u = 0; u < a.session.units.size(); ++u) {
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
      model::make_plotter_mechanism(drawing.machine));
  session.fewest_units = kFewestMeasures;
  auto analysis = analyse(std::move(session), options);
  if (!analysis) return tl::unexpected(analysis.error());
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

}  // namespace chaintrue::grid::diagnosis

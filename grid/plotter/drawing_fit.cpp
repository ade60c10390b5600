// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/drawing_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "grid/containers.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/failed.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/plotter/drawing_slips.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

using observation::DrawnMeasure;
using observation::View;

// Above this the settings do not explain the drawing: a ruler errs by less than five times its
// stated sigma.
constexpr double kMostNoiseFactor = 5.0;
// Largest number of rejected measures: with more the rest is not reliable.
constexpr double kMostRejectedShare = 0.2;

/// In the order of the drawing's measures.
MatrixXd in_file_order(const observation::DrawnMeasures& readings, const MatrixXd& rows) {
  MatrixXd ordered(rows.rows(), rows.cols());
  for (const observation::Unit& unit : readings.units())
    ordered.row(as_index(unit.index)) = rows.row(unit.first_row);
  return ordered;
}

std::string sentence_of(const TestDrawing& drawing, std::size_t cross, std::string_view reason) {
  const DrawnCross& own = drawing.crosses.at(cross);
  return fmt::format("cross {} at ({:.1f}, {:.1f}) mm: {}", own.name, own.commanded.x_mm,
                     own.commanded.y_mm, reason);
}

tl::expected<estimation::Estimate, DrawingFailure> estimated(
    const PlotterMachine& machine,
    const std::shared_ptr<const observation::DrawnMeasures>& readings) {
  estimation::EstimationInput input;
  input.mechanism = make_plotter_mechanism(machine);
  input.observations = {readings};
  input.noise.knowledge = interp::NoiseKnowledge::unknown;
  input.noise_prior = interp::SmoothingPrior::none;
  input.surface = estimation::SurfaceUse::none;
  input.domain = {0.0, 1.0, 0.0, 1.0};  // for a surface; there is none
  auto found = estimation::estimate(input);
  if (!found) return failed(DrawingReason::not_converged, found.error().sentence());
  if (found->converged) return found.value();
  return failed(
      DrawingReason::not_converged,
      "the fit did not converge: no settings near those in the file explain this drawing. Check "
      "that the machine's kind, the spacing of its pins and the crosses belong to the drawing");
}

/// Smaller residuals do not show that the readings are more accurate than stated.
void raise_to_rounding(const TestDrawing& drawing, estimation::Estimate& estimate) {
  const double least = rounding_sigma_mm(mapped(drawing.measures, &DrawnMeasure::value_mm)) /
                       rms(mapped(drawing.measures, &DrawnMeasure::sigma_mm));
  if (!(estimate.noise_factor > 0.0) || estimate.noise_factor >= least) return;
  estimate.covariance *= std::pow(least / estimate.noise_factor, 2);
  estimate.noise_factor = least;
}

std::vector<PlotterSetting> settings_of(const estimation::Estimate& estimate) {
  const auto parameters = estimate.mechanism->parameters();
  std::vector<PlotterSetting> settings;
  for (const auto k : each_index(parameters)) {
    const auto at = as_index(k);
    PlotterSetting own{parameters[k].name, *parameters[k].stated, estimate.mechanism->values()[at],
                       std::sqrt(std::max(estimate.covariance(at, at), 0.0))};
    own.is_off = std::abs(own.found - own.stated) > kOffSigmas * own.sigma;
    settings.push_back(own);
  }
  return settings;
}

/// The measures of the next drawing with these settings typed in; empty if it cannot be drawn.
std::optional<VectorXd> next_drawing(const TestDrawing& drawing, const DrawingFit& fit) {
  std::vector<Vector2d> pens;
  for (const DrawnCross& cross : drawing.crosses) {
    const auto pen = pen_of_command(drawing.firmware, fit.to_set, *fit.mechanism, cross.commanded);
    if (!pen) return std::nullopt;
    pens.push_back(vector_of(*pen));
  }
  VectorXd values(std::ssize(drawing.measures));
  for (const auto i : each_index(drawing.measures)) {
    const DrawnMeasure& m = drawing.measures[i];
    values[as_index(i)] =
        observation::measure_row(m.kind, pens[m.from], pens[m.to], pens[m.middle]).value_mm;
  }
  return values;
}

}  // namespace

PlotterMachine typed_in(model::PlotterFirmware firmware, PlotterMachine found) {
  using model::PlotterFirmware;
  if (firmware == PlotterFirmware::fluidnc) return found;
  const auto shared = [](ChainLengths own) {
    const double mean = 0.5 * (own.left_mm + own.right_mm);
    return ChainLengths{mean, mean};
  };
  found.pin_rise_mm = 0.0;
  if (firmware == PlotterFirmware::marlin) return found;
  found.scale_mm_per_m = shared(found.scale_mm_per_m);
  if (firmware == PlotterFirmware::polargraph) return found;
  found.pin_spacing_mm = std::round(found.pin_spacing_mm);
  found.zero_mm = shared(found.zero_mm);
  return found;
}

tl::expected<ToolPosition, model::MechanismFailure> pen_of_command(
    model::PlotterFirmware firmware, const PlotterMachine& set,
    const model::PlotterMechanism& found, BedPoint command) {
  const auto lengths = paid_out(firmware, set, command);
  if (!lengths) return tl::unexpected(mechanism_failure(lengths.error()));
  return found.locate_by_first(*lengths);
}

tl::expected<DrawingFit, DrawingFailure> fit_drawing(const TestDrawing& drawing) {
  if (drawing.measures.size() < kFewestMeasures) {
    return failed(
        DrawingReason::too_few,
        fmt::format(
            "{} measures; at least {} of the 24 on the sheet are needed to check the result",
            drawing.measures.size(), kFewestMeasures));
  }
  auto made = drawn_measures_of(drawing);
  if (!made) {
    return failed(DrawingReason::cross_out_of_reach,
                  sentence_of(drawing, made.error().place, made.error().sentence()));
  }
  const auto readings = std::make_shared<const observation::DrawnMeasures>(std::move(*made));
  const auto machine = make_plotter_mechanism(drawing.machine);
  const auto as_set = readings->linearise(View(machine), {.parameters = true});
  if (!as_set) {
    return failed(DrawingReason::cross_out_of_reach,
                  sentence_of(drawing, as_set.error().place, as_set.error().sentence()));
  }
  if (auto slip = slip_of_drawing(drawing, in_file_order(*readings, as_set->predicted),
                                  in_file_order(*readings, as_set->by_setting), *machine))
    return tl::unexpected(std::move(*slip));
  auto estimate = estimated(drawing.machine, readings);
  if (!estimate) return failed(estimate);
  raise_to_rounding(drawing, *estimate);

  const VectorXd found = in_file_order(*readings, estimate->observations.front().predicted);
  Flags rejected(drawing.measures.size(), false);
  for (const estimation::UnitEstimate& unit : estimate->units)
    rejected[readings->units()[unit.unit].index] = unit.is_rejected();
  if (auto slip = exchanged_rows(drawing, found, rejected)) return tl::unexpected(std::move(*slip));
  const auto bad = count_equal(rejected, true);
  if (estimate->noise_factor > kMostNoiseFactor ||
      as_double(bad) > kMostRejectedShare * as_double(rejected.size())) {
    return failed(
        DrawingReason::no_settings_fit,
        fmt::format(
            "no settings explain this drawing: {} of {} measures do not fit the rest, which "
            "scatter {:.1f} times as much as a ruler. Measure the worst again, then draw the page "
            "a second time; a machine that slips draws it differently",
            bad, rejected.size(), estimate->noise_factor));
  }

  DrawingFit fit;
  fit.mechanism = std::dynamic_pointer_cast<const model::PlotterMechanism>(estimate->mechanism);
  fit.settings = settings_of(*estimate);
  const auto count = as_index(fit.settings.size());
  fit.covariance = estimate->covariance.topLeftCorner(count, count);
  fit.noise_factor = estimate->noise_factor;
  fit.to_set = typed_in(drawing.firmware, fit.mechanism->machine());
  const auto after = next_drawing(drawing, fit);
  if (!after) {
    return failed(DrawingReason::not_converged,
                  "the page cannot be drawn with the fitted settings");
  }
  for (const auto i : each_index(drawing.measures)) {
    const auto row = as_index(i);
    fit.measures.push_back({drawing.measures[i].value_mm, found[row], (*after)[row], rejected[i]});
  }
  return fit;
}

}  // namespace chaintrue::grid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::CauseId;
using diagnosis::DrawingFindings;
using diagnosis::DrawnSetting;
using diagnosis::DrawnValue;

auto drawn_setting_record() {
  RECORD(DrawnSetting, "a setting of a plotter")
  REQUIRED(name, "Name of the parameter, with its unit.")
  REQUIRED(set, "Value in the controller.", kAnyNumber)
  REQUIRED(found, "Value estimated from the drawing together with the named causes.", kAnyNumber)
  REQUIRED(sigma, "Uncertainty of that, 1 sigma.", kNotNegative)
  REQUIRED(off, "True if the two differ by more than three sigmas.");
}

auto drawn_value_record() {
  RECORD(DrawnValue, "a measure of a drawing")
  REQUIRED(name, "The length or the bow, by its crosses.")
  REQUIRED(measured_mm, "The reading.", kAnyNumber)
  REQUIRED(explained_mm,
           "The value predicted by the estimated settings and the named causes.",
           kAnyNumber)
  REQUIRED(rejected, "True if it contradicts the others and was left out.");
}

void take_cause_of_cords(CauseId& cause) {
  for (const model::effects::Effect* own : model::plotter::plotter_effects()) {
    if (cause.effect != nullptr && cause.effect->id == own->id) cause.effect = own;
  }
}

}  // namespace

Record<DrawingFindings> drawing_findings_record() {
  RECORD(DrawingFindings, "results for a drawing")
  REQUIRED(plotter, "Name of the plotter.")
  REQUIRED(settings, "All settings of the controller.", drawn_setting_record())
  REQUIRED(measures, "The measures of the drawing, in order.", drawn_value_record());
}

void take_causes_of_cords(diagnosis::Diagnosis& d) {
  for (diagnosis::Cause& own : d.causes) {
    take_cause_of_cords(own.cause);
    for (diagnosis::SameCause& other : own.same_as) take_cause_of_cords(other.cause);
    if (own.rival) take_cause_of_cords(*own.rival);
  }
  for (auto& own : d.not_testable) take_cause_of_cords(own.cause);
  for (auto& own : d.bounds) take_cause_of_cords(own.cause);
  for (auto& own : d.declared) take_cause_of_cords(own.cause);
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::DrawingFindings;

auto drawn_setting_record() {
  RECORD(diagnosis::DrawnSetting, "a setting of a plotter")
  REQUIRED(name, "Name of the parameter, with its unit.")
  REQUIRED(set, "Value in the controller.", kAnyNumber)
  REQUIRED(found, "Value estimated from the drawing together with the named causes.", kAnyNumber)
  REQUIRED(sigma, "Uncertainty of that, 1 sigma.", kNotNegative)
  REQUIRED(off, "True if the two differ by more than three sigmas.");
}

auto drawn_value_record() {
  RECORD(diagnosis::DrawnValue, "a measure of a drawing")
  REQUIRED(name, "The length or the bow, by its crosses.")
  REQUIRED(measured_mm, "The reading.", kAnyNumber)
  REQUIRED(explained_mm,
           "The value predicted by the estimated settings and the named causes.",
           kAnyNumber)
  REQUIRED(rejected, "True if it contradicts the others and was left out.");
}

}  // namespace

Record<DrawingFindings> drawing_findings_record() {
  RECORD(DrawingFindings, "results for a drawing")
  REQUIRED(plotter, "Name of the plotter.")
  REQUIRED(settings, "All settings of the controller.", drawn_setting_record())
  REQUIRED(measures, "The measures of the drawing, in order.", drawn_value_record());
}

}  // namespace chaintrue::grid::files

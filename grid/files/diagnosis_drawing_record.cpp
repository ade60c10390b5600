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
  return Record<DrawnSetting>("a setting of a plotter")
      .required("name", "Name of the parameter, with its unit.", &DrawnSetting::name)
      .required("set", "Value in the controller.", &DrawnSetting::set, kAnyNumber)
      .required("found",
                "Value estimated from the drawing together with the named causes.",
                &DrawnSetting::found,
                kAnyNumber)
      .required("sigma", "Uncertainty of that, 1 sigma.", &DrawnSetting::sigma, kNotNegative)
      .required("off", "True if the two differ by more than three sigmas.", &DrawnSetting::off);
}

auto drawn_value_record() {
  return Record<DrawnValue>("a measure of a drawing")
      .required("name", "The length or the bow, by its crosses.", &DrawnValue::name)
      .required("measured_mm", "The reading.", &DrawnValue::measured_mm, kAnyNumber)
      .required("explained_mm",
                "The value predicted by the estimated settings and the named causes.",
                &DrawnValue::explained_mm,
                kAnyNumber)
      .required(
          "rejected", "True if it contradicts the others and was left out.", &DrawnValue::rejected);
}

void take_cause_of_cords(CauseId& cause) {
  for (const model::effects::Effect* own : model::plotter::plotter_effects()) {
    if (cause.effect != nullptr && cause.effect->id == own->id) cause.effect = own;
  }
}

}  // namespace

Record<DrawingFindings> drawing_findings_record() {
  return Record<DrawingFindings>("results for a drawing")
      .required("plotter", "Name of the plotter.", &DrawingFindings::plotter)
      .required("settings",
                "All settings of the controller.",
                &DrawingFindings::settings,
                drawn_setting_record())
      .required("measures",
                "The measures of the drawing, in order.",
                &DrawingFindings::measures,
                drawn_value_record());
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

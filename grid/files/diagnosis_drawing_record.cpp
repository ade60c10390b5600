// SPDX-License-Identifier: GPL-3.0-or-later
// The results from a test drawing in a chaintrue_diagnosis file.
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"
#include "model/plotter/effects/plotter_effect.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::CauseId;
using diagnosis::DrawingFindings;
using diagnosis::DrawnSetting;
using diagnosis::DrawnValue;

const Record<DrawnSetting>& drawn_setting_record() {
  static const auto record =
      Record<DrawnSetting>("a setting of a plotter")
          .required("name", &DrawnSetting::name, text())
          .required("set", &DrawnSetting::set, number(kAnyNumber))
          .required("found", &DrawnSetting::found, number(kAnyNumber))
          .required("sigma", &DrawnSetting::sigma, number(kNotNegative))
          .required("off", &DrawnSetting::off, boolean());
  return record;
}

const Record<DrawnValue>& drawn_value_record() {
  static const auto record =
      Record<DrawnValue>("a measure of a drawing")
          .required("name", &DrawnValue::name, text())
          .required("measured_mm", &DrawnValue::measured_mm, number(kAnyNumber))
          .required("explained_mm", &DrawnValue::explained_mm, number(kAnyNumber))
          .required("rejected", &DrawnValue::rejected, boolean());
  return record;
}

void take_cause_of_cords(CauseId& cause) {
  for (const model::effects::Effect* own : model::plotter::described_plotter_effects()) {
    if (cause.effect != nullptr && cause.effect->id == own->id) cause.effect = own;
  }
}

}  // namespace

const Record<DrawingFindings>& drawing_findings_record() {
  static const auto record =
      Record<DrawingFindings>("what a drawing tells")
          .required("plotter", &DrawingFindings::plotter, text())
          .required("settings", &DrawingFindings::settings, list(object(drawn_setting_record())))
          .required("measures", &DrawingFindings::measures, list(object(drawn_value_record())));
  return record;
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

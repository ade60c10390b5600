// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of a chaintrue_diagnosis file. Private to grid/files.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] const Record<diagnosis::CauseId>& cause_id_record();
[[nodiscard]] const Record<diagnosis::Cause>& cause_record();
[[nodiscard]] const Record<diagnosis::Hypothesis>& hypothesis_record();
[[nodiscard]] const Record<diagnosis::LeftOver>& left_over_record();
/// diagnosis_remainder_record.cpp.
[[nodiscard]] const Record<diagnosis::Unexplained>& unexplained_record();
[[nodiscard]] const Record<diagnosis::ErrorBudget>& error_budget_record();
[[nodiscard]] const Record<diagnosis::NotTestable>& not_testable_record();
[[nodiscard]] const Record<diagnosis::Bound>& bound_record();
[[nodiscard]] const Record<diagnosis::DeclaredAnswer>& declared_answer_record();
[[nodiscard]] const Record<diagnosis::CalibratedSetting>& calibrated_setting_record();
[[nodiscard]] const Record<diagnosis::HolePicture>& hole_picture_record();
[[nodiscard]] const Record<diagnosis::DistancePicture>& distance_picture_record();
/// diagnosis_drawing_record.cpp.
[[nodiscard]] const Record<diagnosis::DrawingFindings>& drawing_findings_record();
/// Causes that chains have under the same name become those of cords: a diagnosis of a drawing names
/// no others.
void take_causes_of_cords(diagnosis::Diagnosis& diagnosis);
/// diagnosis_belts_record.cpp.
[[nodiscard]] const Record<diagnosis::BeltsFindings>& belts_findings_record();
/// diagnosis_stability_record.cpp.
[[nodiscard]] const Record<diagnosis::Stability>& stability_record();
[[nodiscard]] const Record<diagnosis::PartFinding>& bed_part_record();
[[nodiscard]] const Record<diagnosis::PartFinding>& session_record();
/// Positions on the bed; diagnosis_point_record.cpp.
[[nodiscard]] const Record<diagnosis::NextMeasurement>& next_measurement_record();
[[nodiscard]] const Record<diagnosis::PointPicture>& point_picture_record();
/// Both contain held-out errors row by row; diagnosis_improvement_record.cpp.
[[nodiscard]] const Record<diagnosis::HeldOutImprovement>& improvement_record();
[[nodiscard]] const Record<diagnosis::Transfer>& transfer_record();

}  // namespace chaintrue::grid::files

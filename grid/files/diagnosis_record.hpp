// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of a chaintrue_diagnosis file. Private to grid/files.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

// Keys shared by several parts of a chaintrue_diagnosis file. Private to grid/files.

/// The side of an effect, as in files.
inline Value<std::string> side_word() {
  return one_of({"left", "right", "both", "x", "y", "tl", "tr", "bl", "br", "all"});
}

Value<diagnosis::Verdict> verdict_word();

Record<diagnosis::CauseId> cause_id_record();
Record<diagnosis::Cause> cause_record();
Record<diagnosis::Hypothesis> hypothesis_record();
Record<diagnosis::LeftOver> left_over_record();
/// diagnosis_remainder_record.cpp.
Record<diagnosis::Unexplained> unexplained_record();
Record<diagnosis::ErrorBudget> error_budget_record();
Record<diagnosis::NotTestable> not_testable_record();
Record<diagnosis::Bound> bound_record();
Record<diagnosis::DeclaredAnswer> declared_answer_record();
Record<diagnosis::CalibratedSetting> calibrated_setting_record();
Record<diagnosis::HolePicture> hole_picture_record();
Record<diagnosis::DistancePicture> distance_picture_record();
/// diagnosis_stability_record.cpp.
Record<diagnosis::Stability> stability_record();
Record<diagnosis::PartFinding> bed_part_record();
Record<diagnosis::PartFinding> session_record();
/// Positions on the bed, and the mechanisms that show there; diagnosis_point_record.cpp.
Record<diagnosis::NextMeasurement> next_measurement_record();
Record<diagnosis::PointPicture> point_picture_record();
Record<diagnosis::DrawingFindings> drawing_findings_record();
Record<diagnosis::BeltsFindings> belts_findings_record();
/// Both contain held-out errors row by row; diagnosis_stability_record.cpp.
Record<diagnosis::HeldOutImprovement> improvement_record();
Record<diagnosis::Transfer> transfer_record();

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The parts of a chaintrue_diagnosis file. Private to grid/files.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

using diagnosis::BeltsFindings;
using diagnosis::Bound;
using diagnosis::CalibratedSetting;
using diagnosis::Cause;
using diagnosis::CauseId;
using diagnosis::DeclaredAnswer;
using diagnosis::DistancePicture;
using diagnosis::DrawingFindings;
using diagnosis::ErrorBudget;
using diagnosis::HeldOutImprovement;
using diagnosis::HolePicture;
using diagnosis::Hypothesis;
using diagnosis::LeftOver;
using diagnosis::NextMeasurement;
using diagnosis::NotTestable;
using diagnosis::ParameterEstimate;
using diagnosis::PartFinding;
using diagnosis::PointPicture;
using diagnosis::Stability;
using diagnosis::Transfer;
using diagnosis::Unexplained;
using diagnosis::Verdict;

// Keys shared by several parts of a chaintrue_diagnosis file. Private to grid/files.

/// The side of an effect, as in files.
inline Value<std::string> side_word() {
  return one_of({"left", "right", "both", "x", "y", "tl", "tr", "bl", "br", "all"});
}

Value<Verdict> verdict_word();

Record<CauseId> record_of(Of<CauseId>);
Record<Cause> record_of(Of<Cause>);
Record<Hypothesis> hypothesis_record();
Record<LeftOver> record_of(Of<LeftOver>);
/// diagnosis_remainder_record.cpp.
Record<Unexplained> record_of(Of<Unexplained>);
Record<ErrorBudget> record_of(Of<ErrorBudget>);
Record<NotTestable> record_of(Of<NotTestable>);
Record<Bound> record_of(Of<Bound>);
Record<DeclaredAnswer> record_of(Of<DeclaredAnswer>);
Record<CalibratedSetting> record_of(Of<CalibratedSetting>);
Record<HolePicture> record_of(Of<HolePicture>);
Record<DistancePicture> record_of(Of<DistancePicture>);
/// diagnosis_stability_record.cpp.
Record<Stability> record_of(Of<Stability>);
Record<PartFinding> bed_part_record();
Record<PartFinding> session_record();
/// Positions on the bed, and the mechanisms that show there; diagnosis_point_record.cpp.
Record<NextMeasurement> record_of(Of<NextMeasurement>);
Record<PointPicture> point_picture_record();
Record<DrawingFindings> record_of(Of<DrawingFindings>);
Record<BeltsFindings> record_of(Of<BeltsFindings>);
/// Both contain held-out errors row by row; diagnosis_stability_record.cpp.
Record<HeldOutImprovement> record_of(Of<HeldOutImprovement>);
Record<Transfer> record_of(Of<Transfer>);

}  // namespace chaintrue::grid::files

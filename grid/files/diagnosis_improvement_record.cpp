// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of points that were left out, row by row.

#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::HeldOut;
using diagnosis::HeldOutImprovement;
using diagnosis::Transfer;

constexpr int kMostFolds = 1000;

/// An object with one figure for every modelling scheme; the sheet's placement alone does not exist
/// for every grid, and another grid is predicted with fewer schemes.
template <class T>
Record<T> figure_record(const Value<HeldOut>& figure) {
  Record<T> record("an object with one number for each model");
  record.required("as_delivered",
                  "As delivered: with the machine file's settings, for commands with the "
                  "controller's. At the measured points; tool_today is over the measured part.",
                  &T::uncalibrated, figure);
  if constexpr (requires { &T::placed; })
    record.optional("placed", "After the best placement of the sheet.", &T::placed, figure);
  record.required("calibrated", "With calibrated settings.", &T::calibrated, figure)
      .required("extended", "With the named causes.", &T::extended, figure)
      .required("extended_and_surface", "With the causes and a smooth surface.",
                &T::extended_and_surface, figure);
  if constexpr (requires { &T::surface_only; })
    record.required("surface_only", "With a smooth surface and no cause.", &T::surface_only,
                    figure);
  return record;
}

Value<HeldOut> single(double HeldOut::*member) {
  const Value<double> value = number(kSigmaMm);
  return partial<HeldOut>(
      value.expected,
      [value, member](const Cursor& at, HeldOut& row) {
        if (const auto read = value.read(at)) row.*member = *read;
      },
      [value, member](const HeldOut& row) { return value.write(row.*member); });
}

template <class T>
void error_figures(Record<T>& record) {
  record
      .part("position_rms_mm", "Rms error at the tool (for holes alone: of a distance).", true,
            figure_record<T>(single(&HeldOut::rms_mm))
                .required("noise_floor", "From noise alone.", &T::noise_floor_mm, kSigmaMm))
      .part("position_percentile_95_mm", "95th percentile of the error.", true,
            figure_record<T>(single(&HeldOut::percentile_95_mm)))
      .part("position_rms_90_percent_mm", "90 % interval of the rms.", true,
            figure_record<T>(members_as_pair(pair_of_numbers(kSigmaMm, true), &HeldOut::low_mm,
                                             &HeldOut::high_mm)));
}

}  // namespace

Record<HeldOutImprovement> improvement_record() {
  RECORD(HeldOutImprovement, "the gain")
  REQUIRED(scheme, "How points were left out.")
  ALSO(error_figures)
  REQUIRED(drop_mm2, "Reduction of the mean square.", kSigmaMm)
  REQUIRED(drop_share, "The same as a share.", kShare)
  REQUIRED(folds, "Number of times that points were left out.", integer(0, kMostFolds))
  REQUIRED(folds_agree, "Number of these in which the same was named.", integer(0, kMostFolds))
      .check([](const Cursor& at, HeldOutImprovement& object) {
        if (at.clean() && object.folds_agree > object.folds)
          at.child("folds_agree").expect("at most as many as folds");
      });
}

Record<Transfer> transfer_record() {
  RECORD(Transfer, "another grid predicted")
  REQUIRED(to, "Name of the grid.")
  REQUIRED(points, "Number of its points.")
  ALSO(error_figures);
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
// Held-out errors in a chaintrue_diagnosis file: one object for each figure, one key for each
// modelling scheme.
#include <array>
#include <string_view>

#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::HeldOut;
using diagnosis::HeldOutImprovement;
using diagnosis::Transfer;

constexpr int kMostFolds = 1000;

/// A modelling scheme by its key; the sheet's placement alone does not exist for every grid.
template <class T>
struct ErrorRow {
  std::string_view key;
  std::string_view meaning;
  HeldOut T::*member = nullptr;
  std::optional<HeldOut> T::*maybe = nullptr;

  [[nodiscard]] const HeldOut* of(const T& object) const {
    if (member != nullptr) return &(object.*member);
    return object.*maybe ? &*(object.*maybe) : nullptr;
  }
  [[nodiscard]] HeldOut& made_in(T& object) const {
    if (member != nullptr) return object.*member;
    if (!(object.*maybe)) (object.*maybe).emplace();
    return *(object.*maybe);
  }
};

constexpr std::string_view kAsDelivered =
    "As delivered: with the machine file's settings, for commands with the controller's. At the "
    "measured points; tool_today is over the measured part.";
constexpr std::string_view kCalibrated = "With calibrated settings.";
constexpr std::string_view kWithCauses = "With the named causes.";
constexpr std::string_view kAndSurface = "With the causes and a smooth surface.";

using Improvement = HeldOutImprovement;
constexpr std::array kImprovementRows = {
    ErrorRow<Improvement>{"as_delivered", kAsDelivered, &Improvement::uncalibrated},
    ErrorRow<Improvement>{
        "placed", "After the best placement of the sheet.", nullptr, &Improvement::placed},
    ErrorRow<Improvement>{"calibrated", kCalibrated, &Improvement::calibrated},
    ErrorRow<Improvement>{"extended", kWithCauses, &Improvement::extended},
    ErrorRow<Improvement>{"extended_and_surface", kAndSurface, &Improvement::extended_and_surface},
    ErrorRow<Improvement>{
        "surface_only", "With a smooth surface and no cause.", &Improvement::surface_only},
};
constexpr std::array kTransferRows = {
    ErrorRow<Transfer>{"as_delivered", kAsDelivered, &Transfer::uncalibrated},
    ErrorRow<Transfer>{"calibrated", kCalibrated, &Transfer::calibrated},
    ErrorRow<Transfer>{"extended", kWithCauses, &Transfer::extended},
    ErrorRow<Transfer>{"extended_and_surface", kAndSurface, &Transfer::extended_and_surface},
};

/// One figure of a row: read into the row and written from it.
struct Figure {
  Expected expected;
  std::function<void(const Cursor&, HeldOut&)> read;
  std::function<Json(const HeldOut&)> write;
};

Figure single(double HeldOut::*member) {
  const Value<double> value = number(kSigmaMm);
  return {value.expected,
          [value, member](const Cursor& at, HeldOut& row) {
            if (const auto read = value.read(at)) row.*member = *read;
          },
          [value, member](const HeldOut& row) { return value.write(row.*member); }};
}

Figure interval() {
  constexpr const char* kExpected = "a pair of numbers in mm, the lower one first";
  const Value<std::vector<double>> value = list(number(kSigmaMm), 2);
  return {{kExpected,
           [value] {
             Json schema = value.expected.schema();
             schema["maxItems"] = 2;
             return schema;
           }},
          [value](const Cursor& at, HeldOut& row) {
            const auto read = value.read(at);
            if (!read || read->size() < 2) return;
            if (read->size() > 2 || (*read)[1] < (*read)[0]) return at.expect(kExpected);
            row.low_mm = (*read)[0];
            row.high_mm = (*read)[1];
          },
          [](const HeldOut& row) {
            return Json::array({row.low_mm, row.high_mm});
          }};
}

/// An object with one figure for every row; `floor`, if given, is its last key.
template <class T, std::size_t kCount>
Record<T> figure_record(const std::array<ErrorRow<T>, kCount>& rows,
                        const Figure& figure,
                        double T::*floor = nullptr) {
  Record<T> record("an object with one number for each model");
  for (const ErrorRow<T>& row : rows) {
    record.custom(
        row.key,
        row.meaning,
        row.member != nullptr,
        figure.expected,
        [row, figure](const Cursor& at, T& object) { figure.read(at, row.made_in(object)); },
        [row, figure](const T& object) {
          const HeldOut* held = row.of(object);
          return held != nullptr ? std::optional<Json>(figure.write(*held)) : std::nullopt;
        });
  }
  if (floor != nullptr) record.required("noise_floor", "From noise alone.", floor, kSigmaMm);
  return record;
}

template <class T, std::size_t kCount>
void error_figures(Record<T>& record, const std::array<ErrorRow<T>, kCount>& rows) {
  static const auto rms = figure_record(rows, single(&HeldOut::rms_mm), &T::noise_floor_mm);
  static const auto worst = figure_record(rows, single(&HeldOut::percentile_95_mm));
  static const auto intervals = figure_record(rows, interval());
  record
      .part("position_rms_mm", "Rms error at the tool (for holes alone: of a distance).", true, rms)
      .part("position_percentile_95_mm", "95th percentile of the error.", true, worst)
      .part("position_rms_90_percent_mm", "90 % interval of the rms.", true, intervals);
}

}  // namespace

const Record<HeldOutImprovement>& improvement_record() {
  static const auto record = [] {
    Record<HeldOutImprovement> improvement("the gain");
    improvement.required("scheme", "How points were left out.", &HeldOutImprovement::scheme);
    error_figures(improvement, kImprovementRows);
    improvement
        .required(
            "drop_mm2", "Reduction of the mean square.", &HeldOutImprovement::drop_mm2, kSigmaMm)
        .required("drop_share", "The same as a share.", &HeldOutImprovement::drop_share, kShare)
        .required("folds",
                  "Number of times that points were left out.",
                  &HeldOutImprovement::folds,
                  integer(0, kMostFolds))
        .required("folds_agree",
                  "Number of these in which the same was named.",
                  &HeldOutImprovement::folds_agree,
                  integer(0, kMostFolds))
        .check([](const Cursor& at, HeldOutImprovement& object) {
          if (at.clean() && object.folds_agree > object.folds)
            at.child("folds_agree").expect("at most as many as folds");
        });
    return improvement;
  }();
  return record;
}

const Record<Transfer>& transfer_record() {
  static const auto record = [] {
    Record<Transfer> transfer("another grid predicted");
    transfer.required("to", "Name of the grid.", &Transfer::to)
        .required("points", "Number of its points.", &Transfer::points, index_number());
    error_figures(transfer, kTransferRows);
    return transfer;
  }();
  return record;
}

}  // namespace chaintrue::grid::files

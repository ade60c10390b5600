// SPDX-License-Identifier: GPL-3.0-or-later
// Held-out errors in a chaintrue_diagnosis file: one object for each figure, one key for each
// modelling scheme.
#include <array>
#include <string_view>

#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::HeldOutImprovement;
using diagnosis::HeldOut;
using diagnosis::Transfer;

constexpr int kMostFolds = 1000;

/// A modelling scheme by its key; the sheet's placement alone does not exist for every grid.
template <class T>
struct ErrorRow {
  std::string_view key;
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

constexpr std::array kImprovementRows = {
    ErrorRow<HeldOutImprovement>{"as_delivered", &HeldOutImprovement::uncalibrated},
    ErrorRow<HeldOutImprovement>{"placed", nullptr, &HeldOutImprovement::placed},
    ErrorRow<HeldOutImprovement>{"calibrated", &HeldOutImprovement::calibrated},
    ErrorRow<HeldOutImprovement>{"extended", &HeldOutImprovement::extended},
    ErrorRow<HeldOutImprovement>{"extended_and_surface", &HeldOutImprovement::extended_and_surface},
    ErrorRow<HeldOutImprovement>{"surface_only", &HeldOutImprovement::surface_only},
};
constexpr std::array kTransferRows = {
    ErrorRow<Transfer>{"as_delivered", &Transfer::uncalibrated},
    ErrorRow<Transfer>{"calibrated", &Transfer::calibrated},
    ErrorRow<Transfer>{"extended", &Transfer::extended},
    ErrorRow<Transfer>{"extended_and_surface", &Transfer::extended_and_surface},
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
  Record<T> record("an object with one figure a way of modelling");
  for (const ErrorRow<T>& row : rows) {
    record.custom(
        std::string(row.key),
        row.member != nullptr,
        figure.expected,
        [row, figure](const Cursor& at, T& object) { figure.read(at, row.made_in(object)); },
        [row, figure](const T& object) {
          const HeldOut* held = row.of(object);
          return held != nullptr ? std::optional<Json>(figure.write(*held)) : std::nullopt;
        });
  }
  if (floor != nullptr) record.required("noise_floor", floor, number(kSigmaMm));
  return record;
}

/// A nested record that fills the object that contains it.
template <class T>
void nested(Record<T>& record, const std::string& key, const Record<T>& part) {
  record.custom(
      key,
      true,
      part.expected(),
      [&part](const Cursor& at, T& object) { part.read_into(at, object); },
      [&part](const T& object) { return std::optional<Json>(part.write(object)); });
}

template <class T, std::size_t kCount>
void error_figures(Record<T>& record, const std::array<ErrorRow<T>, kCount>& rows) {
  static const auto rms = figure_record(rows, single(&HeldOut::rms_mm), &T::noise_floor_mm);
  static const auto worst = figure_record(rows, single(&HeldOut::percentile_95_mm));
  static const auto intervals = figure_record(rows, interval());
  nested(record, "position_rms_mm", rms);
  nested(record, "position_percentile_95_mm", worst);
  nested(record, "position_rms_90_percent_mm", intervals);
}

}  // namespace

const Record<HeldOutImprovement>& improvement_record() {
  static const auto record = [] {
    Record<HeldOutImprovement> improvement("the gain");
    improvement.required("scheme", &HeldOutImprovement::scheme, text());
    error_figures(improvement, kImprovementRows);
    improvement.required("drop_mm2", &HeldOutImprovement::drop_mm2, number(kSigmaMm))
        .required("drop_share", &HeldOutImprovement::drop_share, number(kShare))
        .required("folds", &HeldOutImprovement::folds, integer(0, kMostFolds))
        .required("folds_agree", &HeldOutImprovement::folds_agree, integer(0, kMostFolds))
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
    transfer.required("to", &Transfer::to, text())
        .required("points", &Transfer::points, index_number());
    error_figures(transfer, kTransferRows);
    return transfer;
  }();
  return record;
}

}  // namespace chaintrue::grid::files

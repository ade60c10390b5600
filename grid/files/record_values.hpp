// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Values shared by several records. Their ranges only exclude numbers without a meaning. Private
/// to grid/files.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/json_reader.hpp"
#include "grid/map/compensation_map.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {

inline constexpr Range kNotNegative{"", 0.0, 1e12};
inline constexpr Range kShare{"", 0.0, 1.0};
inline constexpr Range kMillimetres{"mm", -1e6, 1e6};
inline constexpr Range kSigmaMm{"mm", 0.0, 1e6};
inline constexpr Range kPlaceMm{"mm", -1e5, 1e5};

/// A vector in the plane, or a number for each chain, as a pair of numbers; `in_order`: the lower
/// one first.
Value<Vector2d> pair_of_numbers(const Range& range, bool in_order = false);

/// Two members of an object as such a pair.
template <class T>
Value<T> members_as_pair(const Value<Vector2d>& pair, double T::*first, double T::*second) {
  return partial<T>(
      pair.expected,
      [=](const Cursor& at, T& object) {
        const auto read = pair.read(at);
        if (!read) return;
        object.*first = (*read)[0];
        object.*second = (*read)[1];
      },
      [=](const T& object) {
        return pair.write({object.*first, object.*second});
      });
}

/// A list of numbers, or rows of numbers; rows of different lengths give a 0 x 0 matrix.
Value<VectorXd> vector_of_numbers();
Value<MatrixXd> matrix_of_numbers(const Range& range, std::size_t fewest);

/// A dimension of a machine: its range is checked by model::problems_of, for files and programs in
/// one place.
inline Value<double> number_in(std::string_view unit) {
  constexpr double kBeyondMeaning = 1e6;
  return number({unit, -kBeyondMeaning, kBeyondMeaning});
}

/// Exactly N of them; `words` say so: "five coordinates".
template <std::size_t N, class V>
Value<std::array<V, N>> exactly(const Value<V>& element, const std::string& words) {
  const Value<std::vector<V>> all = list(element);
  return {[all, words](const Cursor& at) -> std::optional<std::array<V, N>> {
            const auto found = all.read(at);
            if (!found) return std::nullopt;
            std::array<V, N> values{};
            if (found->size() == N) {
              std::copy(found->begin(), found->end(), values.begin());
              return values;
            }
            at.report(std::to_string(found->size()) + " of them", ProblemKind::wrong_count, words);
            return std::nullopt;
          },
          [all](const std::array<V, N>& values) {
            return all.write(std::vector<V>(values.begin(), values.end()));
          },
          {words, list(element, N).expected.schema}};
}

/// Reports what no machine can be like. A field that could not be read keeps its default, which needs
/// no check.
void report_impossible(const Cursor& at, const std::vector<MachineProblem>& found);

/// The name of a setting of the machine or of the sheet.
Value<Setting> setting_word();

/// An rms and a maximum, mm.
Record<ErrorSummary> record_of(Of<ErrorSummary>);

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/record_values.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {

Value<std::size_t> index_number(int least, int most) {
  return converted<std::size_t>(
      integer(least, most), [](int value) { return as_size(value); },
      [](std::size_t value) { return static_cast<int>(value); });
}

Value<Vector2d> pair_of_numbers(const Range& range, bool in_order) {
  const Value<std::vector<double>> numbers = list(number(range), 2);
  const std::string expected =
      fmt::format("a pair of numbers{}{}{}", range.unit.empty() ? "" : " in ", range.unit,
                  in_order ? ", the lower one first" : "");
  Json schema = numbers.expected.schema;
  schema["maxItems"] = 2;
  return {[numbers, expected, in_order](const Cursor& at) -> std::optional<Vector2d> {
            const auto read = numbers.read(at);
            if (!read || read->size() < 2) return std::nullopt;
            const Vector2d pair((*read)[0], (*read)[1]);
            if (read->size() == 2 && (!in_order || pair[0] <= pair[1])) return pair;
            return at.expect(expected);
          },
          // A negative zero would be read back as a zero: the same number, other bytes.
          [](const Vector2d& pair) {
            return Json::array({pair[0] + 0.0, pair[1] + 0.0});
          },
          {expected, schema}};
}

Value<VectorXd> vector_of_numbers() {
  using Numbers = std::vector<double>;
  return converted<VectorXd>(
      list(kAnyNumber),
      [](const Numbers& values) -> VectorXd {
        return Eigen::Map<const VectorXd>(values.data(), as_index(values.size()));
      },
      [](const VectorXd& values) { return Numbers(values.begin(), values.end()); });
}

Value<MatrixXd> matrix_of_numbers(const Range& range, std::size_t fewest) {
  using Rows = std::vector<std::vector<double>>;
  return converted<MatrixXd>(
      list(list(range, fewest), fewest),
      [](const Rows& rows) {
        const std::size_t wide = rows.empty() ? 0 : rows.front().size();
        if (!all_of(rows, [&](const auto& row) { return row.size() == wide; })) return MatrixXd();
        MatrixXd matrix(as_index(rows.size()), as_index(wide));
        for (const auto i : each_index(rows))
          matrix.row(as_index(i)) = Eigen::Map<const RowVectorXd>(rows[i].data(), matrix.cols());
        return matrix;
      },
      [](const MatrixXd& matrix) {
        Rows rows;
        for (const auto& row : matrix.rowwise()) rows.emplace_back(row.begin(), row.end());
        return rows;
      });
}

void report_impossible(const Cursor& at, const std::vector<MachineProblem>& found) {
  for (const MachineProblem& problem : found) {
    const std::string place = at.pointer() + problem.parameter;
    if (!at.problems().at_or_below(place)) at.problems().add(place, problem);
  }
}

Value<Setting> setting_word() {
  std::vector<Setting> all(std::begin(kMachineSettings), std::end(kMachineSettings));
  append_all(all, model::kSheetSettings);
  return by_name(all);
}

RECORD_OF(ErrorSummary, "rms and maximum")
REQUIRED(rms_mm, "Root mean square.", kNotNegative)
REQUIRED(maximum_mm, "Largest value.", kNotNegative)
END_RECORD;

}  // namespace chaintrue::grid::files

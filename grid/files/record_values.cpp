// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/record_values.hpp"

#include <string>
#include <utility>

namespace chaintrue::grid::files {

Value<std::size_t> index_number() {
  const Value<int> whole = integer(0, kMostNumbered);
  return {[whole](const Cursor& at) -> std::optional<std::size_t> {
            const auto value = whole.read(at);
            return value ? std::optional(static_cast<std::size_t>(*value)) : std::nullopt;
          },
          [](const std::size_t& value) { return Json(value); },
          whole.expected};
}

Value<model::Setting> setting_word() {
  std::vector<std::pair<std::string, model::Setting>> names;
  for (auto setting : model::kMachineSettings) names.emplace_back(model::name(setting), setting);
  for (auto setting : model::kSheetSettings) names.emplace_back(model::name(setting), setting);
  return choice<model::Setting>(std::move(names));
}

const Record<ErrorSummary>& error_summary_record() {
  static const auto record =
      Record<ErrorSummary>("rms and maximum")
          .required("rms_mm", &ErrorSummary::rms_mm, number(kNotNegative))
          .required("maximum_mm", &ErrorSummary::maximum_mm, number(kNotNegative));
  return record;
}

}  // namespace chaintrue::grid::files

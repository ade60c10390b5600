// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/record_values.hpp"

#include <string>
#include <utility>

namespace chaintrue::grid::files {

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

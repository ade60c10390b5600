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

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/file_type.hpp"

#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

std::string file_type_of(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json json = parse_json(text, problems);
  if (!json.is_object()) return {};
  const auto type = json.find("file_type");
  return type != json.end() && type->is_string() ? type->get<std::string>() : std::string();
}

}  // namespace chaintrue::grid::files

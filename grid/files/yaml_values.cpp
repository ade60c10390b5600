// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/yaml_values.hpp"

#include <fmt/format.h>

#include <sstream>
#include <vector>

namespace chaintrue::grid::files {

std::map<std::string, YamlValue> yaml_values(const std::string& text) {
  struct Level {
    std::size_t indent;
    std::string path;
  };
  std::vector<Level> levels;
  std::map<std::string, YamlValue> values;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    const std::size_t indent = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    if (indent == std::string::npos || colon == std::string::npos) continue;
    while (!levels.empty() && levels.back().indent >= indent) levels.pop_back();
    const std::string key = line.substr(indent, colon - indent);
    const std::string path = levels.empty() ? key : levels.back().path + "/" + key;
    levels.push_back({indent, path});
    const std::size_t first = line.find_first_not_of(" \t\r", colon + 1);
    if (first == std::string::npos) continue;
    const std::size_t last = line.find_last_not_of(" \t\r");
    values[path] = {line.substr(first, last - first + 1), fmt::format("line {}", number)};
  }
  return values;
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/formats.hpp"

namespace chaintrue::grid::files {

std::string name_of(const Format& format) {
  constexpr std::string_view kBegin = "chaintrue_";
  return std::string(format.file_type.substr(kBegin.size()));
}

Json headed(const Format& format) {
  Json file = Json::object();
  file["file_type"] = format.file_type;
  file["format_version"] = format.version;
  return file;
}

}  // namespace chaintrue::grid::files

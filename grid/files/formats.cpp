// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/formats.hpp"

#include "grid/containers.hpp"

namespace chaintrue::grid::files {

const Format* format_of(std::string_view file_type) {
  const auto* found =
      find_where(kFormats, [&](const Format* one) { return one->file_type == file_type; });
  return found != nullptr ? *found : nullptr;
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_file.hpp"

#include <fmt/format.h>

#include "grid/files/belts_checks.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {

ReadBelts parse_belts(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json json = parse_json(text, problems);
  auto stated = belts_record().read(Cursor(json, problems), true);
  problems.throw_if_any();
  ReadBelts read;
  read.belts = std::move(stated.value());
  const BeltPlaces places{"/points",
                          [](std::size_t index, std::string_view field) {
                            return field.empty() ? fmt::format("/points/{}", index)
                                                 : fmt::format("/points/{}/{}", index, field);
                          },
                          "/machine"};
  check_belt_points(read.belts, places, problems);
  check_belt_distances(read.belts, "/distances", problems);
  problems.throw_if_any();
  check_belts_together(read.belts, places, BeltsUse::fit, problems);
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

ReadBelts read_belts(const std::filesystem::path& path) {
  return parse_belts(read_whole_file(path), name_in_messages(path));
}

std::string write_belts(const MeasuredBelts& belts, const std::vector<std::string>& comments) {
  const Json body = belts_record().write(belts);
  Json json = Json::object();
  for (const auto& [key, value] : body.items()) {
    json[key] = value;
    if (key == "format_version" && !comments.empty()) json["comment"] = comments;
  }
  return print_json(json);
}

}  // namespace chaintrue::grid::files

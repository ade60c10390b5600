// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/belts_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "grid/containers.hpp"
#include "grid/files/belts_checks.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/measured_entries.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

namespace {

/// The ends of distances at these points, which are the only ones that remain.
void move_ends(const PointIndices& remaining, MeasuredBelts& belts, Problems& problems) {
  for (const auto i : each_index(belts.distances)) {
    for (BeltEnd* end : {&belts.distances[i].from, &belts.distances[i].to}) {
      auto* index = std::get_if<std::size_t>(end);
      if (index == nullptr) continue;
      const auto own = std::find(remaining.begin(), remaining.end(), *index);
      if (own == remaining.end()) {
        problems.add(fmt::format("/distances/{}", i), words_of(*end), ProblemKind::contradiction,
                     "a point that is used: --without leaves it out. Remove the distance from the "
                     "file, or keep the point");
        return;
      }
      *index = as_size(own - remaining.begin());
    }
  }
}

void leave_out(const Indices& without, MeasuredBelts& belts, Problems& problems) {
  const std::size_t count = belts.points.size();
  for (const std::size_t number : without) {
    if (number <= count) continue;
    problems.add("--without", fmt::format("{}", number), ProblemKind::out_of_range,
                 "points of this file, counted from 1: 1 to {}", count);
  }
  problems.throw_if_any();
  PointIndices remaining = numbers_below(count);
  std::erase_if(remaining, [&](std::size_t index) { return contains(without, index + 1); });
  move_ends(remaining, belts, problems);
  problems.throw_if_any();
  keep_only(remaining, belts.points);
}

}  // namespace

Indices point_numbers_of(const std::string& text, const std::string& option,
                         std::string_view what) {
  return list_of_option(text, option,
                        fmt::format("numbers of {}, counted from 1, as in 7,12", what),
                        [](const std::string& part) -> std::optional<std::size_t> {
                          return whole_number_of(part, 1, kMostNumbered);
                        });
}

ReadBelts parse_belts(const std::string& text, const std::string& file, const Indices& without) {
  Problems problems(file);
  ReadBelts read{read_document(belts_record(), text, problems), {}};
  if (!without.empty()) {
    check_belt_distances(read.belts, problems);
    problems.throw_if_any();
    leave_out(without, read.belts, problems);
  }
  const PointIndices indices = indices_without(read.belts.points.size(), without);
  const BeltPlaces places{
      "/points",
      [&indices, of = place_in_json("/points")](std::size_t index, std::string_view field) {
        return of(index_in_file(indices, index), field);
      },
      "/machine"};
  check_belt_points(read.belts, places, problems);
  if (without.empty()) check_belt_distances(read.belts, problems);
  problems.throw_if_any();
  check_belts_together(read.belts, places, BeltsUse::fit, problems);
  problems.throw_if_any();
  read.warnings = problems.warnings();
  return read;
}

PointIndices indices_without(std::size_t kept, const Indices& without) {
  PointIndices indices;
  if (without.empty()) return indices;
  for (std::size_t i = 0; indices.size() < kept; ++i) {
    if (!contains(without, i + 1)) indices.push_back(i);
  }
  return indices;
}

std::string write_belts(const MeasuredBelts& belts, const Words& comments) {
  const Json body = belts_record().write(belts);
  Json json = Json::object();
  for (const auto& [key, value] : body.items()) {
    json[key] = value;
    if (key == "format_version" && !comments.empty()) json["comment"] = comments;
  }
  return print_json(json);
}

}  // namespace chaintrue::grid::files

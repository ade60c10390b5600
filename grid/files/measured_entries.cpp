// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/measured_entries.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "grid/containers.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {

PlaceOf place_in_json(std::string list) {
  return [list = std::move(list)](std::size_t index, std::string_view field) {
    return fmt::format("{}/{}{}{}", list, index, field.empty() ? "" : "/", field);
  };
}

void fetch_machine(std::optional<Machine>& machine, const std::string& machine_file,
                   const MeasuredOptions& options, Problems& problems) {
  if (options.machine) {
    machine = options.machine;
  } else if (!machine_file.empty() && !machine) {
    const auto folder = std::filesystem::path(problems.file()).parent_path();
    try {
      ReadMachine read = files::read(parse_machine, folder / machine_file);
      machine = std::move(read.machine);
      problems.add_warnings(read.warnings);
    } catch (const InputError& error) {
      problems.add_all(error.problems());
    }
  } else if (!machine) {
    machine = options.otherwise;
  }
}

Indices filled_in(const Words& blank_names, std::string_view entries, const std::string& to_write,
                  const std::string& place, Problems& problems) {
  Indices kept;
  Words blank;
  for (const auto i : each_index(blank_names)) {
    if (blank_names[i].empty()) {
      kept.push_back(i);
    } else {
      blank.push_back(blank_names[i]);
    }
  }
  if (blank.empty()) return kept;
  if (kept.empty()) {
    problems.add(place, fmt::format("{} {}, all left blank", blank.size(), entries),
                 ProblemKind::left_blank, to_write);
    problems.throw_if_any();
  }
  problems.warn(place, "{} of {} {} are left blank and left out: {}", blank.size(),
                blank_names.size(), entries, joined(blank));
  return kept;
}

std::string how_many(const Words& named, std::size_t count, std::string_view entries) {
  return named.size() == count
             ? fmt::format("all {} {}", count, entries)
             : fmt::format("{} of {} {} ({})", named.size(), count, entries, joined(named));
}

void check_orders(const std::vector<StatedOrder>& orders, const PlaceOf& place_of,
                  Problems& problems) {
  const std::size_t with_order = count_where(orders, &StatedOrder::order);
  if (with_order == 0) return;
  std::map<int, std::size_t> first_with;
  for (const auto i : each_index(orders)) {
    if (orders[i].is_spoilt) continue;
    if (!orders[i].order) {
      problems.add(
          place_of(i, "order"), "", ProblemKind::missing,
          "the number of the visit, as for {} other points; either all points have it or none",
          with_order);
      continue;
    }
    const auto [other, is_new] = first_with.emplace(*orders[i].order, i);
    if (!is_new) {
      problems.add(
          place_of(i, "order"), fmt::format("{}", *orders[i].order), ProblemKind::repeated_value,
          "a different number for each visit; {} has the same", place_of(other->second, ""));
    }
  }
}

}  // namespace chaintrue::grid::files

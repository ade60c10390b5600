// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The steps common to files of measurements of any kind, once their fields are read: the
/// machine that it names, lines that were left blank, the numbers of the visits. Private to
/// grid/files.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/measured_options.hpp"
#include "grid/files/problems.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// The place of an entry of a list, or of one of its fields, in the file: "/points/3", "line 5, column 8".
using PlaceOf = std::function<std::string(std::size_t index, std::string_view field)>;

/// For a list in JSON: "/points", "/points/3", "/points/3/x_mm".
PlaceOf place_in_json(std::string list);

/// Fills in the machine: that of the options instead of any that the file states; otherwise its own, that of
/// the file that it names, or the options' other one. Problems and warnings of that file are added.
void fetch_machine(std::optional<Machine>& machine, const std::string& machine_file,
                   const MeasuredOptions& options, Problems& problems);

/// The other entries are dropped.
template <class T>
void keep_only(const std::vector<std::size_t>& kept, std::vector<T>& entries) {
  std::vector<T> own;
  for (const std::size_t i : kept) own.push_back(std::move(entries[i]));
  entries = std::move(own);
}

/// As above; places are then those of what is kept.
template <class T>
void keep_only(const std::vector<std::size_t>& kept, std::vector<T>& entries, PlaceOf& place_of) {
  keep_only(kept, entries);
  place_of = [kept, of = std::move(place_of)](std::size_t index, std::string_view field) {
    return of(kept[index], field);
  };
}

/// Reports entries that were left blank, by their names (empty: not blank), and returns the others.
/// `entries`: "points"; `to_write`: what the user writes into a blank one. \throws InputError if
/// every one is blank.
std::vector<std::size_t> filled_in(const std::vector<std::string>& blank_names,
                                   std::string_view entries, const std::string& to_write,
                                   const std::string& place, Problems& problems);

/// "all 28 points", "3 of 28 points (4, 7, 9)".
std::string how_many(const std::vector<std::string>& named, std::size_t count,
                     std::string_view entries);

/// The number of an entry's visit; that of an entry with a wrong value is ignored.
struct StatedOrder {
  std::optional<int> order;
  bool is_spoilt = false;
};
/// Either all entries have numbers that differ, or none has one.
void check_orders(const std::vector<StatedOrder>& orders, const PlaceOf& place_of,
                  Problems& problems);

}  // namespace chaintrue::grid::files

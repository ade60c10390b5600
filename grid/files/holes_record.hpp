// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The content of a chaintrue_holes file before the machine is read and the ends of distances are
/// resolved: its JSON record, and its two tables as CSV. Private to grid/files.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/csv_table.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/measured_entries.hpp"
#include "grid/files/ranges.hpp"
#include "grid/input_checks/findings.hpp"
#include "grid/observation/measured_holes.hpp"
#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid::files {

// Input checks of holes and distances, independent of the file format. Private to grid/files.

/// A distance as a file states it.
struct StatedDistance {
  /// A name, or the hole's number as text.
  std::string from;
  std::string to;
  /// Empty if the line was not filled in or its reading is wrong.
  std::optional<double> distance_mm;
  std::optional<double> sigma_mm;
  /// A value was wrong and is already reported; true before any was read.
  bool is_spoilt = true;
};

/// The places of values in their file, for messages.
struct HolesPlaces {
  std::string holes;
  std::string distances;
  PlaceOf hole;
  PlaceOf distance;
  input_checks::Written written = input_checks::Written::in_json;
};

/// Missing names become the holes' numbers; names that repeat or equal an edge's are reported.
void check_names(std::vector<Hole>& holes, const HolesPlaces& places, Problems& problems);
/// Reports ends that are neither a hole nor an edge, and distances from a hole to itself.
std::vector<HoleDistance> resolved_distances(const std::vector<StatedDistance>& stated,
                                             const std::vector<Hole>& holes,
                                             const HolesPlaces& places, Problems& problems);
/// Warns of distances that equal the commanded ones exactly.
void warn_of_copies(const MeasuredHoles& set, const HolesPlaces& places, Problems& problems);
/// Units, triangles, a forgotten zero offset of the tape, and too few distances. A doubtful stated
/// offset gives only a warning. Call it only if there are no earlier problems.
void check_holes_together(const MeasuredHoles& set, std::size_t fewest_distances,
                          bool tape_zero_is_stated, const HolesPlaces& places, Problems& problems);

inline constexpr Range kTapeDistance{"mm", 0.1, 20000.0};

struct StatedHoles : MeasuredHoles {
  std::optional<BeltMachine> belt_machine;  ///< instead of the other
  std::string machine_file;
  /// The tape's zero offset is stated, even as 0.
  bool tape_zero_is_stated = false;
  std::vector<StatedDistance> lines;
};

/// The content of a CSV with its places: `places` refer to `rows`, which they share.
struct HolesTables {
  StatedHoles stated;
  HolesPlaces places;
};
/// \throws InputError with every problem.
HolesTables read_holes_tables(const std::string& text, double tape_unit, Problems& problems);

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The content of a chaintrue_holes file before the machine is read and the ends of distances are
/// resolved: its JSON record, and its two tables as CSV. Private to grid/files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/files/csv_table.hpp"
#include "grid/files/holes_checks.hpp"
#include "grid/files/json_reader.hpp"
#include "grid/files/ranges.hpp"
#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid::files {

inline constexpr Range kHoleCoordinate{"mm", -20000.0, 20000.0};
inline constexpr Range kTapeDistance{"mm", 0.1, 20000.0};

struct StatedHoles : MeasuredHoles {
  std::optional<model::BeltMachine> belt_machine;  ///< instead of the other
  std::string machine_file;
  /// The tape's zero offset is stated, even as 0.
  bool tape_zero_is_stated = false;
  std::vector<StatedDistance> lines;
};

[[nodiscard]] const Record<StatedHoles>& holes_record();

/// The content of a CSV with its places: `places` refer to `rows`, which they share.
struct HolesTables {
  StatedHoles stated;
  HolesPlaces places;
};
/// \throws InputError with every problem.
[[nodiscard]] HolesTables read_holes_tables(const std::string& text,
                                            double tape_unit,
                                            Problems& problems);

}  // namespace chaintrue::grid::files

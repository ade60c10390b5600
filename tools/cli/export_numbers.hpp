// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers to type into GroundControl that bring its controller closest to a map, a machine or a
/// diagnosis, and the sentences about them.
#pragma once

#include <optional>
#include <string>

#include "grid/files/groundcontrol_file.hpp"
#include "grid/map/compensation_map.hpp"
#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

struct ExportCommand {
  std::string input;
  std::string output = "-";
  /// The map that is valid once the numbers are typed in.
  std::string map_after;
};

/// The numbers, and the sentences about them.
struct Exported {
  files::GroundcontrolText settings;
  std::string words;
  Words next;
  /// For a map: the map with a controller that has the numbers.
  std::optional<CompensationMap> map_after = std::nullopt;
};

/// The best fit of the controller's formulas to the map in `file`.
Exported exported_from(const CompensationMap& map, const std::string& file,
                       const ExportCommand& command);
/// A machine that agrees with its controller's settings changes none of them.
Exported exported_from(const Machine& stated, const std::string& file, Words next);
Exported exported_from(const Diagnosis& found, const std::string& file,
                       const ExportCommand& command);

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What points are asked of and programs are made for: a compensation map, the anchors of four
/// belts, or the V-plotter that a test drawing found. Verbs ask `lengths`; `content` holds
/// what only one of the three has.
///
/// \code
///   const Target target = open_target(open_target_file(command.map), command.frame);
///   if (const auto answer = target.lengths->query({100.0, -200.0})) use(*answer);
/// \endcode
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "grid/map/length_map.hpp"
#include "grid/plotter/found_plotter.hpp"
#include "tools/cli/grid_input.hpp"

namespace chaintrue::cli {

struct Target {
  using Content = std::variant<CompensationMap, files::FittedAnchors, grid::KnownPlotter>;
  std::unique_ptr<const Content> content;
  std::unique_ptr<const grid::LengthMap> lengths;  ///< may refer to the content
  /// Null for another content.
  template <class Kind>
  const Kind* as() const {
    return std::get_if<Kind>(content.get());
  }
};

/// \throws InputError for a file of another kind.
InputFile open_target_file(const std::string& path);
/// \param frame of a map, "marks" or "bed". \throws InputError for a bad file; Failed for a map that
/// cannot be continued as `outside` asks.
Target open_target(const InputFile& file, const std::string& frame,
                   const OutsideOption& outside = {});

/// --frame for a target.
OptionRow frame_row(std::string& frame, std::string help);

/// A chaintrue_plotter with the results of a drawing. \throws InputError without them.
grid::KnownPlotter load_found_plotter(const InputFile& file);

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/gcode_job.hpp"

#include <fmt/format.h>

#include "grid/belts/belt_map.hpp"
#include "tools/cli/map_words.hpp"

namespace chaintrue::cli {
namespace {

using gcode::ErrorAlong;

std::optional<double> with_path(const std::optional<gcode::ExpectedError>& map,
                                const ErrorAlong gcode::ExpectedError::*part, double path_mm) {
  if (!map || !((*map.*part).length_mm > 0.0)) return std::nullopt;
  return (*map.*part).rms_mm + path_mm;
}

std::string or_null(const std::optional<double>& value) {
  return value ? fmt::format("{:.6f}", *value) : "null";
}

}  // namespace

std::optional<double> PromisedError::measured_mm() const {
  return with_path(map, &gcode::ExpectedError::measured, path_mm);
}

std::optional<double> PromisedError::outside_mm() const {
  return with_path(map, &gcode::ExpectedError::outside, path_mm);
}

PromisedError promised_along(const gcode::CutPlaces& cuts, const GcodeMachine& machine,
                             double path_mm) {
  const auto* found = machine.target.as<files::FittedAnchors>();
  if (found == nullptr || found->fit.scale)
    return {cuts.expected(*machine.target.lengths), path_mm};
  // A scale that was not taped is taken as true, so that the error excludes it.
  BeltsFit taken_as_true = found->fit;
  taken_as_true.scale = grid::BeltScale{};
  return {cuts.expected(grid::BeltMap(taken_as_true, holes_of(*found))), path_mm, true};
}

std::string in_words(const PromisedError& error) {
  std::string words;
  if (const auto measured = error.measured_mm()) {
    const ErrorAlong& along = error.map->measured;
    words += fmt::format("Expect cuts within about {} mm ({} at worst, in line {}).\n",
                         about_mm(*measured), about_mm(along.largest_mm + error.path_mm),
                         along.weakest_line);
  }
  if (const auto outside = error.outside_mm()) {
    const ErrorAlong& along = error.map->outside;
    words += fmt::format(
        "{:.1f} m of cuts are outside the measured part: expect those within about {} mm ({} at "
        "worst, in line {}).\n",
        along.length_mm / 1000.0, about_mm(*outside), about_mm(along.largest_mm + error.path_mm),
        along.weakest_line);
  }
  if (error.is_without_scale && !words.empty()) {
    words +=
        "That is in millimetres of belt. The error of the belts' scale is additional and in "
        "proportion to the part: 1 mm per metre for each tenth of a per cent.\n";
  }
  return words;
}

std::string as_members(const PromisedError& error) {
  return fmt::format("\"expected_mm\": {}, \"outside_mm\": {}, \"expected_outside_mm\": {}",
                     or_null(error.measured_mm()),
                     error.map ? fmt::format("{:.3f}", error.map->outside.length_mm) : "null",
                     or_null(error.outside_mm()));
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/gcode_expected.hpp"

#include <fmt/format.h>

namespace chaintrue::cli {
namespace {

using gcode::ErrorAlong;

std::optional<double> with_path(const std::optional<gcode::ExpectedError>& map,
                                const ErrorAlong gcode::ExpectedError::*part,
                                double path_mm) {
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

std::string in_words(const PromisedError& error) {
  std::string words;
  if (const auto measured = error.measured_mm()) {
    const ErrorAlong& along = error.map->measured;
    words += fmt::format(
        "Expected error of the tool along the cuts (one sigma): {:.2f} mm, of which {:.2f} the "
        "path; {:.2f} mm at worst, on line {}.\n",
        *measured,
        error.path_mm,
        along.largest_mm + error.path_mm,
        along.largest_line);
  }
  if (const auto outside = error.outside_mm()) {
    const ErrorAlong& along = error.map->outside;
    words += fmt::format(
        "{:.1f} m of cuts lie outside what was measured: there {:.2f} mm are expected, {:.2f} mm "
        "at worst, on line {}.\n",
        along.length_mm / 1000.0,
        *outside,
        along.largest_mm + error.path_mm,
        along.largest_line);
  }
  return words;
}

std::string as_members(const PromisedError& error) {
  return fmt::format(
      "\"expected_mm\": {}, \"outside_mm\": {}, \"expected_outside_mm\": {}",
      or_null(error.measured_mm()),
      error.map ? fmt::format("{:.3f}", error.map->outside.length_mm) : "null",
      or_null(error.outside_mm()));
}

}  // namespace chaintrue::cli

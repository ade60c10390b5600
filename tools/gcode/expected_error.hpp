// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map's error of the tool along the cuts of a program, weighted by length. Rapids do not count.
/// The sheet is divided into squares, so that memory and time do not grow with the program; a map's
/// error changes little within one.
///
/// \code
///   CutPlaces cuts;
///   cuts.add(move.line, from, to);                      // of every cut
///   const ExpectedError error = cuts.expected(map);
///   if (error.measured.length_mm > 0.0) say(error.measured.rms_mm);
/// \endcode
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "grid/map/length_map.hpp"
#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

/// Over one part of the cuts.
struct ErrorAlong {
  double length_mm = 0.0;
  double rms_mm = 0.0;
  double largest_mm = 0.0;  ///< anywhere along them, in 95 of 100 sessions (map/largest_error.hpp)
  std::size_t weakest_line = 0;  ///< of the program, where the map knows least
};

struct ExpectedError {
  ErrorAlong
      measured;  ///< between measured points, or not beyond them by more than half their spacing
  ErrorAlong outside;
};

/// Not copyable: it points into itself.
class CutPlaces {
 public:
  CutPlaces() = default;
  CutPlaces(const CutPlaces&) = delete;
  CutPlaces& operator=(const CutPlaces&) = delete;
  /// A straight piece of a cut, on the sheet; of zero length for a plunge.
  void add(std::size_t line, const Point& from, const Point& to);
  /// A whole move of any kind, on the sheet.
  void add(const Move& move);
  /// Empty if the map does not know its error.
  [[nodiscard]] std::optional<ExpectedError> expected(const grid::LengthMap& map) const;

 private:
  struct Square {
    double length_mm = 0.0;
    std::size_t line = 0;  ///< that came first
  };
  using At = std::pair<int, int>;
  Square& square_at(At at, std::size_t line);

  std::map<At, Square> squares_;
  At last_at_{};
  Square* last_ = nullptr;  ///< short pieces mostly stay in one
};

}  // namespace chaintrue::gcode

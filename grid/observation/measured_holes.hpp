// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Measurements with a drill bit and a tape: holes cut at commanded places, distances between them
/// and to the sheet's edges. Where the holes are is not measured; it follows from what the
/// controller paid out and is solved with the machine.
///
/// \code
///   MeasuredHoles set;
///   set.machine = machine;  // with its controller and the settings in force
///   set.holes = {{"A", {-900.0, 400.0}}, {"B", {900.0, 400.0}}};
///   set.distances.push_back({.from = 0, .to = 1, .distance_mm = 1801.5});
///   set.distances.push_back({.from = 0, .edge = SheetEdge::top, .distance_mm = 209.0});
/// \endcode
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/observation/measured_grid.hpp"
#include "interp/eigen.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid {

enum class SheetEdge { left, right, top, bottom };
inline constexpr std::array kSheetEdges = {SheetEdge::left, SheetEdge::right, SheetEdge::top,
                                           SheetEdge::bottom};
/// The word in files: left, right, top, bottom.
std::string_view name(SheetEdge edge);
std::optional<SheetEdge> edge_of(std::string_view word);

struct Hole {
  std::string name;
  BedPoint commanded;
};

/// One reading of the tape, the tape's zero offset included: from a hole's centre to another's, or
/// square to an edge of the sheet.
struct HoleDistance {
  std::size_t from = 0;  ///< into the holes
  std::size_t to = 0;    ///< into the holes; not used where `edge` is set
  std::optional<SheetEdge> edge = std::nullopt;
  double distance_mm = 0.0;
  /// One sigma; absent: the tape's.
  std::optional<double> sigma_mm = std::nullopt;
};

struct Tape {
  /// One sigma of a reading: half a millimetre for careful reading of a tape.
  double sigma_mm = 0.5;
  /// Every reading is longer than the distance by this much (the hook was not used, or the 100 mm
  /// mark was held to the hole).
  double tape_zero_offset_mm = 0.0;
  /// One sigma of that offset, for a hook with play or edges of holes mistaken for their centres.
  /// All readings of a set share it, so measurements of another day are a separate set. Absent:
  /// exact.
  std::optional<double> tape_zero_offset_sigma_mm = std::nullopt;
};

/// One sigma of an unstated tape zero offset, mm: a hook has 1 to 2 mm of play, and from edge to
/// edge of two holes it is a bit's width, 3.2 or 6.35 mm.
inline constexpr double kAssumedTapeZeroMm = 3.0;
/// A fit always estimates one for all distances of a file. Zero if it is stated as exact.
inline double tape_zero_sigma_mm(const Tape& tape) {
  return tape.tape_zero_offset_sigma_mm.value_or(kAssumedTapeZeroMm);
}

/// The sheet whose edges were measured. Absent sizes are the bed's.
struct SheetSize {
  std::optional<double> width_mm;
  std::optional<double> height_mm;
  /// One sigma of each: sheets are sold to a millimetre or so.
  double size_sigma_mm = 1.0;
};

struct MeasuredHoles {
  std::string name;
  std::optional<Machine> machine;
  Tape tape;
  /// One sigma on each axis of a hole's displacement from where its chain lengths put it: friction of
  /// the sled, drift of the drill.
  double hole_sigma_mm = 0.3;
  /// Degrees of freedom of these two sigmas.
  double noise_dof = 15.0;
  SheetSize sheet;
  std::vector<ExtraReading> readings;  ///< readings of the machine itself
  std::vector<Hole> holes;
  std::vector<HoleDistance> distances;
};

/// One sigma of a reading.
double sigma_of(const MeasuredHoles& set, const HoleDistance& distance);
/// The distance without the tape's zero offset.
double length_of(const MeasuredHoles& set, const HoleDistance& distance);
/// "A-B", "A to the top edge".
std::string words_of(const MeasuredHoles& set, const HoleDistance& distance);
/// A place is 0.5 size + sign times its coordinate away from an edge.
struct EdgeLine {
  double size_mm;  ///< of the sheet, square to the edge
  Index axis;      ///< 0: x, of a left or right edge; 1: y
  double sign;
};
EdgeLine edge_line(const MeasuredHoles& set, SheetEdge edge);
/// The commanded distance, on a sheet aligned with the bed.
double commanded_mm(const MeasuredHoles& set, const HoleDistance& distance);

/// The amount by which nearly all distances are longer than commanded, equally for short and long
/// ones; empty if not above 8 mm. It suggests a zero offset that was not stated (or, if negative,
/// stated twice).
std::optional<double> suspected_tape_zero_offset_mm(const MeasuredHoles& set);

/// Distances alone determine the motors' spacing, both chain zeros and both chains' scales; with
/// fewer distances the result depends on the stated values.
inline constexpr std::size_t kFewestHoleDistances = 5;

}  // namespace chaintrue::grid

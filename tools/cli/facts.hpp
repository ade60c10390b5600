// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The kinds of input that an option applies to. An option without effect on its verb's input
/// is refused before any work; tests/inputs tries each with every kind of input.
///
/// \code
///   verb.add_flag("--below", ...).acts_on(facts::map | facts::machine, "to be left out: ...");
///   ...
///   verb.refuse_idle_options(facts::plotter);
/// \endcode
#pragma once

#include <cstdint>

namespace chaintrue::cli {

/// Facts about a verb's input on which options depend; several hold at once.
using Facts = std::uint32_t;

namespace facts {
// Kinds of files.
inline constexpr Facts grid = 1U << 0;
inline constexpr Facts holes = 1U << 1;
inline constexpr Facts belts = 1U << 2;
inline constexpr Facts belt_holes = 1U << 3;  ///< on four belts, alone or with their lengths
inline constexpr Facts chains = grid | holes;
inline constexpr Facts taped = holes | belt_holes;
inline constexpr Facts map = 1U << 4;
inline constexpr Facts anchors = 1U << 5;
inline constexpr Facts diagnosis = 1U << 6;
inline constexpr Facts machine = 1U << 7;
/// A single grid.
inline constexpr Facts one_grid = 1U << 8;
/// fit: a smooth correction on the calibrated machine, or splines through the lengths.
inline constexpr Facts residual = 1U << 9;
inline constexpr Facts direct = 1U << 10;
/// --outside fade.
inline constexpr Facts fade = 1U << 11;
// plan and simulate: the kind of plan or data.
inline constexpr Facts lattice = 1U << 12;    ///< marks in columns and rows
inline constexpr Facts scattered = 1U << 13;  ///< marks anywhere
inline constexpr Facts marks = 1U << 14;      ///< marks of a list
inline constexpr Facts places = 1U << 15;     ///< true places of a list
inline constexpr Facts tape = 1U << 16;       ///< holes and a tape
inline constexpr Facts check = 1U << 17;      ///< points that check a map
inline constexpr Facts follow_up = 1U << 18;  ///< after a diagnosis
/// A program is written (--gcode).
inline constexpr Facts program = 1U << 21;
/// It drills, rather than stopping above the marks.
inline constexpr Facts drilled = 1U << 22;
/// A program without --map.
inline constexpr Facts no_map = 1U << 23;
/// fit: without --plain.
inline constexpr Facts causes = 1U << 24;
/// A table (CSV) is among the files.
inline constexpr Facts table = 1U << 28;
/// fit and diagnose: a V-plotter's test drawing, alone.
inline constexpr Facts drawing = 1U << 29;
/// Every input of fit and diagnose except a test drawing.
inline constexpr Facts no_drawing = grid | holes | belts | belt_holes;
/// Instead of a map: a V-plotter with a measured drawing.
inline constexpr Facts plotter = 1U << 30;
/// plan: without --after; of those, at marks.
inline constexpr Facts planned = lattice | tape | check;
inline constexpr Facts planned_marks = lattice | check;
/// simulate: marks that are visited; readings that are drawn.
inline constexpr Facts session = lattice | scattered | marks;
inline constexpr Facts drawn = session | tape | belts;
/// What a program is compensated with.
inline constexpr Facts target = map | anchors | plotter;
/// For an option that other verbs also have.
inline constexpr Facts nothing = 0;
inline constexpr Facts any = ~0U;

}  // namespace facts

}  // namespace chaintrue::cli

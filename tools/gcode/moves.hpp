// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All moves of a program in memory, for files of moderate size: every target with its line and
/// kind.
///
/// \code
///   const auto moves = read_moves("fixtures/gcode/bracket.nc");
///   if (!moves) fmt::print("{}\n", moves.error().message());
///   else for (const auto& move : *moves) use(move.line, move.to);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "tools/gcode/events.hpp"
#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

/// Rapids, feeds, arcs and probe moves in order, in mm in the machine frame; arcs carry their
/// circle.
[[nodiscard]] Result<std::vector<Move>> read_moves(const std::string& path,
                                                   const Dialect& dialect = {});
[[nodiscard]] Result<std::vector<Move>> read_moves(LineSource& source, const Dialect& dialect = {});

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of events, and the lists of problems and notes.
#include "tools/gcode/events.hpp"

#include <fmt/format.h>

#include <utility>

namespace chaintrue::gcode {

std::string_view name(MoveKind kind) {
  constexpr std::string_view kNames[] = {"rapid", "feed", "arc", "probe"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string name(Code code) { return fmt::format("{}{:g}", code.letter, code.tenths / 10.0); }

void Findings::add(Problem problem) {
  const std::size_t line = problem.place.line;
  if (line != 0 && std::exchange(last_line_, line) == line) return;
  ++problem_count;
  if (problems.size() < kMostKept) problems.push_back(std::move(problem));
}

void Findings::add(Note note) {
  if (note.problem) return add(Problem{*note.problem, {note.line}, std::move(note.sentence)});
  ++note_count;
  if (notes.size() < kMostKept) notes.push_back(std::move(note));
}

}  // namespace chaintrue::gcode

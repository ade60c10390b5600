// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A queue between the interpreter and the caller.
#include "tools/gcode/program_stream.hpp"

namespace chaintrue::gcode {

Result<const ProgramEvent*> ProgramStream::peek() {
  while (events_.empty()) {
    const auto more = program_.step();
    if (!more) return tl::unexpected(more.error());
  }
  return &events_.front();
}

void ProgramStream::pop() {
  if (events_.front().kind != ProgramEvent::Kind::end) events_.pop_front();
}

Result<void> ProgramStream::move(const Move& move) {
  ProgramEvent& event = events_.emplace_back();
  event.kind = ProgramEvent::Kind::move;
  event.line = move.line;
  event.move = move;
  return {};
}

Result<void> ProgramStream::word(const PassedWord& word) {
  ProgramEvent& event = events_.emplace_back();
  event.kind = ProgramEvent::Kind::word;
  event.line = word.line;
  // G61.1 is written as G61: some controllers misread the dot.
  event.text = word.text == "G61.1" ? "G61" : word.text;
  event.moves_itself = word.machine_code != 0;
  event.leaves_xy = word.leaves_xy;
  return {};
}

/// A closing % and the end of the file are equivalent.
Result<void> ProgramStream::end(std::size_t line, std::string_view word) {
  ProgramEvent& event = events_.emplace_back();
  event.kind = ProgramEvent::Kind::end;
  event.line = line;
  event.text = word == "%" ? std::string_view() : word;
  return {};
}

}  // namespace chaintrue::gcode

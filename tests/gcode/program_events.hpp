// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a program and keeps all its events, for tests.
#pragma once

#include <string>
#include <vector>

#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct ProgramEvents final : Sink {
  void move(const Move& move) override { moves.push_back(move); }
  void word(const PassedWord& word) override { words.push_back(word); }
  void comment(const Comment& comment) override { comments.push_back(comment); }
  void note(const Note& note) override { notes.push_back(note); }
  void end(std::size_t /*line*/, std::string_view word) override {
    end_word = word;
    ended = true;
  }

  std::vector<Move> moves;
  std::vector<PassedWord> words;
  std::vector<Comment> comments;
  std::vector<Note> notes;
  std::string end_word;
  bool ended = false;
};

inline Result<ProgramSummary> run_text(const std::string& text, Sink& sink,
                                       const Dialect& dialect = {}) {
  auto source = LineSource::from_text(text);
  return run_program(source, dialect, sink);
}

/// Every move of a program.
inline Result<std::vector<Move>> read_moves(LineSource& source, const Dialect& dialect = {}) {
  ProgramEvents events;
  const auto summary = run_program(source, dialect, events);
  if (!summary) return tl::unexpected(summary.error());
  return std::move(events.moves);
}

}  // namespace chaintrue::gcode

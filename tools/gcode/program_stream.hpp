// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A program's events, pulled one by one instead of pushed: moves, words that are passed through,
/// the end.
#pragma once

#include <deque>
#include <string>

#include "tools/gcode/program.hpp"

namespace chaintrue::gcode {

struct ProgramEvent {
  enum class Kind { move, word, end };
  Kind kind = Kind::end;
  Move move;
  std::string text;  ///< of a word, or of the word that ends the program
  bool moves_itself = false;  ///< a word that moves the tool in the machine's frame
  bool leaves_xy = false;     ///< ... in X and Y
  std::size_t line = 0;
};

class ProgramStream final : private Sink {
 public:
  /// Keeps a reference.
  ProgramStream(LineSource& source, const Dialect& dialect) : program_(source, dialect, *this) {}

  /// The next event, unchanged until pop(); Kind::end from the end on.
  [[nodiscard]] Result<const ProgramEvent*> peek();
  void pop();

 private:
  Result<void> move(const Move& move) override;
  Result<void> word(const PassedWord& word) override;
  Result<void> end(std::size_t line, std::string_view word) override;

  Program program_;
  std::deque<ProgramEvent> events_;
};

}  // namespace chaintrue::gcode

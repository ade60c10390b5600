// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs a whole program: lines, `%`, line numbers, block delete, O-words, subroutines, M98. Every
/// event goes to a sink.
///
/// Memory is independent of the length of the file. Endless loops end at the budget of steps.
///
/// \code
///   auto source = LineSource::from_file("part.nc");
///   PathCollector path;                                   // any Sink
///   if (source) {
///     const auto outcome = run_program(*source, Dialect{}, path);
///     if (!outcome) fmt::print("{}\n", outcome.error().message());
///   }
/// \endcode
///
/// A ProgramStream delivers the events one by one on request: moves, words that are passed through,
/// the end.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "tools/gcode/events.hpp"
#include "tools/gcode/flow.hpp"
#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/line_source.hpp"
#include "tools/gcode/plotter_codes.hpp"

namespace chaintrue::gcode {

struct ProgramSummary {
  std::size_t lines = 0;     ///< of the last line read
  std::uint64_t blocks = 0;  ///< executed
};

[[nodiscard]] Result<ProgramSummary> run_program(LineSource& source, const Dialect& dialect,
                                                 Sink& sink);

/// The same, line by line.
class Program {
 public:
  /// Keeps references to source and sink.
  Program(LineSource& source, const Dialect& dialect, Sink& sink)
      : interpreter_(dialect, block_, sink),
        source_(source),
        flow_(source, interpreter_),
        sink_(sink) {}

  /// Executes the next line; false when the program has ended. \throws Refusal
  bool step();
  const ProgramSummary& summary() const { return summary_; }
  const Interpreter& interpreter() const { return interpreter_; }
  /// Number of the line that step() will read, in the order of execution.
  std::size_t next_line() const { return source_.position().lines_before + 1; }

 private:
  void line(const SourceLine& raw);
  void line_with_text(std::size_t number, const TextLine& text);
  void line_number(std::size_t& at) const;
  void percent(const SourceLine& raw);
  void follow_block();
  void end_of_file();
  void end(std::size_t line, std::string_view word);
  /// The character at this position; zero at the end of the line.
  char peek(std::size_t at) const { return line_.text[at]; }

  Block block_;
  Interpreter interpreter_;
  LineSource& source_;
  Flow flow_;
  Sink& sink_;
  CleanLine line_;
  ProgramSummary summary_;
  bool begun_ = false;
  bool opened_by_percent_ = false;
  bool ended_ = false;
};

struct ProgramEvent {
  enum class Kind { move, word, end };
  Kind kind = Kind::end;
  std::size_t line = 0;
  Move move;
  PassedWord word;  ///< of Kind::end the one that ends the program; empty if none does
};

class ProgramStream final : private Sink {
 public:
  /// Keeps a reference.
  ProgramStream(LineSource& source, const Dialect& dialect) : program_(source, dialect, *this) {}

  /// The next event, unchanged until pop(); Kind::end from the end on. \throws Refusal
  const ProgramEvent& peek();
  void pop();

 private:
  void move(const Move& move) override;
  void word(const PassedWord& word) override;
  void end(std::size_t line, std::string_view word) override;

  Program program_;
  std::deque<ProgramEvent> events_;
};

}  // namespace chaintrue::gcode

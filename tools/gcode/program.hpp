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
#include <functional>
#include <memory>
#include <string>

#include "tools/gcode/events.hpp"
#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

struct ProgramSummary {
  std::size_t lines = 0;     ///< of the last line read
  std::uint64_t blocks = 0;  ///< executed
};

[[nodiscard]] Result<ProgramSummary> run_program(LineSource& source,
                                                 const Dialect& dialect,
                                                 Sink& sink);

/// The same, line by line.
class Program {
 public:
  /// Keeps references to source and sink.
  Program(LineSource& source, const Dialect& dialect, Sink& sink);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Executes the next line; false when the program has ended. \throws Refusal
  bool step();
  [[nodiscard]] const ProgramSummary& summary() const;
  [[nodiscard]] const Interpreter& interpreter() const;
  /// Number of the line that step() will read, in the order of execution.
  [[nodiscard]] std::size_t next_line() const;

 private:
  class Runner;
  std::unique_ptr<Runner> runner_;
};

struct ProgramEvent {
  enum class Kind { move, word, end };
  Kind kind = Kind::end;
  std::size_t line = 0;
  Move move;
  PassedWord word;  ///< of Kind::end the one that ends the program; empty where none does
};

class ProgramStream final : private Sink {
 public:
  /// Keeps a reference.
  ProgramStream(LineSource& source, const Dialect& dialect) : program_(source, dialect, *this) {}

  /// The next event, unchanged until pop(); Kind::end from the end on. \throws Refusal
  [[nodiscard]] const ProgramEvent& peek();
  void pop();

 private:
  void move(const Move& move) override;
  void word(const PassedWord& word) override;
  void end(std::size_t line, std::string_view word) override;

  Program program_;
  std::deque<ProgramEvent> events_;
};

}  // namespace chaintrue::gcode

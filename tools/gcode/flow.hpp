// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// O-words: conditions, loops and subroutines as in LinuxCNC, and Fanuc's M98/M99.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

/// The program's place in the file and the open blocks there.
class Flow {
 public:
  /// Keeps references.
  Flow(LineSource& source, Interpreter& interpreter) : source_(source), interpreter_(interpreter) {}

  /// The next line to execute; false at the end of the file. Counts lines that are read again
  /// against the budget.
  bool next(SourceLine& line);

  /// Executes an O-line (line.text begins with o, or has it at `at`).
  void control(const CleanLine& line, std::size_t at);
  /// M98.
  void call_program(long number, long repeats, Place place);
  /// M99.
  void leave_program(Place place);
  /// At the end of the program: reports open blocks.
  void finish(Place place) const;

 private:
  struct ControlLine;
  struct Word {
    std::string_view keyword;  // empty for the number of a program
    void (Flow::*execute)(const CleanLine&, const ControlLine&);
    bool stands_alone = false;  // nothing may follow
  };
  static const Word kWords[];
  struct ControlLine : Word {
    std::string label;
    std::size_t rest = 0;  // where the arguments begin
  };
  struct OpenBlock {
    std::string label;
    std::string_view kind;       // if, while, do or repeat
    LineSource::Position start;  // of the line that a loop returns to
    long remaining = 0;          // repeat only
    std::size_t line = 0;
  };
  struct OpenCall {
    std::string label;
    LineSource::Position return_to;
    LineSource::Position body;
    long remaining = 1;
    bool program = false;    // M98, without arguments
    std::size_t blocks = 0;  // open when it was called
  };

  ControlLine parse(const CleanLine& line, std::size_t at) const;
  void name_program(const CleanLine& line, const ControlLine& control);
  void begin_sub(const CleanLine& line, const ControlLine& control);
  void call(const CleanLine& line, const ControlLine& control);
  void return_from(const CleanLine& line, const ControlLine& control);
  void begin_loop(const CleanLine& line, const ControlLine& control);
  void end_loop(const CleanLine& line, const ControlLine& control);
  void condition(const CleanLine& line, const ControlLine& control);
  void jump_out(const CleanLine& line, const ControlLine& control);

  double value(const CleanLine& line, std::size_t at) const;
  LineSource::Position find_body(const std::string& label, Place place);
  /// Reads on to the next O-line of that label with one of the keywords, skipping nested blocks of
  /// the same label.
  struct Found {
    ControlLine control;
    LineSource::Position before;
  };
  std::optional<Found> find(const std::string& label,
                            std::initializer_list<std::string_view> keywords);
  /// The same, but required.
  Found skip_to(const std::string& label, std::initializer_list<std::string_view> keywords,
                Place from);
  void open_block(OpenBlock block, Place place);
  void push_call(OpenCall call, Place place);
  void pop_call();
  OpenBlock* innermost(const std::string& label);
  /// Closes this block and those inside it.
  void close(const OpenBlock* block);
  std::size_t floor() const { return calls_.empty() ? 0 : calls_.back().blocks; }

  LineSource& source_;
  Interpreter& interpreter_;
  std::vector<OpenBlock> blocks_;
  std::vector<OpenCall> calls_;
  std::map<std::string, LineSource::Position, std::less<>> bodies_;  // after `sub` or `O100`
  std::map<std::string, std::size_t, std::less<>> defined_at_;
  std::uint64_t furthest_ = 0;
  LineSource::Position line_start_;
  CleanLine found_line_;
};

}  // namespace chaintrue::gcode

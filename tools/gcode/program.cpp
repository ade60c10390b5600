// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From lines to executed blocks.
#include "tools/gcode/program.hpp"

#include <fmt/format.h>

#include "tools/gcode/flow.hpp"
#include "tools/gcode/plotter_codes.hpp"

namespace chaintrue::gcode {

class Program::Runner {
 public:
  Runner(LineSource& source, const Dialect& dialect, Sink& sink)
      : interpreter_(dialect, sink), source_(source), flow_(source, interpreter_), sink_(sink) {}

  Result<bool> step() {
    if (ended_) return false;
    SourceLine raw;
    const auto more = flow_.next(raw);
    if (!more) return tl::unexpected(more.error());
    if (!*more) {
      CHAINTRUE_GCODE_TRY(end_of_file());
      return false;
    }
    summary_.lines = raw.number;
    CHAINTRUE_GCODE_TRY(line(raw));
    return !ended_;
  }

  const ProgramSummary& summary() const { return summary_; }
  const Interpreter& interpreter() const { return interpreter_; }
  std::size_t next_line() const { return source_.position().lines_before + 1; }

 private:
  Result<void> end_of_file() {
    CHAINTRUE_GCODE_TRY(flow_.finish({summary_.lines, 0}));
    if (opened_by_percent_) {
      sink_.note({summary_.lines,
                  "no_closing_percent",
                  "the file begins with % but does not end with it"});
    } else {
      sink_.note({summary_.lines,
                  "no_program_end",
                  "the program has neither M2, M30 nor %; LinuxCNC would refuse it"});
    }
    return end(summary_.lines, "");
  }

  Result<void> line(const SourceLine& raw) {
    const std::size_t first = raw.text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    if (raw.text[first] == '%') return percent(raw);
    // A DOS end-of-file mark.
    if (raw.text.substr(first) == "\x1A") return end(raw.number, "");
    begun_ = true;
    CHAINTRUE_GCODE_TRY(clean(raw.text, raw.number, line_));
    block_.clear(raw.number);
    std::size_t at = 0;
    if (peek(at) == '/') {
      if (interpreter_.dialect().skip_deletable_blocks) return {};
      block_.deletable = true;
      ++at;
    }
    if (peek(at) == 'n') CHAINTRUE_GCODE_TRY(line_number(at));
    if (peek(at) == 'o') return flow_.control(line_, at);
    ++summary_.blocks;
    if (interpreter_.dialect().passes_plotter_codes) {
      if (const auto word = plotter_word(line_, at)) {
        const auto commented = interpreter_.execute(block_, line_.comments);
        if (!commented) return tl::unexpected(commented.error());
        return sink_.word({raw.number, *word});
      }
    }
    CHAINTRUE_GCODE_TRY(read_words(ValueReader(line_, interpreter_.parameters(), at),
                                   block_,
                                   interpreter_.dialect().tools_have_no_diameter));
    const auto after = interpreter_.execute(block_, line_.comments);
    if (!after) return tl::unexpected(after.error());
    return follow(*after);
  }

  char peek(std::size_t at) const { return at < line_.text.size() ? line_.text[at] : '\0'; }

  Result<void> line_number(std::size_t& at) {
    const std::size_t start = ++at;
    while (peek(at) >= '0' && peek(at) <= '9') ++at;
    if (at == start)
      return refuse(
          ProblemName::bad_line_number, line_.place(start), "N needs a whole number, not negative");
    if (peek(at) == '.') {
      ++at;
      while (peek(at) >= '0' && peek(at) <= '9') ++at;
    }
    return {};
  }

  Result<void> percent(const SourceLine& raw) {
    if (!begun_ && !opened_by_percent_) {
      opened_by_percent_ = true;
      return {};
    }
    if (!opened_by_percent_) {
      return refuse(ProblemName::bad_character,
                    {raw.number, 1},
                    "a % ends a program only where a % began it");
    }
    return end(raw.number, "%");
  }

  Result<void> end(std::size_t line, std::string_view word) {
    ended_ = true;
    return sink_.end(line, word);
  }

  Result<void> follow(const AfterBlock& after) {
    switch (after.flow) {
      case AfterBlock::Flow::next:
        return {};
      case AfterBlock::Flow::end:
        return end(block_.line, after.end_word);
      case AfterBlock::Flow::call_program:
        return flow_.call_program(after.program, after.repeats, block_.start());
      case AfterBlock::Flow::leave_program: {
        const auto left = flow_.leave_program(block_.start());
        if (!left) return tl::unexpected(left.error());
        return {};
      }
    }
    return {};
  }

  Interpreter interpreter_;
  LineSource& source_;
  Flow flow_;
  Sink& sink_;
  CleanLine line_;
  Block block_;
  ProgramSummary summary_;
  bool begun_ = false;
  bool opened_by_percent_ = false;
  bool ended_ = false;
};

Program::Program(LineSource& source, const Dialect& dialect, Sink& sink)
    : runner_(std::make_unique<Runner>(source, dialect, sink)) {}

Program::~Program() = default;

Result<bool> Program::step() { return runner_->step(); }
const ProgramSummary& Program::summary() const { return runner_->summary(); }
const Interpreter& Program::interpreter() const { return runner_->interpreter(); }
std::size_t Program::next_line() const { return runner_->next_line(); }

Result<ProgramSummary> run_program(LineSource& source,
                                   const Dialect& dialect,
                                   Sink& sink,
                                   const BeforeLine& before_line) {
  Program program(source, dialect, sink);
  for (;;) {
    if (before_line && !before_line(program.next_line(), program.interpreter()))
      return program.summary();
    const auto more = program.step();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return program.summary();
  }
}

}  // namespace chaintrue::gcode

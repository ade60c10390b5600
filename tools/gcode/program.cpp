// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From lines to executed blocks.
#include "tools/gcode/program.hpp"

#include <fmt/format.h>

#include "tools/gcode/flow.hpp"
#include "tools/gcode/plotter_codes.hpp"

namespace chaintrue::gcode {
namespace {

/// Files of other kinds, by what they begin with.
struct OtherKind {
  std::string_view beginning;
  const char* sentence;
};
constexpr OtherKind kOtherKinds[] = {
    {"<svg", "this is a drawing (SVG), not a program; let a CAM program make G-code of it"},
    {"<", "this is a web page, not a program; save the raw file (Raw, or Download)"},
    {"{\\rtf", "this is a formatted text (RTF), not a program; save it as plain text"},
    {"{", "this is a JSON file, not a program"},
    {"%PDF", "this is a PDF, not a program"},
    {"PK\x03\x04", "this is a ZIP archive, not a program; unpack it"},
    {"solid ", "this is a solid (STL), not a program; let a CAM program make G-code of it"},
};

}  // namespace

class Program::Runner {
 public:
  Runner(LineSource& source, const Dialect& dialect, Sink& sink)
      : interpreter_(dialect, sink), source_(source), flow_(source, interpreter_), sink_(sink) {}

  Result<bool> step() {
    if (ended_) return false;
    SourceLine raw;
    const auto more = flow_.next(raw);
    CHAINTRUE_GCODE_TRY(more);
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
    CHAINTRUE_GCODE_TRY(other_kind(raw, first));
    if (raw.text[first] == '%') return percent(raw);
    // A DOS end-of-file mark.
    if (raw.text.substr(first) == "\x1A") return end(raw.number, "");
    begun_ = true;
    const Dialect& dialect = interpreter_.dialect();
    if (const auto text = text_line(raw.text, dialect.passes_plotter_codes))
      return line_with_text(raw.number, *text);
    CHAINTRUE_GCODE_TRY(clean(raw.text, raw.number, line_));
    block_.clear(raw.number);
    std::size_t at = 0;
    if (peek(at) == '/') {
      if (dialect.skip_deletable_blocks) return {};
      block_.deletable = true;
      ++at;
    }
    if (peek(at) == 'n') CHAINTRUE_GCODE_TRY(line_number(at));
    if (peek(at) == 'o') return flow_.control(line_, at);
    ++summary_.blocks;
    if (dialect.passes_plotter_codes) {
      if (const auto word = plotter_word(line_, at, dialect.plotter_home_mm.has_value()))
        return interpreter_.pass_line(block_, line_.comments, *word);
    }
    const auto words = read_words(ValueReader(line_, interpreter_.parameters(), at),
                                  block_,
                                  dialect.tools_have_no_diameter);
    if (!words && holds_moves(line_.text)) return line_ends_lost(raw.number);
    CHAINTRUE_GCODE_TRY(words);
    const auto after = interpreter_.execute(block_, line_.comments);
    CHAINTRUE_GCODE_TRY(after);
    return follow(*after);
  }

  Result<void> other_kind(const SourceLine& raw, std::size_t first) const {
    const std::string_view text = raw.text.substr(first);
    for (const OtherKind& kind : kOtherKinds) {
      if (!text.starts_with(kind.beginning) || (begun_ && text.front() != '<')) continue;
      return refuse(ProblemName::not_a_program, {raw.number, first + 1}, kind.sentence);
    }
    return {};
  }

  static Result<void> line_ends_lost(std::size_t line) {
    return refuse(ProblemName::line_ends_lost, {line, 0}, kLineEndsLost);
  }

  /// The text is the operator's: a plotter's controller shows it, in other programs it is a message.
  Result<void> line_with_text(std::size_t number, const TextLine& text) {
    ++summary_.blocks;
    block_.clear(number);
    std::string word = text.code;
    if (interpreter_.dialect().passes_plotter_codes) {
      word += " " + text.text;
    } else {
      CHAINTRUE_GCODE_TRY(sink_.comment({number, text.text, true}));
    }
    return interpreter_.pass_line(block_, text.comments, std::move(word));
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
    if (holds_moves(raw.text)) return line_ends_lost(raw.number);
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
    interpreter_.note_whole(line);
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
        CHAINTRUE_GCODE_TRY(flow_.leave_program(block_.start()));
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
    CHAINTRUE_GCODE_TRY(more);
    if (!*more) return program.summary();
  }
}

Result<const ProgramEvent*> ProgramStream::peek() {
  while (events_.empty()) {
    const auto more = program_.step();
    CHAINTRUE_GCODE_TRY(more);
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

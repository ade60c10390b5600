// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From lines to executed blocks.
#include "tools/gcode/program.hpp"

#include <cmath>

namespace chaintrue::gcode {
namespace {

/// Files of other kinds, by what they begin with.
struct OtherKind {
  std::string_view beginning;
  const char* sentence;
};
constexpr OtherKind kOtherKinds[] = {
    {"<svg", "this is a drawing (SVG), not a program; make G-code from it with a CAM program"},
    {"<", "this is a web page, not a program; save the raw file (Raw, or Download)"},
    {"{\\rtf", "this is formatted text (RTF), not a program; save it as plain text"},
    {"{", "this is a JSON file, not a program"},
    {"%PDF", "this is a PDF, not a program"},
    {"PK\x03\x04", "this is a ZIP archive, not a program; unpack it"},
    {"solid ", "this is a solid (STL), not a program; make G-code from it with a CAM program"},
};

/// \param begun a line of the program came before
void refuse_other_kind(const SourceLine& raw, std::size_t first, bool begun) {
  const std::string_view text = raw.text.substr(first);
  for (const OtherKind& kind : kOtherKinds) {
    if (!text.starts_with(kind.beginning) || (begun && text.front() != '<')) continue;
    refuse(not_a_program, {raw.number, first + 1}, kind.sentence);
  }
}

[[noreturn]] void lines_lost(std::size_t line) { refuse(line_ends_lost, {line}, kLineEndsLost); }

}  // namespace

bool Program::step() {
  if (ended_) return false;
  SourceLine raw;
  if (!flow_.next(raw)) {
    end_of_file();
    return false;
  }
  summary_.lines = raw.number;
  line(raw);
  return !ended_;
}

void Program::end_of_file() {
  flow_.finish({summary_.lines});
  if (opened_by_percent_) {
    sink_.note(
        {summary_.lines, "no_closing_percent", "the file begins with % but does not end with it"});
  } else {
    sink_.note({summary_.lines, "no_program_end",
                "the program has neither M2, M30 nor %; LinuxCNC would refuse it"});
  }
  return end(summary_.lines, "");
}

void Program::line(const SourceLine& raw) {
  const std::size_t first = raw.text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return;
  refuse_other_kind(raw, first, begun_);
  if (raw.text[first] == '%') return percent(raw);
  // A DOS end-of-file mark.
  if (raw.text.substr(first) == "\x1A") return end(raw.number, "");
  begun_ = true;
  const Dialect& dialect = interpreter_.dialect();
  if (const auto text = text_line(raw.text, dialect.passes_plotter_codes))
    return line_with_text(raw.number, *text);
  clean(raw.text, raw.number, line_);
  block_.clear(raw.number);
  std::size_t at = 0;
  if (peek(at) == '/') {
    if (dialect.skip_deletable_blocks) return;
    block_.deletable = true;
    ++at;
  }
  if (peek(at) == 'n') line_number(at);
  if (peek(at) == 'o') return flow_.control(line_, at);
  ++summary_.blocks;
  if (dialect.passes_plotter_codes) {
    if (const auto word = plotter_word(line_, at, dialect.plotter_home_mm.has_value()))
      return interpreter_.pass_line(line_.comments, word->code, word->words);
  }
  try {
    read_words(ValueReader(line_, interpreter_.parameters(), at), block_,
               dialect.tools_have_no_diameter);
  } catch (const Refusal&) {
    if (holds_moves(line_.text)) lines_lost(raw.number);
    throw;
  }
  interpreter_.execute(line_.comments);
  follow_block();
}

/// The text is the operator's: a plotter's controller shows it, in other programs it is a message.
void Program::line_with_text(std::size_t number, const TextLine& text) {
  ++summary_.blocks;
  block_.clear(number);
  const bool shows = interpreter_.dialect().passes_plotter_codes;
  if (!shows) sink_.comment({number, text.text, true});
  interpreter_.pass_line(text.comments, text.code, shows ? " " + text.text : "");
}

void Program::line_number(std::size_t& at) const {
  const std::size_t start = at + 1;
  at = past_digits(line_.text, start);
  if (at == start)
    refuse(bad_line_number, line_.place(start), "N needs a whole number of at least 0");
  if (peek(at) == '.') at = past_digits(line_.text, at + 1);
}

void Program::percent(const SourceLine& raw) {
  if (holds_moves(raw.text)) lines_lost(raw.number);
  if (!begun_ && !opened_by_percent_) {
    opened_by_percent_ = true;
    return;
  }
  if (!opened_by_percent_) {
    refuse(bad_character, {raw.number, 1}, "a % ends a program only if a % began it");
  }
  return end(raw.number, "%");
}

void Program::end(std::size_t line, std::string_view word) {
  ended_ = true;
  interpreter_.note_whole(line);
  sink_.end(line, word);
}

/// The code of the block that decides what comes next.
void Program::follow_block() {
  if (const KnownCode* flow = block_.code(Group::flow)) {
    if (*flow == m(99)) return flow_.leave_program(block_);
    if (!block_.has('p')) refuse(missing_word, block_, "M98 needs a program number as P");
    const double repeats = block_.find('l').value_or(1.0);
    return flow_.call_program(std::lround(block_.value('p')), std::lround(repeats), block_);
  }
  const KnownCode* stop = block_.code(Group::stop);
  if (stop == nullptr) return;
  if (*stop == m(2) || *stop == m(30)) return end(block_.line, name(*stop));
  interpreter_.pass(*stop);
}

Result<ProgramSummary> run_program(LineSource& source, const Dialect& dialect, Sink& sink) {
  return attempt([&] {
    Program program(source, dialect, sink);
    while (program.step()) {
    }
    return program.summary();
  });
}

const ProgramEvent& ProgramStream::peek() {
  while (events_.empty()) program_.step();
  return events_.front();
}

void ProgramStream::pop() {
  if (events_.front().kind != ProgramEvent::Kind::end) events_.pop_front();
}

void ProgramStream::move(const Move& move) {
  events_.push_back({ProgramEvent::Kind::move, move.line, move, {}});
}

void ProgramStream::word(const PassedWord& word) {
  events_.push_back({ProgramEvent::Kind::word, word.line, {}, word});
}

/// A closing % and the end of the file are equivalent.
void ProgramStream::end(std::size_t line, std::string_view word) {
  const std::string_view text = word == "%" ? "" : word;
  events_.push_back({ProgramEvent::Kind::end, line, {}, {line, std::string(text)}});
}

}  // namespace chaintrue::gcode

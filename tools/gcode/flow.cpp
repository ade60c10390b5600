// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// O-words. An open block is identified by its label; loops return by the file's offset.
#include "tools/gcode/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace chaintrue::gcode {
namespace {

/// LinuxCNC allows ten levels of subroutines.
constexpr std::size_t kDeepestCall = 10;

/// Where a line's O-word may begin: after a slash and a line number.
std::size_t control_start(std::string_view text) {
  std::size_t at = 0;
  if (at < text.size() && text[at] == '/') ++at;
  if (at < text.size() && text[at] == 'n') {
    ++at;
    while (at < text.size() && ((text[at] >= '0' && text[at] <= '9') || text[at] == '.')) ++at;
  }
  return at;
}

bool may_be_control(std::string_view raw) {
  return raw.find_first_of("oO") != std::string_view::npos;
}

}  // namespace

Result<bool> Flow::read(SourceLine& line) {
  line_start_ = source_.position();
  auto more = source_.next(line);
  if (!more || !*more) return more;
  if (line_start_.offset < furthest_) {
    CHAINTRUE_GCODE_TRY(interpreter_.step({line.number, 0}));
  } else {
    furthest_ = source_.position().offset;
  }
  return true;
}

Result<bool> Flow::next(SourceLine& line) { return read(line); }

Result<Flow::ControlLine> Flow::parse(const CleanLine& line, std::size_t at) const {
  ControlLine control;
  ValueReader reader(line, interpreter_.parameters(), at + 1);
  if (reader.peek() == '<') {
    auto name = reader.angle_name();
    CHAINTRUE_GCODE_TRY(name);
    control.label = fmt::format("<{}>", *name);
  } else {
    const auto number = reader.integer();
    CHAINTRUE_GCODE_TRY(number);
    if (*number < 0)
      return refuse(ProblemName::bad_flow, line.place(at), "an O number is not negative");
    control.label = fmt::format("{}", *number);
  }
  struct Name {
    std::string_view text;
    Keyword keyword;
  };
  // Longer words before their prefixes.
  static constexpr Name kNames[] = {
      {"endsub", Keyword::endsub},
      {"sub", Keyword::sub},
      {"call", Keyword::call},
      {"return", Keyword::return_},
      {"endwhile", Keyword::endwhile},
      {"while", Keyword::while_},
      {"do", Keyword::do_},
      {"elseif", Keyword::elseif},
      {"else", Keyword::else_},
      {"endif", Keyword::endif},
      {"if", Keyword::if_},
      {"break", Keyword::break_},
      {"continue", Keyword::continue_},
      {"endrepeat", Keyword::endrepeat},
      {"repeat", Keyword::repeat},
  };
  control.rest = reader.at();
  if (reader.done()) return control;
  for (const Name& name : kNames) {
    if (!reader.accept(name.text)) continue;
    control.keyword = name.keyword;
    control.rest = reader.at();
    return control;
  }
  return refuse(ProblemName::bad_flow,
                reader.place(),
                "after an O-word comes nothing, or one of sub, call, return, if, while, do, repeat "
                "and their ends");
}

Result<void> Flow::control(const CleanLine& line, std::size_t at) {
  const auto control = parse(line, at);
  CHAINTRUE_GCODE_TRY(control);
  return execute(line, *control);
}

Result<void> Flow::execute(const CleanLine& line, const ControlLine& control) {
  switch (control.keyword) {
    case Keyword::program:
      // A program's number; a body for M98.
      bodies_.emplace(control.label, source_.position());
      return {};
    case Keyword::sub:
      return begin_sub(line, control);
    case Keyword::call:
      return call(line, control);
    case Keyword::endsub:
    case Keyword::return_:
      return return_from(line, control);
    case Keyword::while_:
    case Keyword::do_:
    case Keyword::repeat:
      return begin_loop(line, control);
    case Keyword::endwhile:
    case Keyword::endrepeat:
      return end_loop(line, control);
    case Keyword::if_:
    case Keyword::elseif:
    case Keyword::else_:
    case Keyword::endif:
      return condition(line, control);
    case Keyword::break_:
    case Keyword::continue_:
      return jump_out(line, control);
  }
  return {};
}

Result<double> Flow::value(const CleanLine& line, std::size_t at) const {
  ValueReader reader(line, interpreter_.parameters(), at);
  const auto result = reader.bracketed();
  if (!result) return result;
  if (!reader.done())
    return refuse(ProblemName::bad_flow, reader.place(), "nothing may follow the expression");
  return result;
}

Result<std::optional<double>> Flow::optional_value(const CleanLine& line, std::size_t at) const {
  if (at >= line.text.size()) return std::optional<double>{};
  const auto result = value(line, at);
  CHAINTRUE_GCODE_TRY(result);
  return std::optional(*result);
}

Result<Flow::Found> Flow::skip_to(const std::string& label,
                                  std::initializer_list<Keyword> keywords,
                                  Place from) {
  int depth = 0;
  SourceLine raw;
  for (;;) {
    const auto more = read(raw);
    CHAINTRUE_GCODE_TRY(more);
    if (!*more) {
      return refuse(ProblemName::bad_flow,
                    from,
                    fmt::format("the end of o{} does not stand in the file", label));
    }
    if (!may_be_control(raw.text) || !clean(raw.text, raw.number, found_line_)) continue;
    const std::size_t at = control_start(found_line_.text);
    if (at >= found_line_.text.size() || found_line_.text[at] != 'o') continue;
    auto control = parse(found_line_, at);
    if (!control || control->label != label) continue;
    const Keyword keyword = control->keyword;
    const bool wanted = std::find(keywords.begin(), keywords.end(), keyword) != keywords.end();
    if (depth == 0 && wanted) return Found{std::move(*control), line_start_};
    // The same label again, nested: allowed by controllers other than LinuxCNC.
    if (keyword == Keyword::if_ || keyword == Keyword::repeat) ++depth;
    if (keyword == Keyword::endif || keyword == Keyword::endrepeat) --depth;
    depth = std::max(depth, 0);
  }
}

Result<void> Flow::begin_sub(const CleanLine& line, const ControlLine& control) {
  const auto [known, fresh] = defined_at_.emplace(control.label, line.number);
  if (!fresh && known->second != line.number) {
    return refuse(
        ProblemName::bad_flow,
        line.place(0),
        fmt::format(
            "the subroutine o{} is defined already, on line {}", control.label, known->second));
  }
  bodies_.insert_or_assign(control.label, source_.position());
  CHAINTRUE_GCODE_TRY(skip_to(control.label, {Keyword::endsub}, line.place(0)));
  return {};
}

/// Searches to the end of the file, then from its beginning.
Result<LineSource::Position> Flow::find_body(const std::string& label, Place place) {
  if (const auto known = bodies_.find(label); known != bodies_.end()) return known->second;
  const LineSource::Position here = source_.position();
  for (const LineSource::Position from : {here, LineSource::Position{}}) {
    source_.seek(from);
    auto found = skip_to(label, {Keyword::sub, Keyword::program}, place);
    if (found) {
      const LineSource::Position body = source_.position();
      if (found->control.keyword == Keyword::sub) defined_at_.emplace(label, body.lines_before);
      bodies_.emplace(label, body);
      source_.seek(here);
      return body;
    }
    if (found.error().name != ProblemName::bad_flow) return tl::unexpected(found.error());
  }
  source_.seek(here);
  return refuse(
      ProblemName::bad_flow,
      place,
      fmt::format("the subroutine o{} does not stand in this file; other files are not read",
                  label));
}

Result<void> Flow::push_call(OpenCall call, Place place) {
  if (calls_.size() >= kDeepestCall) {
    return refuse(
        ProblemName::bad_flow,
        place,
        fmt::format("subroutines call each other more than {} levels deep", kDeepestCall));
  }
  CHAINTRUE_GCODE_TRY(interpreter_.step(place));
  call.blocks = blocks_.size();
  source_.seek(call.body);
  calls_.push_back(std::move(call));
  interpreter_.set_call_level(calls_.size());
  return {};
}

void Flow::pop_call() {
  blocks_.resize(std::min(blocks_.size(), calls_.back().blocks));
  source_.seek(calls_.back().return_to);
  calls_.pop_back();
  interpreter_.set_call_level(calls_.size());
}

Result<void> Flow::call(const CleanLine& line, const ControlLine& control) {
  std::vector<double> arguments;
  ValueReader reader(line, interpreter_.parameters(), control.rest);
  while (!reader.done()) {
    const auto argument = reader.bracketed();
    CHAINTRUE_GCODE_TRY(argument);
    arguments.push_back(*argument);
  }
  if (arguments.size() > 30)
    return refuse(ProblemName::bad_flow, line.place(0), "a subroutine takes at most 30 arguments");
  OpenCall open;
  open.label = control.label;
  open.return_to = source_.position();
  const auto body = find_body(control.label, line.place(0));
  CHAINTRUE_GCODE_TRY(body);
  open.body = *body;
  CHAINTRUE_GCODE_TRY(push_call(std::move(open), line.place(0)));
  interpreter_.parameters().enter(arguments);
  return {};
}

Result<void> Flow::return_from(const CleanLine& line, const ControlLine& control) {
  if (calls_.empty() || calls_.back().program || calls_.back().label != control.label) {
    return refuse(ProblemName::bad_flow,
                  line.place(0),
                  fmt::format("the subroutine o{} has not been called", control.label));
  }
  const auto result = optional_value(line, control.rest);
  CHAINTRUE_GCODE_TRY(result);
  interpreter_.parameters().leave();
  static_cast<void>(interpreter_.parameters().set("_value", result->value_or(0.0)));
  static_cast<void>(
      interpreter_.parameters().set("_value_returned", result->has_value() ? 1.0 : 0.0));
  pop_call();
  return {};
}

Result<void> Flow::call_program(long number, long repeats, Place place) {
  if (repeats <= 0) return {};
  OpenCall open;
  open.label = fmt::format("{}", number);
  open.return_to = source_.position();
  open.remaining = repeats;
  open.program = true;
  const auto body = find_body(open.label, place);
  CHAINTRUE_GCODE_TRY(body);
  open.body = *body;
  return push_call(std::move(open), place);
}

Result<bool> Flow::leave_program(Place place) {
  if (calls_.empty()) {
    return refuse(ProblemName::bad_flow, place, "M99 in the main program repeats it for ever");
  }
  if (!calls_.back().program) {
    return refuse(
        ProblemName::bad_flow, place, "M99 ends a program called by M98, not an o-word subroutine");
  }
  if (--calls_.back().remaining > 0) {
    CHAINTRUE_GCODE_TRY(interpreter_.step(place));
    blocks_.resize(calls_.back().blocks);
    source_.seek(calls_.back().body);
    return false;
  }
  pop_call();
  return false;
}

Flow::OpenBlock* Flow::innermost(const std::string& label) {
  for (std::size_t i = blocks_.size(); i > floor(); --i) {
    if (blocks_[i - 1].label == label) return &blocks_[i - 1];
  }
  return nullptr;
}

Result<void> Flow::finish(Place place) const {
  if (!calls_.empty()) {
    return refuse(ProblemName::bad_flow,
                  place,
                  fmt::format("the file ends inside the subroutine o{}", calls_.back().label));
  }
  if (!blocks_.empty()) {
    return refuse(ProblemName::bad_flow,
                  {blocks_.back().line, 0},
                  fmt::format("the loop or condition o{} has no end", blocks_.back().label));
  }
  return {};
}

}  // namespace chaintrue::gcode

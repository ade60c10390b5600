// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// O-words. An open block is identified by its label; loops return by the file's offset.
#include "tools/gcode/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"

namespace chaintrue::gcode {
namespace {

/// LinuxCNC allows ten levels of subroutines.
constexpr std::size_t kDeepestCall = 10;

/// Where a line's O-word may begin: after a slash and a line number.
std::size_t control_start(std::string_view text) {
  std::size_t at = text.starts_with('/') ? 1 : 0;
  if (text.substr(at).starts_with('n'))
    at = std::min(text.find_first_not_of("0123456789.", at + 1), text.size());
  return at;
}

bool may_be_control(std::string_view raw) {
  return raw.find_first_of("oO") != std::string_view::npos;
}

}  // namespace

bool Flow::next(SourceLine& line) {
  line_start_ = source_.position();
  if (!source_.next(line)) return false;
  if (line_start_.offset < furthest_) {
    interpreter_.step({line.number});
  } else {
    furthest_ = source_.position().offset;
  }
  return true;
}

/// Longer words before their prefixes.
const Flow::Word Flow::kWords[] = {
    {"endsub", &Flow::return_from},
    {"sub", &Flow::begin_sub, true},
    {"call", &Flow::call},
    {"return", &Flow::return_from},
    {"endwhile", &Flow::end_loop, true},
    {"while", &Flow::begin_loop},
    {"do", &Flow::begin_loop, true},
    {"elseif", &Flow::condition},
    {"else", &Flow::condition, true},
    {"endif", &Flow::condition, true},
    {"if", &Flow::condition},
    {"break", &Flow::jump_out, true},
    {"continue", &Flow::jump_out, true},
    {"endrepeat", &Flow::end_loop, true},
    {"repeat", &Flow::begin_loop},
    {"", &Flow::name_program},
};

Flow::ControlLine Flow::parse(const CleanLine& line, std::size_t at) const {
  std::string label;
  ValueReader reader(line, interpreter_.parameters(), at + 1);
  if (reader.peek() == '<') {
    label = fmt::format("<{}>", reader.angle_name());
  } else {
    const auto number = reader.integer();
    if (number < 0) refuse(bad_flow, line.place(at), "an O number must not be negative");
    label = fmt::format("{}", number);
  }
  for (const Word& word : kWords) {
    if (!reader.accept(word.keyword) || (word.keyword.empty() && !reader.done())) continue;
    return {word, std::move(label), reader.at()};
  }
  refuse(bad_flow, reader.place(),
         "an O-word must be followed by nothing, or by one of sub, call, return, if, while, do, "
         "repeat and their ends");
}

void Flow::control(const CleanLine& line, std::size_t at) {
  const ControlLine control = parse(line, at);
  // LinuxCNC checks this only on lines that it executes, not on those that it skips.
  if (control.stands_alone && control.rest < line.text.size())
    refuse(bad_flow, line.place(control.rest), "nothing may follow {}", control.keyword);
  (this->*control.execute)(line, control);
}

/// A body for M98.
void Flow::name_program(const CleanLine& /*line*/, const ControlLine& control) {
  bodies_.emplace(control.label, source_.position());
}

double Flow::value(const CleanLine& line, std::size_t at) const {
  ValueReader reader(line, interpreter_.parameters(), at);
  const double result = reader.bracketed();
  if (!reader.done()) refuse(bad_flow, reader.place(), "nothing may follow the expression");
  return result;
}

std::optional<Flow::Found> Flow::find(const std::string& label,
                                      std::initializer_list<std::string_view> keywords) {
  int depth = 0;
  SourceLine raw;
  while (next(raw)) {
    if (!may_be_control(raw.text)) continue;
    auto control = attempt([&]() -> std::optional<ControlLine> {
      clean(raw.text, raw.number, found_line_);
      const std::size_t at = control_start(found_line_.text);
      if (at >= found_line_.text.size() || found_line_.text[at] != 'o') return std::nullopt;
      return parse(found_line_, at);
    });
    if (!control || !*control || (*control)->label != label) continue;
    const std::string_view keyword = (*control)->keyword;
    if (depth == 0 && grid::contains(keywords, keyword))
      return Found{std::move(**control), line_start_};
    // The same label again, nested: allowed by controllers other than LinuxCNC.
    if (keyword == "if" || keyword == "repeat") ++depth;
    if (keyword == "endif" || keyword == "endrepeat") --depth;
    depth = std::max(depth, 0);
  }
  return std::nullopt;
}

Flow::Found Flow::skip_to(const std::string& label,
                          std::initializer_list<std::string_view> keywords, Place from) {
  auto found = find(label, keywords);
  if (found) return std::move(*found);
  refuse(bad_flow, from, "the file has no end of o{}", label);
}

void Flow::begin_sub(const CleanLine& line, const ControlLine& control) {
  const auto [known, fresh] = defined_at_.emplace(control.label, line.number);
  if (!fresh && known->second != line.number) {
    refuse(bad_flow, line, "the subroutine o{} is already defined on line {}", control.label,
           known->second);
  }
  bodies_.insert_or_assign(control.label, source_.position());
  skip_to(control.label, {"endsub"}, line);
}

/// Searches to the end of the file, then from its beginning.
LineSource::Position Flow::find_body(const std::string& label, Place place) {
  if (const auto known = bodies_.find(label); known != bodies_.end()) return known->second;
  const LineSource::Position here = source_.position();
  for (const LineSource::Position from : {here, LineSource::Position{}}) {
    source_.seek(from);
    const auto found = find(label, {"sub", ""});
    if (!found) continue;
    const LineSource::Position body = source_.position();
    if (found->control.keyword == "sub") defined_at_.emplace(label, body.lines_before);
    bodies_.emplace(label, body);
    source_.seek(here);
    return body;
  }
  refuse(bad_flow, place, "the subroutine o{} is not in this file; other files are not read",
         label);
}

void Flow::push_call(OpenCall call, Place place) {
  if (calls_.size() >= kDeepestCall) {
    refuse(bad_flow, place, "subroutines call each other more than {} levels deep", kDeepestCall);
  }
  interpreter_.step(place);
  call.blocks = blocks_.size();
  source_.seek(call.body);
  calls_.push_back(std::move(call));
  interpreter_.set_call_level(calls_.size());
}

void Flow::pop_call() {
  blocks_.resize(std::min(blocks_.size(), calls_.back().blocks));
  source_.seek(calls_.back().return_to);
  calls_.pop_back();
  interpreter_.set_call_level(calls_.size());
}

void Flow::call(const CleanLine& line, const ControlLine& control) {
  std::vector<double> arguments;
  ValueReader reader(line, interpreter_.parameters(), control.rest);
  while (!reader.done()) {
    arguments.push_back(reader.bracketed());
  }
  if (arguments.size() > 30) refuse(bad_flow, line, "a subroutine takes at most 30 arguments");
  OpenCall open;
  open.label = control.label;
  open.return_to = source_.position();
  open.body = find_body(control.label, line);
  push_call(std::move(open), line);
  interpreter_.parameters().enter(arguments);
}

void Flow::return_from(const CleanLine& line, const ControlLine& control) {
  if (calls_.empty() || calls_.back().program || calls_.back().label != control.label) {
    refuse(bad_flow, line, "the subroutine o{} has not been called", control.label);
  }
  const bool returns = control.rest < line.text.size();
  const double result = returns ? value(line, control.rest) : 0.0;
  Parameters& parameters = interpreter_.parameters();
  parameters.leave();
  parameters.set("_value", result);
  parameters.set("_value_returned", returns ? 1.0 : 0.0);
  pop_call();
}

void Flow::call_program(long number, long repeats, Place place) {
  if (repeats <= 0) return;
  OpenCall open;
  open.label = fmt::format("{}", number);
  open.return_to = source_.position();
  open.remaining = repeats;
  open.program = true;
  open.body = find_body(open.label, place);
  push_call(std::move(open), place);
}

void Flow::leave_program(Place place) {
  if (calls_.empty()) {
    refuse(bad_flow, place, "M99 in the main program repeats it forever");
  }
  if (!calls_.back().program) {
    refuse(bad_flow, place, "M99 ends a program called by M98, not an o-word subroutine");
  }
  if (--calls_.back().remaining > 0) {
    interpreter_.step(place);
    blocks_.resize(calls_.back().blocks);
    source_.seek(calls_.back().body);
    return;
  }
  pop_call();
}

Flow::OpenBlock* Flow::innermost(const std::string& label) {
  for (std::size_t i = blocks_.size(); i > floor(); --i) {
    if (blocks_[i - 1].label == label) return &blocks_[i - 1];
  }
  return nullptr;
}

void Flow::finish(Place place) const {
  if (!calls_.empty()) {
    refuse(bad_flow, place, "the file ends inside the subroutine o{}", calls_.back().label);
  }
  if (!blocks_.empty()) {
    refuse(bad_flow, {blocks_.back().line, 0}, "the loop or condition o{} has no end",
           blocks_.back().label);
  }
}

}  // namespace chaintrue::gcode

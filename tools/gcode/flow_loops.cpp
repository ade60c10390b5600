// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Loops and conditions: while, do, repeat, if, and the ways out of them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/gcode/flow.hpp"

namespace chaintrue::gcode {
namespace {

constexpr std::size_t kDeepestBlock = 1000;

}  // namespace

void Flow::open_block(OpenBlock block, Place place) {
  if (blocks_.size() >= kDeepestBlock)
    refuse(bad_flow, place, "loops and conditions are nested too deeply");
  blocks_.push_back(std::move(block));
}

void Flow::close(const OpenBlock* block) {
  blocks_.resize(static_cast<std::size_t>(block - blocks_.data()));
}

void Flow::begin_loop(const CleanLine& line, const ControlLine& control) {
  OpenBlock block{control.label, control.keyword, line_start_, 0, line.number};
  if (control.keyword == "do") {
    if (control.rest < line.text.size())
      refuse(bad_flow, line.place(control.rest), "nothing may follow do");
    block.start = source_.position();
    return open_block(std::move(block), line);
  }
  const double count = value(line, control.rest);
  if (control.keyword == "repeat") {
    block.start = source_.position();
    // An expression may differ from a whole number by rounding.
    if (std::fabs(count - std::round(count)) > 0.0001) {
      refuse(bad_flow, line.place(control.rest), "a loop count must be a whole number, not {}",
             count);
    }
    block.remaining = static_cast<long>(std::clamp(std::round(count), -1.0, 1e15));
    if (block.remaining <= 0) {
      skip_to(control.label, {"endrepeat"}, line);
      return;
    }
    return open_block(std::move(block), line);
  }
  OpenBlock* open = innermost(control.label);
  if (open != nullptr && open->kind == "do") {  // do ... while
    if (count == 0.0) return close(open);
    close(open + 1);
    interpreter_.step(line);
    return source_.seek(open->start);
  }
  if (count == 0.0) {
    skip_to(control.label, {"endwhile"}, line);
    return;
  }
  open_block(std::move(block), line);
}

void Flow::end_loop(const CleanLine& line, const ControlLine& control) {
  const std::string_view kind = control.keyword == "endwhile" ? "while" : "repeat";
  OpenBlock* open = innermost(control.label);
  if (open == nullptr || open->kind != kind) {
    refuse(bad_flow, line, "o{} ends a loop that does not begin here", control.label);
  }
  interpreter_.step(line);
  if (kind == "repeat" && --open->remaining <= 0) return close(open);
  source_.seek(open->start);
  // `while` is read again, and reopens its block if its condition holds.
  close(kind == "repeat" ? open + 1 : open);
}

void Flow::condition(const CleanLine& line, const ControlLine& control) {
  OpenBlock* open = innermost(control.label);
  const bool begins = control.keyword == "if";
  if (!begins && (open == nullptr || open->kind != "if")) {
    refuse(bad_flow, line, "o{} continues a condition that does not begin here", control.label);
  }
  if (!begins) {  // the executed branch is over
    close(open);
    if (control.keyword == "endif") return;
    if (control.keyword == "elseif") value(line, control.rest);
    skip_to(control.label, {"endif"}, line);
    return;
  }
  double holds = value(line, control.rest);
  while (holds == 0.0) {
    const auto branch = skip_to(control.label, {"elseif", "else", "endif"}, line);
    if (branch.control.keyword == "endif") return;
    if (branch.control.keyword == "else") break;
    holds = value(found_line_, branch.control.rest);
  }
  open_block({control.label, "if", {}, 0, line.number}, line);
}

void Flow::jump_out(const CleanLine& line, const ControlLine& control) {
  OpenBlock* open = innermost(control.label);
  if (open == nullptr || open->kind == "if") {
    refuse(bad_flow, line, "o{} is not a loop that could be left here", control.label);
  }
  const std::string_view end = open->kind == "repeat" ? "endrepeat"
                               : open->kind == "do"   ? "while"
                                                      : "endwhile";
  const auto found = skip_to(control.label, {end}, line);
  if (control.keyword == "break") return close(open);
  // continue: the condition at the loop's end is evaluated next.
  close(open + 1);
  source_.seek(found.before);
}

}  // namespace chaintrue::gcode

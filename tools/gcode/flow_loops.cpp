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

void Flow::begin_loop(const CleanLine& line, const ControlLine& control) {
  OpenBlock block{control.label, control.keyword, line_start_, 0, line.number};
  if (control.keyword == Keyword::do_) {
    if (control.rest < line.text.size())
      refuse(bad_flow, line.place(control.rest), "nothing may follow do");
    block.start = source_.position();
    return open_block(std::move(block), line.place(0));
  }
  const double count = value(line, control.rest);
  if (control.keyword == Keyword::repeat) {
    block.start = source_.position();
    // An expression may differ from a whole number by rounding.
    if (std::fabs(count - std::round(count)) > 0.0001) {
      refuse(
          bad_flow, line.place(control.rest), "a loop count must be a whole number, not {}", count);
    }
    block.remaining = static_cast<long>(std::clamp(std::round(count), -1.0, 1e15));
    if (block.remaining <= 0) {
      skip_to(control.label, {Keyword::endrepeat}, line.place(0));
      return;
    }
    return open_block(std::move(block), line.place(0));
  }
  OpenBlock* open = innermost(control.label);
  if (open != nullptr && open->kind == Keyword::do_) {  // do ... while
    const LineSource::Position start = open->start;
    blocks_.resize(static_cast<std::size_t>(open - blocks_.data()) + (count != 0.0 ? 1U : 0U));
    if (count == 0.0) return;
    interpreter_.step(line.place(0));
    source_.seek(start);
    return;
  }
  if (count == 0.0) {
    skip_to(control.label, {Keyword::endwhile}, line.place(0));
    return;
  }
  open_block(std::move(block), line.place(0));
}

void Flow::end_loop(const CleanLine& line, const ControlLine& control) {
  const Keyword kind = control.keyword == Keyword::endwhile ? Keyword::while_ : Keyword::repeat;
  OpenBlock* open = innermost(control.label);
  if (open == nullptr || open->kind != kind) {
    refuse(bad_flow, line.place(0), "o{} ends a loop that does not begin here", control.label);
  }
  interpreter_.step(line.place(0));
  const LineSource::Position start = open->start;
  const auto index = static_cast<std::size_t>(open - blocks_.data());
  if (kind == Keyword::repeat && --open->remaining <= 0) {
    blocks_.resize(index);
    return;
  }
  // `while` is read again, and reopens its block if its condition holds.
  blocks_.resize(kind == Keyword::repeat ? index + 1 : index);
  source_.seek(start);
}

void Flow::condition(const CleanLine& line, const ControlLine& control) {
  OpenBlock* open = innermost(control.label);
  const bool begins = control.keyword == Keyword::if_;
  if (!begins && (open == nullptr || open->kind != Keyword::if_)) {
    refuse(bad_flow,
           line.place(0),
           "o{} continues a condition that does not begin here",
           control.label);
  }
  if (!begins) {  // the executed branch is over
    blocks_.resize(static_cast<std::size_t>(open - blocks_.data()));
    if (control.keyword == Keyword::endif) return;
    skip_to(control.label, {Keyword::endif}, line.place(0));
    return;
  }
  double holds = value(line, control.rest);
  while (holds == 0.0) {
    const auto branch =
        skip_to(control.label, {Keyword::elseif, Keyword::else_, Keyword::endif}, line.place(0));
    if (branch.control.keyword == Keyword::endif) return;
    if (branch.control.keyword == Keyword::else_) break;
    holds = value(found_line_, branch.control.rest);
  }
  open_block({control.label, Keyword::if_, {}, 0, line.number}, line.place(0));
}

void Flow::jump_out(const CleanLine& line, const ControlLine& control) {
  OpenBlock* open = innermost(control.label);
  if (open == nullptr || open->kind == Keyword::if_) {
    refuse(bad_flow, line.place(0), "o{} is not a loop that could be left here", control.label);
  }
  const OpenBlock loop = *open;
  const auto index = static_cast<std::size_t>(open - blocks_.data());
  const Keyword end = loop.kind == Keyword::repeat ? Keyword::endrepeat
                      : loop.kind == Keyword::do_  ? Keyword::while_
                                                   : Keyword::endwhile;
  const auto found = skip_to(control.label, {end}, line.place(0));
  if (control.keyword == Keyword::break_) {
    blocks_.resize(index);
    return;
  }
  // continue: the condition at the loop's end is evaluated next.
  blocks_.resize(index + 1);
  source_.seek(found.before);
}

}  // namespace chaintrue::gcode

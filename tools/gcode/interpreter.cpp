// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The order in which a block's words are executed, and everything that is not motion.
#include "tools/gcode/interpreter.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace chaintrue::gcode {

Interpreter::Interpreter(const Dialect& dialect, const Block& block, Sink& sink)
    : dialect_(dialect),
      block_(block),
      sink_(sink),
      parameters_([this](std::string_view name) { return state(name); }) {}

void Interpreter::step(Place place) {
  if (++steps_ <= dialect_.step_budget) return;
  refuse(step_budget, place,
         "the program has taken {} steps in loops, subroutines and cycles without "
         "reaching its end",
         dialect_.step_budget);
}

void Interpreter::note(std::string_view name, std::string sentence,
                       std::optional<ProblemName> problem) const {
  sink_.note({block_.line, name, std::move(sentence), problem});
}

void Interpreter::note_once(std::string_view name, std::string sentence,
                            std::optional<ProblemName> problem) {
  if (noted_.insert(name).second) note(name, std::move(sentence), problem);
}

void Interpreter::note_deletable() {
  if (!block_.deletable) return;
  note_once("deletable_line",
            "a line begins with a slash; it is executed, as with the block delete switch off");
}

void Interpreter::note_whole(std::size_t last_line) {
  if (!moves_) {
    return sink_.note(
        {last_line, "moves_nothing", "the program does not move the tool", moves_nothing});
  }
  if (long_arcs_ > 1 && long_arcs_ == arcs_) {
    sink_.note(
        {first_long_arc_, "arcs_long",
         fmt::format("each of the {} arcs, beginning with this one, is longer than half a circle: "
                     "are G2 and G3 exchanged?",
                     arcs_)});
  }
  std::vector<std::string> left;
  if (modes_.incremental) left.emplace_back("relative coordinates (G91)");
  if (modes_.inches) left.emplace_back("inches (G20)");
  if (modes_.system != 1) left.push_back(system_name());
  if (frame_.offset != Axes{}) left.emplace_back("an offset (G92 or G52)");
  if (left.empty()) return;
  sink_.note({last_line, "state_left",
              fmt::format("the program ends with {} in force, which affects the next program",
                          fmt::join(left, ", "))});
}

void Interpreter::pass_line(const std::vector<CommentText>& texts, Code code,
                            std::string_view words) {
  note_deletable();
  comments(texts);
  PassedWord passed{block_.line, name(code).append(words), code};
  if (code == g::home) {
    moves_ = passed.moves_itself = true;
    for (const std::size_t axis : {0, 1}) {
      if (!words.empty() && words.find(upper(kAxisLetters[axis])) == std::string_view::npos)
        continue;
      passed.leaves_xy = placed_[axis] = true;
      machine_[axis] = dialect_.plotter_home_mm.value_or(std::array{0.0, 0.0})[axis];
    }
  }
  sink_.word(passed);
}

void Interpreter::execute(const std::vector<CommentText>& texts) {
  note_deletable();
  for (const KnownCode* code : block_.codes) {
    if (code != nullptr) sink_.code(block_.line, *code);
  }
  const int motion = motion_to_be();
  check_assignments();
  check_words(motion);
  assign();
  comments(texts);
  set_feed(motion);
  pass_words();
  dwell();
  set_modes();
  tool_length();
  once();
  if (motion >= 0) {
    if (!std::exchange(units_stated_, true)) {
      note("units_assumed", "the program moves before G20 or G21; millimetres are assumed");
    }
    move(motion);
  }
}

/// The motion of this block, or -1.
int Interpreter::motion_to_be() const {
  const KnownCode* motion = block_.code(Group::motion);
  const KnownCode* once_code = block_.code(Group::once);
  const bool once_takes_axes = once_code != nullptr && once_code->uses('x');
  const bool length_takes_axes = block_.is(g::tool_length_stated);
  const bool centre = block_.has('i') || block_.has('j') || block_.has('k');
  if (once_takes_axes && length_takes_axes) {
    refuse(modal_conflict, block_, "two codes on the line use its axis words");
  }
  if (motion != nullptr && motion->uses('x')) {
    if (once_takes_axes || length_takes_axes) {
      refuse(modal_conflict, block_, "two codes on the line use its axis words");
    }
    return motion->tenths;
  }
  if (once_takes_axes || length_takes_axes) return -1;
  if (!block_.has_axes() && !(centre && is_arc(modes_.motion))) return -1;
  if (motion != nullptr || modes_.motion == g::no_motion) {
    refuse(no_motion_mode, block_,
           "there are axis words, but no motion (G0, G1, G2, G3 ...) is in force that could use "
           "them");
  }
  return modes_.motion;
}

void Interpreter::check_assignments() const {
  for (const Assignment& assignment : block_.assignments) {
    const bool fixed = assignment.index != 0 ? !parameters_.writable(assignment.index)
                                             : state(assignment.name).has_value();
    if (fixed) refuse(bad_parameter, assignment.place, "this parameter can only be read");
  }
}

void Interpreter::assign() {
  for (const Assignment& assignment : block_.assignments) {
    if (assignment.index != 0) {
      parameters_.set(assignment.index, assignment.value);
    } else {
      parameters_.set(assignment.name, assignment.value);
    }
  }
}

std::string Interpreter::written_out(std::string_view text) const {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] != '#') {
      result.push_back(text[at++]);
      continue;
    }
    const auto end_of = [&](std::size_t from) {
      if (from < text.size() && text[from] == '<') {
        const std::size_t close = text.find('>', from);
        return close == std::string_view::npos ? text.size() : close + 1;
      }
      return past_digits(text, from);
    };
    const std::size_t end = end_of(at + 1);
    const auto value = attempt([&] {
      CleanLine line;
      clean(text.substr(at, end - at), 1, line);
      return ValueReader(line, parameters_).real();
    });
    // Half a unit of the last digit keeps a rounding error from printing as minus zero.
    const bool zero = value && std::fabs(*value) < 5e-7;
    result += value ? fmt::format("{:.6f}", zero ? 0.0 : *value) : std::string("######");
    at = end;
  }
  return result;
}

void Interpreter::comments(const std::vector<CommentText>& texts) {
  for (const CommentText& text : texts) {
    if (text.semicolon && holds_moves(text.text)) {
      note("line_ends_lost", kLineEndsLost, line_ends_lost);
      moves_ = true;  // which is reported by one problem
    }
    Comment comment{block_.line, text.text, false};
    std::string_view body = text.text;
    body.remove_prefix(std::min(body.find_first_not_of(" \t"), body.size()));
    const std::size_t comma = body.find(',');
    if (!text.semicolon && comma != std::string_view::npos) {
      std::string head(body.substr(0, comma));
      for (char& c : head) c = lower(c);
      const bool expands = head == "debug" || head == "print";
      if (expands || head == "msg") {
        comment.message = true;
        comment.text =
            expands ? written_out(body.substr(comma + 1)) : std::string(body.substr(comma + 1));
      }
    }
    sink_.comment(comment);
  }
}

void Interpreter::set_feed(int motion) {
  if (const KnownCode* mode = block_.code(Group::feed_mode)) {
    const FeedMode next =
        mode->tenths == g::inverse_time ? FeedMode::inverse_time : FeedMode::per_minute;
    // A feed rate of the other mode has no meaning; LinuxCNC clears it with every G94 that follows
    // G93.
    if (next != modes_.feed_mode) modes_.feed = 0.0;
    modes_.feed_mode = next;
  }
  const bool inverse = modes_.feed_mode == FeedMode::inverse_time;
  if (block_.has('f')) {
    if (block_.code(Group::units) != nullptr && block_.is(g::inches) != modes_.inches && !inverse) {
      note("feed_before_units",
           "F and a change of units are on one line: F is read in the old unit here, but "
           "other controllers use the new one");
    }
    modes_.feed = inverse ? block_.value('f') : length('f');
  }
  const bool feeds = motion == g::line || is_arc(motion) || is_cycle(motion) || is_probe(motion);
  if (!feeds) return;
  if (inverse && is_cycle(motion)) {
    refuse(bad_cycle, block_, "a canned cycle cannot run with inverse time feed (G93)");
  }
  if (inverse && !block_.has('f')) {
    refuse(no_feed_rate, block_, "with inverse time feed (G93) every feed move needs its own F");
  }
  if (!(modes_.feed > 0.0)) {
    refuse(no_feed_rate, block_, "no feed rate (F) is set for this move, or it is zero");
  }
}

void Interpreter::set_modes() {
  if (const KnownCode* plane = block_.code(Group::plane)) modes_.plane = plane->tenths;
  if (const KnownCode* units = block_.code(Group::units)) {
    modes_.inches = units->tenths == g::inches;
    units_stated_ = true;
  }
  if (const KnownCode* system = block_.code(Group::system)) {
    select_system(system->tenths <= g::system_6 ? (system->tenths - g::system_1) / 10 + 1
                                                : system->tenths - g::system_7 + 7);
  }
  if (const KnownCode* distance = block_.code(Group::distance))
    modes_.incremental = distance->tenths == g::incremental;
  if (const KnownCode* centres = block_.code(Group::arc_distance)) {
    modes_.absolute_centres = centres->tenths == g::absolute_centres;
    note_once(
        "dotted_code",
        "the classic Maslow firmware reads G91.1 as G91 and G90.1 as G90; the compensated file "
        "has neither");
  }
  if (block_.is(g::no_motion)) modes_.motion = g::no_motion;
  if (const KnownCode* retract = block_.code(Group::retract))
    modes_.retract_to_r = retract->tenths == g::retract_to_r;
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words: which code uses which, which must be whole numbers, and which are passed through.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "tools/gcode/interpreter.hpp"

namespace chaintrue::gcode {
namespace {

/// LinuxCNC accepts a value as a whole number if it is this near to one.
constexpr double kWhole = 0.0001;

bool uses(const KnownCode& code, char letter) {
  return code.uses(letter) || code.uses(upper(letter));
}

/// The supported codes that use a letter.
std::string users_of(char letter) {
  std::vector<std::string> names;
  for (const KnownCode& code : known_codes()) {
    if (code.refusal == nullptr && uses(code, letter)) names.push_back(name(code));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The code of the line that a word belongs to. With two, its meaning depends on the controller.
const KnownCode& user_of(char letter, const Block& block, int motion) {
  const KnownCode* user = nullptr;
  const auto look = [&](const KnownCode* code) {
    if (code == nullptr || !uses(*code, letter)) return;
    if (user != nullptr) {
      refuse(bad_word_value, block.place(letter),
             "the {} word could belong to two codes on this line; write each on a "
             "separate line",
             upper(letter));
    }
    user = code;
  };
  look(find({'G', motion}));
  for (const KnownCode* code : block.codes) {
    if (code != block.code(Group::motion)) look(code);
  }
  if (user != nullptr) return *user;
  if (letter == 'e') {
    refuse(unsupported_axis, block.place('e'),
           "an E word (the extruder of a 3D printer) has no meaning on a router");
  }
  refuse(unused_word, block.place(letter), "nothing on the line uses the {} word; it belongs to {}",
         upper(letter), users_of(letter));
}

void check_whole(const Block& block, char letter, std::string_view whose) {
  const double value = block.value(letter);
  if (value >= 0.0 && std::fabs(value - std::round(value)) <= kWhole) return;
  refuse(bad_word_value, block.place(letter),
         "{}{} must be a whole number of at least 0; here it is {}", upper(letter), whose,
         with_value("", value));
}

void check_complete(const Block& block, const KnownCode& code) {
  for (const char letter : code.words) {
    if (!block.has(lower(letter)))
      refuse(missing_word, block, "{} needs {}", name(code), upper(letter));
  }
}

}  // namespace

void Interpreter::check_words(int motion) const {
  for (const char letter : {'u', 'v', 'w'}) {
    if (block_.has(letter)) {
      refuse(unsupported_axis, block_.place(letter), "the axis {} is not supported", upper(letter));
    }
  }
  for (const char letter : std::string_view("dehijklpqr")) {
    if (!block_.has(letter)) continue;
    const KnownCode& user = user_of(letter, block_, motion);
    if (user.uses(upper(letter))) check_whole(block_, letter, " of " + name(user));
  }
  if (block_.is(g::machine_frame)) {
    if (motion != g::rapid && motion != g::line)
      refuse(bad_word_value, block_, "G53 needs G0 or G1 and axis words");
    const bool incremental =
        block_.code(Group::distance) ? block_.is(g::incremental) : modes_.incremental;
    if (incremental) refuse(modal_conflict, block_, "G53 cannot be used in G91");
  }
  for (const char letter : {'s', 't', 'f'}) {
    if (block_.has(letter) && block_.value(letter) < 0.0) {
      refuse(bad_word_value, block_.place(letter), "{} is negative", upper(letter));
    }
  }
  if (block_.has('t')) check_whole(block_, 't', ", a tool's number,");
}

void Interpreter::pass(Code code, std::string_view words) const {
  sink_.word({block_.line, name(code).append(words), code});
}

void Interpreter::pass_with_words(const KnownCode& code, double unit) const {
  std::string words;
  for (const char letter : code.words) {
    if (!block_.has(lower(letter))) continue;
    const double value = block_.value(lower(letter));
    const bool is_whole = letter == upper(letter);
    words +=
        with_value(std::string{' ', upper(letter)}, is_whole ? std::round(value) : value * unit);
  }
  pass(code, words);
}

void Interpreter::pass_words() {
  if (block_.has('s')) {
    modes_.spindle_rpm = block_.value('s');
    sink_.word({block_.line, with_value("S", modes_.spindle_rpm)});
  }
  if (block_.has('t')) {
    modes_.selected_tool = std::lround(block_.value('t'));
    sink_.word({block_.line, fmt::format("T{}", modes_.selected_tool)});
  }
  if (const KnownCode* output = block_.code(Group::output)) {
    check_complete(block_, *output);
    pass_with_words(*output);
  }
  if (const KnownCode* tool = block_.code(Group::tool)) {
    check_complete(block_, *tool);
    modes_.tool = *tool == m(61) ? std::lround(block_.value('q')) : modes_.selected_tool;
    pass_with_words(*tool);
  }
  if (const KnownCode* spindle = block_.code(Group::spindle)) {
    modes_.spindle = *spindle == m(5) ? 0 : spindle->tenths / 10;
    pass(*spindle);
  }
  if (const KnownCode* coolant = block_.code(Group::coolant)) pass(*coolant);
  if (const KnownCode* changed = block_.code(Group::override)) pass_with_words(*changed);
}

void Interpreter::dwell() {
  if (!block_.is(g::dwell)) return;
  if (!block_.has('p') || block_.value('p') < 0.0)
    refuse(missing_word, block_, "G4 needs a time P of at least 0");
  note_once("dwell_unit",
            "G4 P is in seconds here but in milliseconds on the classic Maslow firmware; P is not "
            "changed");
  pass(g::dwell, with_value(" P", block_.value('p')));
}

void Interpreter::tool_length() {
  // G41 and G42 reach this point only if tools have no diameter.
  if (block_.is(g::cutter_off)) pass(g::cutter_off);
  if (block_.is(g::tool_length_stated)) {
    if (block_.has('x') || block_.has('y') || block_.has('a') || block_.has('b') ||
        block_.has('c')) {
      refuse(unsupported_code, block_,
             "a tool offset (G43.1) in an axis other than Z moves the "
             "path");
    }
    pass(g::tool_length_stated, block_.has('z') ? with_value(" Z", length('z')) : std::string());
  } else if (const KnownCode* code = block_.code(Group::tool_length)) {
    pass_with_words(*code);
  }
  if (block_.is(g::exact_stop)) {
    // Some controllers misread its dot.
    pass(g::exact_path);
  } else if (const KnownCode* control = block_.code(Group::path_control)) {
    // check_words has ensured that P and Q belong to no other code of the line.
    pass_with_words(*control, mm_per_unit());
  }
}

}  // namespace chaintrue::gcode

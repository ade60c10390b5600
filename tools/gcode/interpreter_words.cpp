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

/// Of all codes that are supported.
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
      refuse(
          bad_word_value,
          block.place(letter),
          fmt::format("the {} word could belong to two codes of this line; write each of them on "
                      "a line of its own",
                      upper(letter)));
    }
    user = code;
  };
  look(find({'G', motion}));
  for (const KnownCode* code : block.codes) {
    if (code != block.code(Group::motion)) look(code);
  }
  if (user != nullptr) return *user;
  if (letter == 'e') {
    refuse(unsupported_axis,
           block.place('e'),
           "an E word (the extruder of a 3D printer) has no meaning on a router");
  }
  refuse(unused_word,
         block.place(letter),
         fmt::format("nothing on the line uses the {} word; it belongs to {}",
                     upper(letter),
                     users_of(letter)));
}

void check_whole(const Block& block, char letter, std::string_view whose) {
  const double value = block.value(letter);
  if (value >= 0.0 && std::fabs(value - std::round(value)) <= kWhole) return;
  refuse(bad_word_value,
         block.place(letter),
         fmt::format("{}{} is a whole number, not below zero; here it is {}",
                     upper(letter),
                     whose,
                     with_value("", value)));
}

void check_complete(const Block& block, const KnownCode& code) {
  for (const char letter : code.words) {
    if (!block.has(lower(letter)))
      refuse(missing_word, block, fmt::format("{} needs {}", name(code), upper(letter)));
  }
}

long whole(double value) { return std::lround(value); }

}  // namespace

void Interpreter::check_words(const Block& block, int motion) const {
  for (const char letter : {'u', 'v', 'w'}) {
    if (block.has(letter)) {
      refuse(unsupported_axis,
             block.place(letter),
             fmt::format("the axis {} is not supported", upper(letter)));
    }
  }
  for (const char letter : std::string_view("dehijklpqr")) {
    if (!block.has(letter)) continue;
    const KnownCode& user = user_of(letter, block, motion);
    if (user.uses(upper(letter))) check_whole(block, letter, " of " + name(user));
  }
  if (block.is(g::machine_frame)) {
    if (motion != g::rapid && motion != g::line)
      refuse(bad_word_value, block, "G53 needs G0 or G1 and axis words");
    const bool incremental =
        block.code(Group::distance) ? block.is(g::incremental) : modes_.incremental;
    if (incremental) refuse(modal_conflict, block, "G53 cannot be used in G91");
  }
  for (const char letter : {'s', 't', 'f'}) {
    if (block.has(letter) && block.value(letter) < 0.0) {
      refuse(bad_word_value, block.place(letter), fmt::format("{} is negative", upper(letter)));
    }
  }
  if (block.has('t')) check_whole(block, 't', ", a tool's number,");
}

void Interpreter::pass(const Block& block, Code code, std::string_view words) const {
  sink_.word({block.line, name(code).append(words), code});
}

void Interpreter::pass_with_words(const Block& block, const KnownCode& code, double unit) const {
  std::string words;
  for (const char letter : code.words) {
    if (!block.has(lower(letter))) continue;
    const double value = block.value(lower(letter));
    const bool is_whole = letter == upper(letter);
    words +=
        with_value(std::string{' ', upper(letter)}, is_whole ? std::round(value) : value * unit);
  }
  pass(block, code, words);
}

void Interpreter::pass_words(const Block& block) {
  if (block.has('s')) {
    modes_.spindle_rpm = block.value('s');
    sink_.word({block.line, with_value("S", modes_.spindle_rpm)});
  }
  if (block.has('t')) {
    modes_.selected_tool = whole(block.value('t'));
    sink_.word({block.line, fmt::format("T{}", modes_.selected_tool)});
  }
  if (const KnownCode* output = block.code(Group::output)) {
    check_complete(block, *output);
    pass_with_words(block, *output);
  }
  if (const KnownCode* tool = block.code(Group::tool)) {
    check_complete(block, *tool);
    modes_.tool = *tool == m(61) ? whole(block.value('q')) : modes_.selected_tool;
    pass_with_words(block, *tool);
  }
  if (const KnownCode* spindle = block.code(Group::spindle)) {
    modes_.spindle = *spindle == m(5) ? 0 : spindle->tenths / 10;
    pass(block, *spindle);
  }
  if (const KnownCode* coolant = block.code(Group::coolant)) pass(block, *coolant);
  if (const KnownCode* changed = block.code(Group::override)) pass_with_words(block, *changed);
}

void Interpreter::dwell(const Block& block) {
  if (!block.is(g::dwell)) return;
  if (!block.has('p') || block.value('p') < 0.0)
    refuse(missing_word, block, "G4 needs its time as P, not below zero");
  note_once(
      {block.line,
       "dwell_unit",
       "G4 counts P in seconds here, in milliseconds on the classic Maslow firmware; P passes "
       "unchanged"});
  pass(block, g::dwell, with_value(" P", block.value('p')));
}

void Interpreter::tool_length(const Block& block) {
  // G41 and G42 reach this point only if tools have no diameter.
  if (block.is(g::cutter_off)) pass(block, g::cutter_off);
  if (block.is(g::tool_length_stated)) {
    if (block.has('x') || block.has('y') || block.has('a') || block.has('b') || block.has('c')) {
      refuse(unsupported_code, block, "a tool offset (G43.1) in any axis but Z moves the path");
    }
    pass(block,
         g::tool_length_stated,
         block.has('z') ? with_value(" Z", length(block, 'z')) : std::string());
  } else if (const KnownCode* code = block.code(Group::tool_length)) {
    pass_with_words(block, *code);
  }
  if (block.is(g::exact_stop)) {
    // Some controllers misread its dot.
    pass(block, g::exact_path);
  } else if (const KnownCode* control = block.code(Group::path_control)) {
    // check_words has ensured that P and Q belong to no other code of the line.
    pass_with_words(block, *control, mm_per_unit());
  }
}

}  // namespace chaintrue::gcode

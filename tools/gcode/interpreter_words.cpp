// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words: which code uses which, which must be whole numbers, and which are passed through.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {
namespace {

/// LinuxCNC accepts a value as a whole number if it is this near to one.
constexpr double kWhole = 0.0001;

bool one_of(int value, std::initializer_list<int> list) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

int tenths(const GCode* code) { return code == nullptr ? -1 : code->tenths; }
int number(const MCode* code) { return code == nullptr ? -1 : code->number; }

/// Number of codes in a line that use a word of one of these letters. With two, its meaning depends
/// on the controller.
struct WordUse {
  std::string_view letters;
  int (*users)(const Block&, int motion);
  const char* codes;
};

int g64(const Block& b) { return b.is(g::blend) ? 1 : 0; }
bool m98(const Block& b) { return number(b.code(MGroup::flow)) == 98; }

constexpr WordUse kWordUses[] = {
    {"d",
     [](const Block& b, int) {
       return one_of(tenths(b.code(GGroup::cutter)), {g::cutter_left, g::cutter_right}) ? 1 : 0;
     },
     "G41 or G42"},
    {"e",
     [](const Block& b, int) {
       return one_of(number(b.code(MGroup::output)), {67, 68}) ? 1 : 0;
     },
     "M67 or M68"},
    {"h", [](const Block& b, int) { return b.is(g::tool_length) ? 1 : 0; }, "G43"},
    {"ijk",
     [](const Block&, int m) { return is_arc(m) || m == g::back_bore ? 1 : 0; },
     "G2, G3 or G87"},
    {"l",
     [](const Block& b, int m) {
       return (is_cycle(m) ? 1 : 0) + (b.is(g::set_data) ? 1 : 0) + (m98(b) ? 1 : 0);
     },
     "G10, M98 or a canned cycle"},
    {"p",
     [](const Block& b, int m) {
       const bool motion =
           is_arc(m) ||
           one_of(m, {g::drill_dwell, g::tap, g::bore_stop, g::bore_manual, g::bore_dwell});
       const bool once = one_of(tenths(b.code(GGroup::once)), {g::dwell, g::set_data});
       const bool output = one_of(number(b.code(MGroup::output)), {62, 63, 64, 65});
       const bool override_code = one_of(number(b.code(MGroup::override)), {50, 51, 52, 53});
       return (motion ? 1 : 0) + (once ? 1 : 0) + g64(b) + (output ? 1 : 0) +
              (override_code ? 1 : 0) + (m98(b) ? 1 : 0);
     },
     "G2, G3, G4, G10, G64, G82, G84, G86, G88, G89, M50-M53, M62-M65 or M98"},
    {"q",
     [](const Block& b, int m) {
       return (one_of(m, {g::peck_break, g::peck}) ? 1 : 0) + g64(b) +
              (number(b.code(MGroup::tool)) == 61 ? 1 : 0) +
              (one_of(number(b.code(MGroup::output)), {67, 68}) ? 1 : 0);
     },
     "G64, G73, G83, M61, M67 or M68"},
    {"r",
     [](const Block& b, int m) { return is_arc(m) || is_cycle(m) || b.is(g::set_data) ? 1 : 0; },
     "G2, G3, G10 or a canned cycle"},
};

void check_use(const WordUse& use, char letter, const Block& block, int motion) {
  const int users = use.users(block, motion);
  if (users == 1) return;
  if (users > 1) {
    refuse(ProblemName::bad_word_value,
           block.place(letter),
           fmt::format("the {} word could belong to two codes of this line; write each "
                       "of them on a line of its own",
                       upper(letter)));
  }
  if (letter == 'e') {
    refuse(ProblemName::unsupported_axis,
           block.place('e'),
           "an E word (the extruder of a 3D printer) has no meaning on a router");
  }
  refuse(ProblemName::unused_word,
         block.place(letter),
         fmt::format(
             "nothing on the line uses the {} word; it belongs to {}", upper(letter), use.codes));
}

/// Words that are counts or numbers.
struct WholeWord {
  char letter;
  bool (*counts)(const Block&);
  const char* what;
};

constexpr WholeWord kWholeWords[] = {
    {'t', [](const Block&) { return true; }, "T, a tool's number, is"},
    {'d', [](const Block&) { return true; }, "D, a tool's number, is"},
    {'h', [](const Block&) { return true; }, "H, the number of a tool's length, is"},
    {'l', [](const Block&) { return true; }, "L, a count or a kind, is"},
    {'p', [](const Block& b) { return m98(b); }, "P, the number of the program that M98 calls, is"},
    {'p',
     [](const Block& b) {
       return one_of(number(b.code(MGroup::output)), {62, 63, 64, 65});
     },
     "P, the number of an output, is"},
    {'e',
     [](const Block& b) {
       return one_of(number(b.code(MGroup::output)), {67, 68});
     },
     "E, the number of an output, is"},
    {'q',
     [](const Block& b) { return number(b.code(MGroup::tool)) == 61; },
     "Q of M61, a tool's number, is"},
};

void check_whole(const Block& block) {
  for (const WholeWord& word : kWholeWords) {
    if (!block.has(word.letter) || !word.counts(block)) continue;
    const double value = block.value(word.letter);
    if (value >= 0.0 && std::fabs(value - std::round(value)) <= kWhole) continue;
    refuse(
        ProblemName::bad_word_value,
        block.place(word.letter),
        fmt::format(
            "{} a whole number, not below zero; here it is {}", word.what, with_value("", value)));
  }
}

long whole(double value) { return std::lround(value); }

}  // namespace

void Interpreter::check_words(const Block& block, int motion) const {
  for (const char letter : {'u', 'v', 'w'}) {
    if (block.has(letter)) {
      refuse(ProblemName::unsupported_axis,
             block.place(letter),
             fmt::format("the axis {} is not supported", upper(letter)));
    }
  }
  for (const WordUse& use : kWordUses) {
    for (const char letter : use.letters) {
      if (block.has(letter)) check_use(use, letter, block, motion);
    }
  }
  if (block.is(g::machine_frame)) {
    if (motion != g::rapid && motion != g::line) {
      refuse(ProblemName::bad_word_value, block, "G53 needs G0 or G1 and axis words");
    }
    const bool incremental =
        block.code(GGroup::distance) ? block.is(g::incremental) : modes_.incremental;
    if (incremental) refuse(ProblemName::modal_conflict, block, "G53 cannot be used in G91");
  }
  for (const char letter : {'s', 't', 'f'}) {
    if (block.has(letter) && block.value(letter) < 0.0) {
      refuse(ProblemName::bad_word_value,
             block.place(letter),
             fmt::format("{} is negative", upper(letter)));
    }
  }
  return check_whole(block);
}

void Interpreter::pass(const Block& block, std::string text) {
  return sink_.word({block.line, std::move(text)});
}

void Interpreter::output_word(const Block& block) {
  const MCode* output = block.code(MGroup::output);
  if (output == nullptr) return;
  std::string text = fmt::format("M{}", output->number);
  const bool analog = output->number >= 67;
  for (const char letter : analog ? std::string_view("eq") : std::string_view("p")) {
    if (!block.has(letter)) {
      refuse(ProblemName::missing_word, block, fmt::format("{} needs {}", text, upper(letter)));
    }
    const bool numbers = letter != 'q';
    text += numbers ? fmt::format(" {}{}", upper(letter), whole(block.value(letter)))
                    : with_value(" Q", block.value(letter));
  }
  return pass(block, std::move(text));
}

void Interpreter::pass_words(const Block& block) {
  if (block.has('s')) {
    modes_.spindle_rpm = block.value('s');
    pass(block, with_value("S", block.value('s')));
  }
  if (block.has('t')) {
    modes_.selected_tool = whole(block.value('t'));
    pass(block, fmt::format("T{}", modes_.selected_tool));
  }
  output_word(block);
  if (const MCode* tool = block.code(MGroup::tool)) {
    std::string text = fmt::format("M{}", tool->number);
    if (tool->number == 61) {
      if (!block.has('q')) {
        refuse(ProblemName::missing_word, block, "M61 needs the tool's number as Q");
      }
      modes_.tool = whole(block.value('q'));
      text += fmt::format(" Q{}", modes_.tool);
    } else {
      modes_.tool = modes_.selected_tool;
    }
    pass(block, std::move(text));
  }
  if (const MCode* spindle = block.code(MGroup::spindle)) {
    modes_.spindle = spindle->number == 5 ? 0 : spindle->number;
    pass(block, fmt::format("M{}", spindle->number));
  }
  if (const MCode* coolant = block.code(MGroup::coolant)) {
    pass(block, fmt::format("M{}", coolant->number));
  }
  if (const MCode* override_code = block.code(MGroup::override)) {
    std::string text = fmt::format("M{}", override_code->number);
    if (block.has('p') && override_code->number >= 50) text += with_value(" P", block.value('p'));
    pass(block, std::move(text));
  }
}

void Interpreter::dwell(const Block& block) {
  if (!block.is(g::dwell)) return;
  if (!block.has('p') || block.value('p') < 0.0) {
    refuse(ProblemName::missing_word, block, "G4 needs its time as P, not below zero");
  }
  note_once(NoteOnce::dwell_unit, block.line);
  return pass(block, with_value("G4 P", block.value('p')));
}

void Interpreter::tool_length(const Block& block) {
  if (const GCode* cutter = block.code(GGroup::cutter)) {
    // G41 and G42 reach this point only if tools have no diameter.
    if (cutter->tenths == g::cutter_off) pass(block, "G40");
  }
  if (const GCode* code = block.code(GGroup::tool_length)) {
    std::string text = g_name(code->tenths);
    if (block.has('h')) text += fmt::format(" H{}", whole(block.value('h')));
    if (code->tenths == g::tool_length_stated) {
      if (block.has('x') || block.has('y') || block.has('a') || block.has('b') || block.has('c')) {
        refuse(ProblemName::unsupported_code,
               block,
               "a tool offset (G43.1) in any axis but Z moves the path");
      }
      if (block.has('z')) text += with_value(" Z", length(block, 'z'));
    }
    pass(block, std::move(text));
  }
  if (const GCode* control = block.code(GGroup::path_control)) {
    modes_.path_control = control->tenths;
    std::string text = g_name(control->tenths);
    // check_words has ensured that P and Q belong to no other code of the line.
    if (control->tenths == g::blend && block.has('p')) text += with_value(" P", length(block, 'p'));
    if (control->tenths == g::blend && block.has('q')) text += with_value(" Q", length(block, 'q'));
    pass(block, std::move(text));
  }
}

}  // namespace chaintrue::gcode

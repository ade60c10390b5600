// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words of a block: letters, values, modal groups.
#include "tools/gcode/block.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "grid/containers.hpp"

namespace chaintrue::gcode {
namespace {

constexpr KnownCode kCodes[] = {
#define CHAINTRUE_GCODE_G(name, tenths, group, words, refusal) \
  {{'G', tenths}, Group::group, words, refusal},
#include "tools/gcode/g_codes.def"
#undef CHAINTRUE_GCODE_G
#define CHAINTRUE_GCODE_M(number, group, words, refusal) {m(number), Group::group, words, refusal},
#include "tools/gcode/m_codes.def"
#undef CHAINTRUE_GCODE_M
};

/// The row of a code in kCodes by its tenths, or -1.
constexpr auto rows_of(char letter) {
  std::array<std::int16_t, 1000> rows{};
  rows.fill(-1);
  for (std::size_t i = 0; i < std::size(kCodes); ++i) {
    if (kCodes[i].letter == letter)
      rows[static_cast<std::size_t>(kCodes[i].tenths)] = static_cast<std::int16_t>(i);
  }
  return rows;
}

constexpr auto kRowsOfG = rows_of('G');
constexpr auto kRowsOfM = rows_of('M');

constexpr std::string_view kAxes = "xyzabc@^";
/// N is allowed only at the beginning of a line, O is not a word of a block; E, U, V and W are
/// rejected with a reason.
constexpr std::string_view kPlainLetters = "abcdefhijklpqrstxyz@^uvw";

void read_code(Code code, Place place, Block& block, bool tools_have_no_diameter) {
  const KnownCode* known = find(code);
  if (known == nullptr) refuse(unknown_code, place, "{} is unknown", name(code));
  const bool harmless =
      tools_have_no_diameter && (code == g::cutter_left || code == g::cutter_right);
  if (known->refusal != nullptr && !harmless) {
    refuse(unsupported_code, place, "{}: {}", name(code), known->refusal);
  }
  const KnownCode*& slot = block.codes[static_cast<std::size_t>(known->group)];
  if (slot != nullptr) {
    refuse(modal_conflict, place, "{} and {} cannot be on the same line", name(*slot), name(code));
  }
  slot = known;
}

Code read_g(ValueReader& reader) {
  const Place place = reader.place();
  const double value = reader.real();
  // 10 times 91.1 is 911 only up to rounding; more decimals do not form a code.
  const double tenths = 10.0 * value;
  const double rounded = std::round(tenths);
  if (value < 0.0 || std::fabs(tenths - rounded) > 0.001 || rounded > 9999.0)
    refuse(unknown_code, place, "G{} is not a code", value);
  return {'G', static_cast<int>(rounded)};
}

Code read_m(ValueReader& reader) {
  const Place place = reader.place();
  const long number = reader.integer();
  if (number < 0 || number > 9999) refuse(unknown_code, place, "M{} is unknown", number);
  return m(static_cast<int>(number));
}

void read_assignment(ValueReader& reader, Block& block) {
  Assignment assignment;
  assignment.place = reader.place();
  if (reader.peek() == '<') {
    assignment.name = reader.angle_name();
  } else {
    const long index = reader.integer();
    if (index < 1 || index >= parameter::kCount) {
      refuse(bad_parameter, assignment.place, "#{} does not exist", index);
    }
    assignment.index = static_cast<int>(index);
  }
  if (!reader.accept("=")) {
    refuse(bad_parameter, reader.place(),
           "'=' was expected, because a parameter outside a word's value is an assignment");
  }
  assignment.value = reader.real();
  block.assignments.push_back(std::move(assignment));
}

void read_word(char letter, Place place, ValueReader& reader, Block& block) {
  if (kPlainLetters.find(letter) == std::string_view::npos) {
    refuse(bad_character, place, "no word starts with '{}'", upper(letter));
  }
  if (block.has(letter)) {
    refuse(repeated_word, place, "a second {} word on the line", upper(letter));
  }
  const double value = reader.real();
  if (std::fabs(value) > 1e9) {
    refuse(number_out_of_range, place, "{}{} is out of range", upper(letter), value);
  }
  block.put(letter, value, place);
}

}  // namespace

std::span<const KnownCode> known_codes() { return kCodes; }

const KnownCode* find(Code code) {
  const auto& rows = code.letter == 'G' ? kRowsOfG : kRowsOfM;
  const auto at = static_cast<std::size_t>(code.tenths);
  return at < rows.size() && rows[at] >= 0 ? &kCodes[rows[at]] : nullptr;
}

bool holds_moves(std::string_view text) {
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
  };
  std::size_t motions = 0;
  std::size_t places = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char letter = upper(text[at]);
    const std::size_t sign = std::min(text.find_first_not_of("+-. ", at + 1), text.size());
    if (letter == 'X' && is_digit(sign)) ++places;
    if (letter != 'G') continue;
    std::size_t digit = at + 1;
    while (digit < text.size() && text[digit] == '0' && is_digit(digit + 1)) ++digit;
    const bool ends = !is_digit(digit + 1) && (digit + 1 >= text.size() || text[digit + 1] != '.');
    if (is_digit(digit) && text[digit] <= '3' && ends) ++motions;
  }
  constexpr std::size_t kMostOfALine = 3;
  return motions > 0 && places > 0 && motions + places > kMostOfALine;
}

bool Block::has_axes() const {
  return grid::any_of(kAxes, [this](char axis) { return has(axis); });
}

bool Block::has_z_alone() const {
  return has('z') && grid::none_of(kAxes, [this](char axis) { return axis != 'z' && has(axis); });
}

void Block::clear(std::size_t line_number) {
  codes.fill(nullptr);
  assignments.clear();
  deletable = false;
  line = line_number;
  present_ = 0;
}

void Block::put(char letter, double value, Place place) {
  present_ |= 1U << slot(letter);
  values_[slot(letter)] = value;
  columns_[slot(letter)] = place.column;
}

void read_words(ValueReader reader, Block& block, bool tools_have_no_diameter) {
  while (!reader.done()) {
    const char letter = reader.peek();
    const Place place = reader.place();
    reader.skip(1);
    const Place number = reader.place();
    if (letter == 'g') {
      read_code(read_g(reader), number, block, tools_have_no_diameter);
    } else if (letter == 'm') {
      read_code(read_m(reader), number, block, tools_have_no_diameter);
    } else if (letter == '#') {
      read_assignment(reader, block);
    } else {
      read_word(letter, place, reader, block);
    }
  }
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Words of a block: letters, values, modal groups.
#include "tools/gcode/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace chaintrue::gcode {
namespace {

constexpr GCode kGCodes[] = {
#define CHAINTRUE_GCODE_G(name, tenths, group, axes, refusal) \
  {tenths, GGroup::group, axes, refusal},
#include "tools/gcode/g_codes.def"
#undef CHAINTRUE_GCODE_G
};

constexpr MCode kMCodes[] = {
#define CHAINTRUE_GCODE_M(number, group, refusal) {number, MGroup::group, refusal},
#include "tools/gcode/m_codes.def"
#undef CHAINTRUE_GCODE_M
};

template <class Code, std::size_t size, std::size_t rows>
constexpr std::array<std::int16_t, size> index_of(const Code (&codes)[rows], int Code::*number) {
  std::array<std::int16_t, size> index{};
  for (auto& entry : index) entry = -1;
  for (std::size_t i = 0; i < rows; ++i) {
    index[static_cast<std::size_t>(codes[i].*number)] = static_cast<std::int16_t>(i);
  }
  return index;
}

constexpr auto kGIndex = index_of<GCode, 1000>(kGCodes, &GCode::tenths);
constexpr auto kMIndex = index_of<MCode, 200>(kMCodes, &MCode::number);

constexpr std::string_view kAxes = "xyzabc@^";
/// N is allowed only at the beginning of a line, O is not a word of a block; E, U, V and W are
/// rejected with a reason.
constexpr std::string_view kPlainLetters = "abcdefhijklpqrstxyz@^uvw";

void read_g(ValueReader& reader, Block& block, bool tools_have_no_diameter) {
  const Place place = reader.place();
  const auto value = reader.real();
  // 10 times 91.1 is 911 only up to rounding; more decimals do not form a code.
  const double tenths = 10.0 * value;
  const double rounded = std::round(tenths);
  if (value < 0.0 || std::fabs(tenths - rounded) > 0.001 || rounded > 9999.0) {
    refuse(ProblemName::unknown_code, place, fmt::format("G{} is not a code", value));
  }
  const GCode* code = find_g(static_cast<int>(rounded));
  if (code == nullptr) {
    refuse(ProblemName::unknown_code,
           place,
           fmt::format("{} is not known", g_name(static_cast<int>(rounded))));
  }
  const bool harmless =
      tools_have_no_diameter && (code->tenths == g::cutter_left || code->tenths == g::cutter_right);
  if (code->refusal != nullptr && !harmless) {
    refuse(ProblemName::unsupported_code,
           place,
           fmt::format("{}: {}", g_name(code->tenths), code->refusal));
  }
  const GCode*& slot = block.g[static_cast<std::size_t>(code->group)];
  if (slot != nullptr) {
    refuse(ProblemName::modal_conflict,
           place,
           fmt::format("{} and {} exclude each other within a line",
                       g_name(slot->tenths),
                       g_name(code->tenths)));
  }
  slot = code;
}

void read_m(ValueReader& reader, Block& block) {
  const Place place = reader.place();
  const auto number = reader.integer();
  const MCode* code = number < 0 || number > 9999 ? nullptr : find_m(static_cast<int>(number));
  if (code == nullptr)
    refuse(ProblemName::unknown_code, place, fmt::format("M{} is not known", number));
  if (code->refusal != nullptr) {
    refuse(
        ProblemName::unsupported_code, place, fmt::format("M{}: {}", code->number, code->refusal));
  }
  const MCode*& slot = block.m[static_cast<std::size_t>(code->group)];
  if (slot != nullptr) {
    refuse(ProblemName::modal_conflict,
           place,
           fmt::format("M{} and M{} exclude each other within a line", slot->number, code->number));
  }
  slot = code;
}

void read_assignment(ValueReader& reader, Block& block) {
  Assignment assignment;
  assignment.place = reader.place();
  if (reader.peek() == '<') {
    auto name = reader.angle_name();
    assignment.name = std::move(name);
  } else {
    const auto index = reader.integer();
    if (index < 1 || index >= parameter::kCount) {
      refuse(
          ProblemName::bad_parameter, assignment.place, fmt::format("#{} does not exist", index));
    }
    assignment.index = static_cast<int>(index);
  }
  if (!reader.accept("=")) {
    refuse(ProblemName::bad_parameter,
           reader.place(),
           "'=' was expected: a parameter that is no word's value is set");
  }
  const auto value = reader.real();
  assignment.value = value;
  block.assignments.push_back(std::move(assignment));
}

void read_word(char letter, Place place, ValueReader& reader, Block& block) {
  if (kPlainLetters.find(letter) == std::string_view::npos) {
    refuse(
        ProblemName::bad_character, place, fmt::format("'{}' begins no word here", upper(letter)));
  }
  if (block.has(letter)) {
    refuse(ProblemName::repeated_word,
           place,
           fmt::format("a second {} word on the line", upper(letter)));
  }
  const auto value = reader.real();
  if (std::fabs(value) > 1e9) {
    refuse(ProblemName::number_out_of_range,
           place,
           fmt::format("{}{} is out of range", upper(letter), value));
  }
  block.put(letter, value, place);
}

}  // namespace

const GCode* find_g(int tenths) {
  if (tenths < 0 || tenths >= static_cast<int>(kGIndex.size())) return nullptr;
  const auto row = kGIndex[static_cast<std::size_t>(tenths)];
  return row < 0 ? nullptr : &kGCodes[row];
}

const MCode* find_m(int number) {
  if (number < 0 || number >= static_cast<int>(kMIndex.size())) return nullptr;
  const auto row = kMIndex[static_cast<std::size_t>(number)];
  return row < 0 ? nullptr : &kMCodes[row];
}

std::string g_name(int tenths) {
  return tenths % 10 == 0 ? fmt::format("G{}", tenths / 10)
                          : fmt::format("G{}.{}", tenths / 10, tenths % 10);
}

char upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
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
  for (const char axis : kAxes) {
    if (has(axis)) return true;
  }
  return false;
}

bool Block::has_z_alone() const {
  return has('z') && std::none_of(kAxes.begin(), kAxes.end(), [this](char axis) {
           return axis != 'z' && has(axis);
         });
}

void Block::clear(std::size_t line_number) {
  g.fill(nullptr);
  m.fill(nullptr);
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
    if (letter == 'g') {
      read_g(reader, block, tools_have_no_diameter);
    } else if (letter == 'm') {
      read_m(reader, block);
    } else if (letter == '#') {
      read_assignment(reader, block);
    } else {
      read_word(letter, place, reader, block);
    }
  }
}

}  // namespace chaintrue::gcode

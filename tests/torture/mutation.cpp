// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/torture/mutation.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace chaintrue::torture {
namespace {

constexpr std::array<std::string_view, 28> kNumbers = {
    "0",          "-0",          "-1",    "1",    "1e-6",  "1e-12", "1e-300",
    "1e-999",     "0.001",       "1e6",   "1e12", "1e300", "1e999", "-1e9",
    "NaN",        "-Infinity",   "1,5",   "0x10", "1e",    "--1",   "99999999999999999999",
    "2147483648", "-2147483649", "0.1.2", "+3",   ".5",    "5.",    "3000"};
constexpr std::array<std::string_view, 24> kWords = {"{",
                                                     "}",
                                                     "[",
                                                     "]",
                                                     "\"",
                                                     ",",
                                                     ":",
                                                     "null",
                                                     "true",
                                                     "\n",
                                                     "\r\n",
                                                     "\t",
                                                     "\\",
                                                     "\\u0000",
                                                     "\xEF\xBB\xBF",
                                                     "\xFF",
                                                     "\xC3",
                                                     "# ",
                                                     "<script>alert(1)</script>",
                                                     "'",
                                                     ";",
                                                     "()",
                                                     "\"comment\": 1,",
                                                     "%"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string Mutator::odd_number() { return std::string(one_of(kNumbers)); }

std::string Mutator::with_another_number(std::string text) {
  if (text.empty()) return text;
  const std::size_t start = below(text.size());
  std::size_t begin = start;
  while (begin < text.size() && !is_digit(text[begin])) ++begin;
  while (begin > 0 &&
         (is_digit(text[begin - 1]) || text[begin - 1] == '.' || text[begin - 1] == '-'))
    --begin;
  std::size_t end = begin;
  while (end < text.size() && (is_digit(text[end]) || std::string_view("+-.eE").find(text[end]) !=
                                                          std::string_view::npos)) {
    ++end;
  }
  return text.replace(begin, end - begin, odd_number());
}

void Mutator::slip(std::string& text) {
  const std::size_t place = text.empty() ? 0 : below(text.size());
  const std::size_t length = std::min(below(40) + 1, text.size() - place);
  switch (below(10)) {
    case 0:
      text.resize(place);
      break;
    case 1:
      if (!text.empty()) text[place] = static_cast<char>(below(256));
      break;
    case 2:
      text.erase(place, length);
      break;
    case 3:
      text.insert(place, text.substr(place, length));
      break;
    case 4: {  // a line twice, or many times
      const std::size_t begin = text.rfind('\n', place) + 1;
      const std::size_t end = std::min(text.find('\n', place), text.size() - 1) + 1;
      if (begin >= end || end > text.size()) break;
      const std::string line = text.substr(begin, end - begin);
      for (std::size_t i = below(20); i > 0 && line.size() < 400; --i) text.insert(begin, line);
      break;
    }
    case 5:
      text.insert(place, one_of(kWords));
      break;
    case 6:
      text.replace(place, length, one_of(kWords));
      break;
    default:
      text = with_another_number(text);
  }
}

std::string Mutator::damaged(std::string text) {
  for (std::size_t slips = 1 + below(4); slips > 0; --slips) slip(text);
  return text;
}

}  // namespace chaintrue::torture

// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/mutation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

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

constexpr std::array<const char*, 8> kEntries = {
    "0", "-1", "1e9", "\"\"", "[]", "{}", "true", "[1, 2, 3]"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string Mutator::odd_number() { return std::string(one_of(kNumbers)); }

std::string Mutator::near_number(const std::string& number) {
  constexpr std::array<double, 12> kFactors = {
      -1.0, 0.0, 0.01, 0.1, 0.5, 0.98, 0.9999, 1.0001, 1.02, 2.0, 10.0, 100.0};
  const double value = std::strtod(number.c_str(), nullptr);
  const double other = below(3) == 0 ? value + one_of(kFactors) : value * one_of(kFactors);
  return fmt::format("{:.8g}", std::isfinite(other) ? other : 0.0);
}

std::string Mutator::with_number(std::string text, NumberKind kind) {
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
  const std::string other =
      kind == NumberKind::odd ? odd_number() : near_number(text.substr(begin, end - begin));
  return text.replace(begin, end - begin, other);
}

std::string Mutator::with_another_entry(const std::string& text) {
  using Json = nlohmann::json;
  const Json flat = Json::parse(text, nullptr, false);
  if (!flat.is_structured() || flat.empty()) return with_number(text, NumberKind::near);
  Json document = flat;
  Json* parent = &document;
  // Down to a random level of the document.
  for (;;) {
    Json& next = *std::next(parent->begin(), static_cast<std::ptrdiff_t>(below(parent->size())));
    if (!next.is_structured() || next.empty() || below(4) == 0) break;
    parent = &next;
  }
  const auto at = [&] {
    return std::next(parent->begin(), static_cast<std::ptrdiff_t>(below(parent->size())));
  };
  switch (below(4)) {
    case 0:
      parent->erase(at());
      break;
    case 1:
      std::swap(*at(), *at());
      break;
    case 2:
      if (parent->is_array()) {
        const Json copy = *at();
        parent->push_back(copy);
      } else {
        *at() = nullptr;
      }
      break;
    default:
      *at() = Json::parse(one_of(kEntries));
  }
  return document.dump(1);
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
      text = with_number(text, NumberKind::odd);
  }
}

std::string Mutator::damaged(std::string text) {
  const std::size_t way = below(4);
  for (std::size_t slips = 1 + below(4); slips > 0; --slips) {
    if (way == 0) {
      text = with_number(text, NumberKind::near);
    } else if (way == 1) {
      text = with_another_entry(text);
    } else {
      slip(text);
    }
  }
  return text;
}

}  // namespace chaintrue::torture

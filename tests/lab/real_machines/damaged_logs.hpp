// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A log damaged in each way: cut before a line, and with a line deleted, doubled or garbled by itself.
#pragma once

#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

#include "grid/random.hpp"

namespace chaintrue::testing_support {

inline constexpr std::uint64_t kDamageSeed = 4;

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

inline std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// One to three characters become others, are lost, or are printed twice.
inline std::string garbled(std::string line, grid::Random& random) {
  const auto any = [&random](std::size_t count) { return random.below(count); };
  const std::size_t times = 1 + any(3);
  for (std::size_t i = 0; i < times && !line.empty(); ++i) {
    const std::size_t at = any(line.size());
    switch (any(3)) {
      case 0:
        line[at] = static_cast<char>(33 + any(94));
        break;
      case 1:
        line.erase(at, 1 + any(4));
        break;
      default:
        line.insert(at, line.substr(at, 1 + any(4)));
    }
  }
  return line;
}

enum class Damage { cut, deleted, doubled, garbled };

/// `read(damage, text)` of every `step`th line of a log.
template <class Read>
void damage_every(const std::string& text, std::size_t step, Read read) {
  const std::vector<std::string> lines = lines_of(text);
  grid::Random random(kDamageSeed, lines.size());
  for (std::size_t k = 0; k < lines.size(); k += step) {
    const auto at = static_cast<std::ptrdiff_t>(k);
    read(Damage::cut, text_of({lines.begin(), lines.begin() + at}));
    std::vector<std::string> other = lines;
    other.erase(other.begin() + at);
    read(Damage::deleted, text_of(other));
    other = lines;
    other.insert(other.begin() + at, lines[k]);
    read(Damage::doubled, text_of(other));
    other = lines;
    other[k] = garbled(lines[k], random);
    read(Damage::garbled, text_of(other));
  }
}

}  // namespace chaintrue::testing_support

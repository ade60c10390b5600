// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/shrink.hpp"

#include <algorithm>
#include <cstddef>

namespace chaintrue::witness {
namespace {

std::vector<std::string> parts(const std::string& text, char separator) {
  std::vector<std::string> result;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t end = std::min(text.find(separator, from), text.size());
    result.push_back(text.substr(from, end - from));
    from = end + 1;
  }
  return result;
}

using Join = std::function<std::string(const std::vector<std::string>&)>;

/// Removes runs of parts: halves first, single parts at the end, until no part can be removed.
std::vector<std::string> without_needless(std::vector<std::string> kept,
                                          const Join& join,
                                          const Faulty& faulty) {
  for (std::size_t size = std::max<std::size_t>(kept.size() / 2, 1); size > 0;) {
    std::vector<std::vector<std::string>> fewer;
    std::vector<std::string> programs;
    for (std::size_t from = 0; from < kept.size(); from += size) {
      std::vector<std::string> candidate = kept;
      const auto first = candidate.begin() + static_cast<std::ptrdiff_t>(from);
      candidate.erase(first,
                      first + static_cast<std::ptrdiff_t>(std::min(size, kept.size() - from)));
      programs.push_back(join(candidate));
      fewer.push_back(std::move(candidate));
    }
    const std::vector<bool> still = faulty(programs);
    const auto found = std::find(still.begin(), still.end(), true);
    if (found == still.end()) {
      size = size == 1 ? 0 : size / 2;
    } else {
      kept = std::move(fewer[static_cast<std::size_t>(found - still.begin())]);
      size = std::clamp<std::size_t>(size, 1, std::max<std::size_t>(kept.size(), 1));
    }
    if (kept.empty()) break;
  }
  return kept;
}

std::string lines_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

std::string shrink(const std::string& program, const Faulty& faulty) {
  std::vector<std::string> lines = without_needless(parts(program, '\n'), lines_of, faulty);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Join with_words = [&](const std::vector<std::string>& words) {
      std::vector<std::string> all = lines;
      all[i].clear();
      for (const std::string& word : words) all[i] += (all[i].empty() ? "" : " ") + word;
      return lines_of(all);
    };
    const auto words = without_needless(parts(lines[i], ' '), with_words, faulty);
    lines = parts(with_words(words), '\n');
  }
  return lines_of(lines);
}

}  // namespace chaintrue::witness

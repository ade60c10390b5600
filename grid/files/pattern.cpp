// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/pattern.hpp"

#include <map>
#include <regex>

#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

/// Longer than any number or heading. std::regex recurses once for every character that it matches.
constexpr std::size_t kLongest = 200;

const std::regex& compiled(const char* pattern) {
  thread_local std::map<const char*, std::regex> known;
  return known.try_emplace(pattern, pattern).first->second;
}

}  // namespace

std::vector<std::string_view> match(std::string_view text, const char* pattern) {
  std::cmatch found;
  if (text.size() <= kLongest)
    std::regex_match(text.data(), text.data() + text.size(), found, compiled(pattern));
  return mapped(found, [](const std::csub_match& part) {
    return std::string_view(part.first, as_size(part.length()));
  });
}

std::string replaced(const std::string& text, const char* pattern, const char* with) {
  return std::regex_replace(text, compiled(pattern), with);
}

}  // namespace chaintrue::grid::files

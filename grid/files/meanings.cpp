// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/meanings.hpp"

#include <algorithm>
#include <iterator>

namespace chaintrue::grid::files {
namespace {

struct Meaning {
  std::string_view noun;  ///< of the object; empty: any object
  std::string_view key;
  std::string_view words;
};

constexpr Meaning kMeanings[] = {
#define CHAINTRUE_MEANING(noun, key, words) {noun, key, words},
#include "grid/files/meanings.def"
#undef CHAINTRUE_MEANING
};

}  // namespace

std::string meaning_of(std::string_view noun, std::string_view key) {
  const auto line = [&](std::string_view of) {
    return std::find_if(std::begin(kMeanings), std::end(kMeanings), [&](const Meaning& meaning) {
      return meaning.noun == of && meaning.key == key;
    });
  };
  auto found = line(noun);
  if (found == std::end(kMeanings)) found = line("");
  return found == std::end(kMeanings) ? std::string() : std::string(found->words);
}

}  // namespace chaintrue::grid::files

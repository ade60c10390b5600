// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/cli/case_file.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace chaintrue::testing_support {
namespace {

constexpr std::string_view kVerbs[] = {"from", "file", "$",     "exit",  "exists", "absent",
                                       "same", "has",  "lacks", "lines", "says",   "problem",
                                       "is",   "near", "above", "below"};

}  // namespace

CaseFile read_cases(const std::filesystem::path& path) {
  CaseFile result{path, {}, {}};
  std::ifstream file(path);
  Case* current = nullptr;
  int number = 0;
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": " + why);
  };
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::size_t blank = line.find(' ');
    const std::string verb = line.substr(0, blank);
    const std::string rest = blank == std::string::npos ? "" : line.substr(blank + 1);
    if (verb == "given") {
      current = &(result.givens[rest] = {rest, number, {}});
    } else if (verb == "case") {
      current = &result.cases.emplace_back(Case{rest, number, {}});
    } else if (current == nullptr) {
      refuse("no case has begun");
    } else if (verb == "|") {
      if (current->steps.empty() || current->steps.back().verb != "file")
        refuse("a line of no file");
      current->steps.back().text += rest + "\n";
    } else if (std::ranges::find(kVerbs, verb) == std::end(kVerbs)) {
      refuse("no such word: " + verb);
    } else {
      current->steps.push_back({number, verb, rest, {}});
    }
  }
  return result;
}

}  // namespace chaintrue::testing_support

// SPDX-License-Identifier: GPL-3.0-or-later
// Every option that is not refused (tests/inputs) changes the answer of every kind of input that its
// verb takes. The options are those of --help: one without a telling value in tellings.tsv fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/inputs/help.hpp"
#include "tests/lab/inputs/numbers.hpp"
#include "tests/lab/inputs/tellings.hpp"

namespace chaintrue::inputs {
namespace {

std::string line_of(const Invocation& use, const Telling& telling) {
  const std::string& instead = telling.instead;
  if (!instead.empty() && instead.front() != '@') return instead;
  std::string line = use.line;
  if (instead.empty()) return line;
  for (const char* own : {"@simple.nc", "@true.nc", "@belts_true.nc", "@plotter_true.nc"})
    line = replaced(line, own, instead);
  return line;
}

/// The line without an option and its value, so that it can be given again.
std::string without(const std::string& line, const std::string& option) {
  const bool is_output = option == "--output";
  std::string result = std::regex_replace(line, std::regex(" " + option + "( [^- ][^ ]*)?"), "");
  return is_output ? std::regex_replace(result, std::regex(" -o [^ ]+"), "") : result;
}

/// The fault of a cell; empty if none.
std::string fault_of(const InputFolder& folder, const Invocation& use, const Ran& base,
                     const std::string& option) {
  const Telling* telling = telling_of(use.verb, option, use.name);
  if (telling == nullptr) return "has no telling value in this test";
  const std::string line = without(line_of(use, *telling), option) + " " + telling->words;
  const bool by_itself = telling->shows == Shows::as_file || telling->shows == Shows::in_words;
  const std::string then = by_itself || then_of(use).empty() ? "" : "; " + then_of(use);
  Ran ran = folder.run(line + then);
  Ran before = telling->instead.empty() ? base : folder.run(line_of(use, *telling) + then);
  if (ran.code == 2 || ran.code == 3) {
    // A sentence with the reason, by the file's content.
    if (ran.err.empty()) return "is refused without a sentence";
  }
  static const std::vector<std::string> kEchoes = {
      "content_hash", "name",         "tape",    "hole_sigma_mm",    "noise_dof",
      "seed",         "tolerance_mm", "machine", "extended_machine", "made_by"};
  switch (telling->shows) {
    case Shows::in_numbers: {
      std::vector<std::string> echoes = kEchoes;
      if (use.verb != "simulate") echoes.emplace_back("noise");
      if (!then_of(use).empty()) {
        before.files.clear();
        ran.files.clear();
      }
      // Problems of a program go to standard error.
      const bool says_more = use.verb.starts_with("gcode") && before.err != ran.err;
      return numbers_of(before, echoes) == numbers_of(ran, echoes) && !says_more
                 ? "changes no number: " + line
                 : "";
    }
    case Shows::in_form:
      return before.out == ran.out && before.files == ran.files ? "changes nothing: " + line : "";
    case Shows::as_file:
      return std::ranges::none_of(ran.files,
                                  [&](const auto& file) {
                                    return !before.files.contains(file.first) &&
                                           !file.second.empty();
                                  })
                 ? "writes no file: " + line + "\n" + ran.err
                 : "";
    case Shows::in_words:
      return before.err == ran.err && before.code == ran.code ? "says nothing: " + line : "";
  }
  return "";
}

InputFolder& folder() {
  static InputFolder one;
  static const bool is_filled = (add_telling_files(one), true);
  (void)is_filled;
  return one;
}

bool writes_a_file(const Telling* telling) {
  return telling != nullptr && telling->shows == Shows::as_file && telling->instead.empty();
}

/// What is wrong with the options that write a file: one run is given all of them, and one file of each is expected.
std::string fault_of_files(const InputFolder& folder, const Invocation& use, const Ran& plain,
                           const std::vector<std::string>& options) {
  std::string line = use.line;
  std::vector<std::pair<std::string, std::string>> expected;
  for (const std::string& option : options) {
    const Telling* telling = telling_of(use.verb, option, use.name);
    if (!writes_a_file(telling) || refusal_of(use.verb, option, use.facts) != nullptr) continue;
    const std::string& words = telling->words;
    line = without(line, option) + " " + words;
    expected.emplace_back(option, words.substr(words.rfind(' ') + 1));
  }
  if (expected.empty()) return "";
  const Ran ran = folder.run(line);
  std::string fault;
  for (const auto& [option, file] : expected) {
    const auto written = ran.files.find(file);
    if (plain.files.contains(file) || written == ran.files.end() || written->second.empty())
      fault += option + " writes no file: " + line + "\n" + ran.err;
  }
  return fault;
}

class EveryOption : public testing::TestWithParam<std::string> {};

TEST_P(EveryOption, ChangesTheAnswer) {
  const std::string verb = GetParam();
  std::vector<std::string> options;
  for (const Option& option : options_in(folder().run(verb + " --help").out)) {
    if (option.name != "--force") options.push_back(option.name);
  }
  for (const Invocation& call : invocations()) {
    if (call.verb != verb) continue;
    const std::string then = then_of(call).empty() ? "" : "; " + then_of(call);
    const Ran base = folder().run(call.line + then);
    const Ran plain = then.empty() ? base : folder().run(call.line);
    for (const std::string& option : options) {
      if (refusal_of(verb, option, call.facts) != nullptr) continue;
      const Telling* telling = telling_of(verb, option, call.name);
      if (writes_a_file(telling)) continue;
      const bool by_itself = telling != nullptr && (telling->shows == Shows::as_file ||
                                                    telling->shows == Shows::in_words);
      const std::string fault = fault_of(folder(), call, by_itself ? plain : base, option);
      EXPECT_EQ(fault, "") << verb << " of " << call.name << ": " << option;
    }
    EXPECT_EQ(fault_of_files(folder(), call, plain, options), "") << verb << " of " << call.name;
  }
}

std::vector<std::string> verbs_of_measurements() {
  std::set<std::string> all;
  for (const Invocation& call : invocations()) {
    if (call.facts != cli::facts::any) all.insert(call.verb);
  }
  return {all.begin(), all.end()};
}

INSTANTIATE_TEST_SUITE_P(OfEveryVerb, EveryOption, testing::ValuesIn(verbs_of_measurements()),
                         [](const auto& verb) {
                           std::string name = verb.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace chaintrue::inputs

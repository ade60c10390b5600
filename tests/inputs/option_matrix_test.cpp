// SPDX-License-Identifier: GPL-3.0-or-later
// Every option that a verb has acts on every kind of input that the verb takes, so that the numbers
// of the answer change, or is refused by the sentence of the table (tools/cli/option_rules.def). The
// options are those of --help: a new one without a line in that table, or without a telling value in
// option_cells.cpp, fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/inputs/option_cells.hpp"
#include "tests/inputs/workshop.hpp"

namespace chaintrue {
namespace {

using inputs::Ran;
using inputs::Shows;
using inputs::Telling;
using inputs::telling_of;
using inputs::Use;
using inputs::uses;
using inputs::Workshop;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

std::string line_of(const Use& use, const Telling& telling) {
  const std::string instead = telling.instead;
  if (!instead.empty() && instead.front() != '@') return instead;
  std::string line = use.line;
  if (instead.empty()) return line;
  for (const char* own : {"@simple.nc", "@true.nc", "@belts_true.nc", "@plotter_true.nc"}) line = replaced(line, own, instead);
  return line;
}

/// The line without an option that stands in it with its value, so that it can be given anew.
std::string without(const std::string& line, const std::string& option) {
  const bool is_output = option == "--output";
  std::string result = std::regex_replace(line, std::regex(" " + option + "( [^- ][^ ]*)?"), "");
  return is_output ? std::regex_replace(result, std::regex(" -o [^ ]+"), "") : result;
}

/// Long options that --help shows.
std::vector<std::string> options_of(const Workshop& workshop, const std::string& verb) {
  std::vector<std::string> options;
  std::istringstream help(workshop.run(verb + " --help").out);
  static const std::regex option(R"(^\s+(?:-\w,)?(--[a-z0-9-]+).*)");
  std::smatch parts;
  for (std::string line; std::getline(help, line) && !line.starts_with("Example");) {
    if (std::regex_match(line, parts, option) && !parts[1].str().starts_with("--help"))
      options.push_back(parts[1]);
  }
  return options;
}

/// What is wrong with a cell; empty where nothing is.
std::string fault_of(const Workshop& workshop, const Use& use, const Ran& base, const std::string& option) {
  const Telling* telling = telling_of(use.verb, option, use.name);
  if (telling == nullptr) return "has no telling value in this test";
  const std::string line = without(line_of(use, *telling), option) + " " + telling->words;
  const cli::OptionRule* rule = cli::refusal_of(use.verb, option, use.facts);
  if (rule != nullptr) {
    const Ran ran = workshop.run(line);
    if (ran.code != 2 && ran.code != 3)
      return "should be refused, ended with " + std::to_string(ran.code) + ": " + line;
    if (ran.err.find(option) == std::string::npos) return "is not named by the refusal: " + ran.err;
    if (ran.code == 3 && ran.err.find(rule->otherwise) == std::string::npos)
      return "is refused by another sentence: " + ran.err;
    if (!ran.files.empty() || !ran.out.empty()) return "was refused, and something written";
    return "";
  }
  const std::string then = *use.then == '\0' || telling->shows == Shows::as_file ||
                                   telling->shows == Shows::in_words
                               ? ""
                               : std::string("; ") + use.then;
  Ran ran = workshop.run(line + then);
  Ran before = *telling->instead == '\0' ? base : workshop.run(line_of(use, *telling) + then);
  if (ran.code == 2 || ran.code == 3) {
    // A sentence that says why it cannot, by what the file holds.
    if (ran.err.empty()) return "is refused without a sentence";
  }
  static const std::vector<std::string> kEchoes = {
      "content_hash", "name", "tape", "hole_sigma_mm", "noise_dof", "seed", "tolerance_mm", "machine",
      "extended_machine", "made_by"};
  switch (telling->shows) {
    case Shows::in_numbers: {
      std::vector<std::string> echoes = kEchoes;
      if (std::string(use.verb) != "simulate") echoes.emplace_back("noise");
      if (*use.then != '\0') {
        before.files.clear();
        ran.files.clear();
      }
      // What is wrong with a program is said on standard error.
      const bool says_more = std::string_view(use.verb).starts_with("gcode") && before.err != ran.err;
      return numbers_of(before, echoes) == numbers_of(ran, echoes) && !says_more
                 ? "changes no number: " + line
                 : "";
    }
    case Shows::in_form:
      return before.out == ran.out && before.files == ran.files ? "changes nothing: " + line : "";
    case Shows::as_file:
      return std::none_of(ran.files.begin(),
                          ran.files.end(),
                          [&](const auto& file) {
                            return !before.files.contains(file.first) && !file.second.empty();
                          })
                 ? "writes no file: " + line + "\n" + ran.err
                 : "";
    case Shows::in_words:
      return before.err == ran.err && before.code == ran.code ? "says nothing: " + line : "";
  }
  return "";
}

class OptionMatrix : public testing::Test {
 protected:
  static void SetUpTestSuite() { workshop_ = new Workshop; }
  static void TearDownTestSuite() {
    delete workshop_;
    workshop_ = nullptr;
  }
  static Workshop* workshop_;
};
Workshop* OptionMatrix::workshop_ = nullptr;

bool writes_a_file(const Telling* telling, const Use& use) {
  return telling != nullptr && telling->shows == Shows::as_file && *telling->instead == '\0' &&
         cli::refusal_of(use.verb, telling->option, use.facts) == nullptr;
}

/// What is wrong with the options that write a file: one run is given all of them, and one file of each is expected.
std::string fault_of_files(const Workshop& workshop, const Use& use, const Ran& plain, const std::vector<std::string>& options) {
  std::string line = use.line;
  std::vector<std::pair<std::string, std::string>> expected;
  for (const std::string& option : options) {
    const Telling* telling = telling_of(use.verb, option, use.name);
    if (!writes_a_file(telling, use)) continue;
    const std::string words = telling->words;
    line = without(line, option) + " " + words;
    expected.emplace_back(option, words.substr(words.rfind(' ') + 1));
  }
  if (expected.empty()) return "";
  const Ran ran = workshop.run(line);
  std::string fault;
  for (const auto& [option, file] : expected) {
    const auto written = ran.files.find(file);
    if (plain.files.contains(file) || written == ran.files.end() || written->second.empty())
      fault += option + " writes no file: " + line + "\n" + ran.err;
  }
  return fault;
}

class EveryOption : public OptionMatrix, public testing::WithParamInterface<std::string> {};

TEST_P(EveryOption, ActsOrIsRefused) {
  const std::string verb = GetParam();
  const std::vector<std::string> options = options_of(*workshop_, verb);
  ASSERT_FALSE(options.empty());
  std::set<std::string> named;
  for (const cli::OptionRule& rule : cli::kOptionRules) {
    if (rule.verb == verb) named.insert(std::string(rule.option));
  }
  EXPECT_EQ(named, std::set<std::string>(options.begin(), options.end()))
      << "option_rules.def and --help differ";
  for (const Use& use : uses()) {
    if (use.verb != verb) continue;
    // The same readings in another form; a diagnosis takes half a second.
    if (verb == "diagnose" && std::string_view(use.name) == "csv" && std::getenv("CHAINTRUE_LONG") == nullptr) continue;
    const std::string then = *use.then == '\0' ? "" : std::string("; ") + use.then;
    const Ran base = workshop_->run(use.line + then);
    const Ran plain = then.empty() ? base : workshop_->run(use.line);
    EXPECT_TRUE(base.code == 0 || base.code == 1 || base.code == 4) << use.line << "\n" << base.err;
    for (const std::string& option : options) {
      if (option == "--force") continue;  // below
      const Telling* telling = telling_of(use.verb, option, use.name);
      if (writes_a_file(telling, use)) continue;
      const bool by_itself = telling != nullptr && (telling->shows == Shows::as_file ||
                                                    telling->shows == Shows::in_words);
      const std::string fault = fault_of(*workshop_, use, by_itself ? plain : base, option);
      EXPECT_EQ(fault, "") << verb << " of " << use.name << ": " << option;
    }
    EXPECT_EQ(fault_of_files(*workshop_, use, plain, options), "") << verb << " of " << use.name;
  }
}

std::vector<std::string> verbs() {
  std::vector<std::string> all;
  for (const Use& use : uses()) {
    if (std::find(all.begin(), all.end(), use.verb) == all.end()) all.emplace_back(use.verb);
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(OfEveryVerb, EveryOption, testing::ValuesIn(verbs()), [](const auto& verb) {
  std::string name = verb.param;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_F(OptionMatrix, ForceReplacesAFileThatIsSomebodyElses) {
  std::set<std::string> found;
  for (const Use& use : uses()) {
    if (!found.insert(use.verb).second) continue;
    if (cli::refusal_of(use.verb, "--force", use.facts) != nullptr) continue;
    const std::vector<std::string> options = options_of(*workshop_, use.verb);
    if (std::find(options.begin(), options.end(), "--force") == options.end()) continue;
    workshop_->write("taken.txt", "mine\n");
    const std::string line = without(use.line, "--output") + " -o @taken.txt";
    EXPECT_EQ(workshop_->run(line).code, 3) << line;
    EXPECT_EQ(workshop_->text_of("taken.txt"), "mine\n");
    EXPECT_NE(workshop_->run(line + " --force").code, 3) << line;
    EXPECT_NE(workshop_->text_of("taken.txt"), "mine\n") << line;
  }
}

}  // namespace
}  // namespace chaintrue

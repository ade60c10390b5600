// SPDX-License-Identifier: GPL-3.0-or-later
// Every verb answers each kind of input that it takes, and refuses every option that would do nothing
// there (tools/cli/arguments.hpp). The options are those of --help; that each other one changes the
// answer is tried in tests/lab/inputs.
#include <gmock/gmock.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/inputs/help.hpp"
#include "tests/inputs/input_folder.hpp"
#include "tests/inputs/invocations.hpp"

namespace chaintrue::inputs {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const InputFolder& folder() {
  static const InputFolder one;
  return one;
}

std::string help_of(const std::string& verb) { return folder().run(verb + " --help").out; }

/// A call's answer, run once for all tests.
const Ran& answer_of(const Invocation& call) {
  static std::map<std::string, Ran> answers;
  const auto known = answers.find(call.line);
  return known != answers.end() ? known->second
                                : answers.emplace(call.line, folder().run(call.line)).first->second;
}

/// The option with a valid value, as it stands in a command line.
std::string valid(const Option& option, std::string_view harmless) {
  std::string value;
  const std::vector<std::string>& values = values_of(option.name);
  if (!values.empty()) {
    value = values.front();
  } else if (!option.choices.empty()) {
    value = option.choices[option.choices[0] == harmless ? 1 : 0];
  } else if (option.type == "TEXT") {
    value = "@classic.json";
  } else if (!option.type.empty()) {
    value = option.values == 2 ? "3 3" : "3";
  }
  return option.name + (value.empty() ? "" : " " + value);
}

TEST(Invocations, EveryVerbAnswersEachKindOfInput) {
  std::set<std::string> called;
  for (const Invocation& call : invocations()) {
    called.insert(call.verb);
    const Ran& ran = answer_of(call);
    // A map unfit for cutting, a machine that is out of square: findings, reported by the exit
    // code.
    EXPECT_THAT(ran.code, AnyOf(0, 1, 4)) << call.line << "\n" << ran.err;
    EXPECT_FALSE(ran.out.empty() && ran.err.empty()) << call.line;
  }
  const auto verbs = verbs_in(help_of);
  EXPECT_EQ(called, std::set<std::string>(verbs.begin(), verbs.end()));
}

TEST(Invocations, AnswerTheSameBytesTwice) {
  for (const Invocation& call : invocations()) {
    const Ran again = folder().run(call.line);
    EXPECT_EQ(again.code, answer_of(call).code) << call.line;
    EXPECT_EQ(again.out, answer_of(call).out) << call.line;
    EXPECT_EQ(again.err, answer_of(call).err) << call.line;
    // Threads write the cells of a sweep as they finish; its results are in one order (tests/sweep).
    if (call.verb == "sweep") continue;
    EXPECT_EQ(again.files, answer_of(call).files) << call.line;
  }
}

struct Refusal {
  std::string words;
  const cli::OptionRule* rule;
};

/// The options of a verb without effect on the given input.
std::vector<Refusal> refusals_of(const Invocation& call, const std::vector<Option>& options) {
  std::vector<Refusal> refusals;
  for (const Option& option : options) {
    const cli::OptionRule* rule = refusal_of(call.verb, option.name, call.facts);
    if (rule != nullptr) refusals.push_back({valid(option, rule->harmless), rule});
  }
  return refusals;
}

bool is_refused(const Ran& ran, const Refusal& refusal) {
  return ran.code == 3 && ran.err.find(refusal.rule->option) != std::string::npos &&
         ran.err.find(refusal.rule->otherwise) != std::string::npos;
}

TEST(OptionRules, RefuseOptionsWithoutEffect) {
  std::size_t tried = 0;
  for (const std::string& verb : verbs_in(help_of)) {
    const std::vector<Option> options = options_in(help_of(verb));
    for (const Invocation& call : invocations()) {
      if (call.verb != verb) continue;
      const std::vector<Refusal> refusals = refusals_of(call, options);
      tried += refusals.size();
      std::string all = call.line;
      for (const Refusal& refusal : refusals) all += " " + refusal.words;
      const Ran together = folder().run(all);
      for (const Refusal& refusal : refusals) {
        if (is_refused(together, refusal)) continue;
        // Options that exclude each other for the parser already, or that are checked one by one.
        const std::string line = call.line + " " + refusal.words;
        const Ran ran = folder().run(line);
        EXPECT_TRUE(ran.code == 2 || is_refused(ran, refusal)) << line << "\n" << ran.err;
        EXPECT_THAT(ran.err, HasSubstr(std::string(refusal.rule->option))) << line;
        EXPECT_TRUE(ran.out.empty() && ran.files.empty()) << line;
      }
      EXPECT_TRUE(refusals.empty() || (together.out.empty() && together.files.empty())) << all;
    }
  }
  EXPECT_GT(tried, 100U);
}

TEST(Force, ReplacesFilesOfOthers) {
  std::set<std::string> tried;
  for (const Invocation& call : invocations()) {
    const std::string& line = call.line;
    const std::size_t output = line.find(" -o ");
    if (output == std::string::npos || call.verb == "sweep" ||  // into a folder
        !tried.insert(call.verb).second)
      continue;
    SCOPED_TRACE(line);
    folder().write("taken.txt", "mine\n");
    const std::string end = line.substr(output + 4);
    const std::size_t rest = std::min(end.find(' '), end.size());
    const std::string taking = line.substr(0, output) + " -o @taken.txt" + end.substr(rest);
    EXPECT_EQ(folder().run(taking).code, 3);
    EXPECT_EQ(folder().text_of("taken.txt"), "mine\n");
    EXPECT_NE(folder().run(taking + " --force").code, 3);
    EXPECT_NE(folder().text_of("taken.txt"), "mine\n");
  }
  EXPECT_GT(tried.size(), 5U);
}

/// Each reader of a file with a hash of its content is given one changed number.
TEST(ContentHash, RefusesAChangedNumber) {
  std::size_t tried = 0;
  for (const char* name : {"map.json", "anchors.json"}) {
    const auto file = nlohmann::ordered_json::parse(folder().text_of(name));
    std::vector<std::string> pointers;
    const auto flat = file.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      if (value.is_number()) pointers.push_back(pointer);
    }
    for (const Invocation& call : invocations()) {
      std::string line = call.line;
      const std::size_t at = line.find(std::string("@") + name);
      if (at == std::string::npos) continue;
      const std::string& pointer = pointers[7 * ++tried % pointers.size()];
      SCOPED_TRACE(line + " " + pointer);
      auto changed = file;
      auto& value = changed[nlohmann::ordered_json::json_pointer(pointer)];
      value = value.get<double>() + 0.25;
      folder().write("changed.json", changed.dump(1));
      const Ran ran = folder().run(line.replace(at, 1 + std::string(name).size(), "@changed.json"));
      EXPECT_EQ(ran.code, 3);
      EXPECT_FALSE(ran.err.empty());
      EXPECT_THAT(ran.files, IsEmpty());
    }
  }
  EXPECT_GT(tried, 20U);
}

}  // namespace
}  // namespace chaintrue::inputs

// SPDX-License-Identifier: GPL-3.0-or-later
// Completion and manual pages contain every verb and option of --help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using testing_support::Outcome;

class Completion : public testing_support::CommandFixture {
 protected:
  /// What bash offers at the end of a line.
  [[nodiscard]] std::string offered(const std::vector<std::string>& words) const {
    std::string list;
    for (const std::string& word : words) list += " '" + word + "'";
    return run_line("bash -c \"source <(" CHAINTRUE_COMMAND
                    " completion bash); COMP_WORDS=(chaintrue" +
                    list + "); COMP_CWORD=" + std::to_string(words.size()) +
                    "; _chaintrue; echo \\${COMPREPLY[@]}\"")
        .out;
  }
  /// The long options of a help text.
  [[nodiscard]] std::vector<std::string> options_of(const std::string& verb) const {
    std::vector<std::string> names;
    std::istringstream words(run(verb + " --help").out);
    for (std::string line; std::getline(words, line);) {
      const std::size_t at = line.find("--");
      if (line.rfind("  -", 0) != 0 || at == std::string::npos || at > 8) continue;
      names.push_back(line.substr(at, line.find_first_of(" ,", at) - at));
    }
    return names;
  }
};

TEST_F(Completion, OffersVerbsOptionsAndFiles) {
  EXPECT_EQ(offered({"dia"}), "diagnose\n");
  EXPECT_EQ(offered({"gcode", "ver"}), "verify\n");
  EXPECT_EQ(offered({"fit", "--mach"}), "--machine\n");
  EXPECT_EQ(offered({"gcode", "verify", "--tol"}), "--tolerance-mm\n");
  write("marks.csv", "x");
  EXPECT_EQ(offered({"fit", "mar"}), "marks.csv\n");
}

TEST_F(Completion, EveryShellKnowsEveryOption) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const Outcome script = run("completion " + shell);
    ASSERT_EQ(script.code, 0);
    for (const std::string verb : {"fit", "plan", "gcode compensate"}) {
      const auto options = options_of(verb);
      EXPECT_GE(options.size(), 5U) << verb;
      for (const std::string& option : options) {
        const std::string word = shell == "fish" ? "-l " + option.substr(2) : option;
        EXPECT_THAT(script.out, HasSubstr(word)) << shell << " " << verb;
      }
    }
  }
  EXPECT_EQ(run("completion csh").code, 2);
}

TEST_F(Completion, ManualPagesSayWhatHelpSays) {
  const Outcome page = run("man fit");
  EXPECT_EQ(page.code, 0);
  EXPECT_THAT(page.out,
              AllOf(StartsWith(".TH \"chaintrue\\-fit\" 1"),
                    HasSubstr(".SH NAME\nchaintrue\\-fit \\- Measured points become"),
                    HasSubstr("\\fB\\-\\-surface\\fR"),
                    HasSubstr(".SH EXIT STATUS")));
  EXPECT_THAT(run("man").out, HasSubstr("\\fBdiagnose\\fR"));
  EXPECT_THAT(run("man gcode verify").out, StartsWith(".TH \"chaintrue\\-gcode\\-verify\" 1"));
  EXPECT_EQ(run("man digagnose").code, 2);
}

}  // namespace
}  // namespace chaintrue

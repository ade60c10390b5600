// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs import and export through the command.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tests/grid_files/fixture_files.hpp"

namespace chaintrue::grid::files {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Ran {
  int exit_code = -1;
  std::string out;
  std::string err;
};

class ImportCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::string_view(CHAINTRUE_COMMAND).empty()) {
      GTEST_SKIP() << "this build was configured without the command";
    }
    ASSERT_TRUE(fs::exists(CHAINTRUE_COMMAND)) << CHAINTRUE_COMMAND;
    std::string folder = (fs::temp_directory_path() / "chaintrue.XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    folder_ = folder;
    // The examples of --help assume the repository's root, with the binary in build/.
    fs::create_symlink(CHAINTRUE_FIXTURES, folder_ / "fixtures");
    fs::create_directory(folder_ / "build");
    fs::create_symlink(CHAINTRUE_COMMAND, folder_ / "build" / "chaintrue");
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  [[nodiscard]] Ran run(const std::string& line) const {
    const std::string in_folder =
        "cd '" + folder_.string() + "' && { " + line + "\n} > .out 2> .err";
    const int status = std::system(in_folder.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            read_whole_file(folder_ / ".out"),
            read_whole_file(folder_ / ".err")};
  }

  fs::path folder_;
};

TEST_F(ImportCommand, TheExamplesOfHelpRunAsPasted) {
  for (const char* verb :
       {"import", "import optical", "import groundcontrol", "export", "export groundcontrol"}) {
    const Ran help = run(std::string("build/chaintrue ") + verb + " --help");
    EXPECT_EQ(help.exit_code, 0) << verb;
    const std::size_t example = help.out.find("Example:\n");
    ASSERT_NE(example, std::string::npos) << verb;
    const Ran ran = run(help.out.substr(example + std::string("Example:\n").size()));
    EXPECT_EQ(ran.exit_code, 0) << verb << "\n" << ran.err;
  }
  EXPECT_EQ(read_grid(folder_ / "grid.json").grid.points.size(), 310U);
  EXPECT_EQ(read_machine(folder_ / "machine.json").name, "groundcontrol_ring.ini");
}

TEST_F(ImportCommand, DataGoToStandardOutputAndTalkDoesNot) {
  const Ran ran =
      run("build/chaintrue import groundcontrol - < fixtures/good/groundcontrol_ring.ini");
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_EQ(parse_machine(ran.out, "out").name, "standard input");
  EXPECT_THAT(
      ran.err,
      HasSubstr("standard input: the settings do not say what the sled weighs; assumed 11.6 kg"));
}

TEST_F(ImportCommand, BadInputIsExitCodeThreeAndNothingIsWritten) {
  for (const char* line :
       {"build/chaintrue import groundcontrol fixtures/bad/groundcontrol_missing_keys.ini -o "
        "out.json",
        "build/chaintrue import groundcontrol no_such_file.ini -o out.json",
        "build/chaintrue import optical fixtures/bad/optical_bad_values.csv --machine "
        "fixtures/machines/groundcontrol.json -o out.json",
        "build/chaintrue import optical fixtures/good/optical_scan.csv --machine "
        "fixtures/machines/classic.json -o out.json",
        "build/chaintrue export groundcontrol fixtures/bad/machine_inches.json -o out.json"}) {
    const Ran ran = run(line);
    EXPECT_EQ(ran.exit_code, 3) << line;
    EXPECT_EQ(ran.out, "") << line;
    EXPECT_THAT(ran.err,
                ::testing::AnyOf(HasSubstr("expected"),
                               HasSubstr("There is no file no_such_file.ini here."),
                               HasSubstr("these look like inches: multiply all lengths by 25.4")))
        << line;
    EXPECT_FALSE(fs::exists(folder_ / "out.json")) << line;
  }
}

TEST_F(ImportCommand, EveryBadFileIsRefusedByItsVerbInItsOwnWords) {
  const std::map<std::string, std::string> verbs = {
      {"grid", "fit fixtures/bad/{}"},
      {"holes", "fit fixtures/bad/{}"},
      {"machine", "export groundcontrol fixtures/bad/{}"},
      {"optical", "import optical fixtures/bad/{} --machine fixtures/machines/groundcontrol.json"},
      {"groundcontrol", "import groundcontrol fixtures/bad/{}"},
      {"plotter", "export plotter fixtures/bad/{}"},
      {"drawing", "fit fixtures/bad/{}"},
      {"plottersettings", "import plotter fixtures/bad/{}"}};
  for (const FixtureFile& fixture : fixtures_in("bad")) {
    const auto verb = verbs.find(fixture.kind);
    if (verb == verbs.end()) continue;
    const Ran ran = run("build/chaintrue " +
                        fmt::format(fmt::runtime(verb->second), fixture.path.filename().string()) +
                        " -o out.json");
    EXPECT_EQ(ran.exit_code, 3) << fixture.path;
    EXPECT_EQ(ran.out, "") << fixture.path;
    for (const std::string& expected : remarks_in(fixture, "expect: "))
      EXPECT_THAT(ran.err, HasSubstr(expected));
    EXPECT_FALSE(fs::exists(folder_ / "out.json")) << fixture.path;
  }
}

TEST_F(ImportCommand, WrongUsageIsExitCodeTwo) {
  EXPECT_EQ(run("build/chaintrue import").exit_code, 2);
  EXPECT_EQ(run("build/chaintrue import optical fixtures/good/optical_scan.csv").exit_code, 2);
  EXPECT_EQ(run("build/chaintrue import optical fixtures/good/optical_scan.csv --machine "
                "fixtures/machines/groundcontrol.json "
                "--order spiral")
                .exit_code,
            2);
}

}  // namespace
}  // namespace chaintrue::grid::files

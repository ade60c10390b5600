// SPDX-License-Identifier: GPL-3.0-or-later
// Measured or typed data are never overwritten silently, write errors are reported, and no partial
// output remains. All through the command.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

constexpr const char* kProgram = "G21 G90\nG0 X0 Y0\nG1 X300 Y100 F500\nM2\n";

class Outputs : public testing_support::CommandFixture {
 protected:
  void SetUp() override {
    CommandFixture::SetUp();
    fs::copy_file(fixture("grids/seven_by_four.json"), folder_ / "g.json");
    write("b.nc", kProgram);
  }

  static std::string fixture(const std::string& name) {
    return std::string(CHAINTRUE_FIXTURES) + "/" + name;
  }
  /// A shell line in the folder, $C the command.
  [[nodiscard]] Outcome shell(const std::string& line) const {
    return run_line("C=" CHAINTRUE_COMMAND "; " + line);
  }
  void make_map() const { ASSERT_EQ(run("fit g.json -o m.json").code, 0); }

  /// Rejected with exit code 3 and this message, and `file` is unchanged.
  void expect_refused(const std::string& arguments,
                      const std::string& file,
                      const std::string& words) const {
    SCOPED_TRACE(arguments);
    const std::string before = content_of(folder_ / file);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_EQ(content_of(folder_ / file), before);
  }
  /// Number of files in the folder, without the streams of the fixture.
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      count += name != "out.txt" && name != "err.txt" ? 1 : 0;
    }
    return count;
  }
};

TEST_F(Outputs, NeverReplaceWhatIsRead) {
  make_map();
  const char* words = "found a file that is read here";
  for (const char* force : {"", " --force"}) {
    expect_refused(std::string("fit g.json -o g.json") + force, "g.json", words);
    expect_refused(std::string("diagnose g.json -o g.json") + force, "g.json", words);
    expect_refused(std::string("report m.json -o m.json") + force, "m.json", words);
    expect_refused(
        std::string("gcode compensate b.nc --map m.json -o b.nc") + force, "b.nc", words);
    expect_refused(
        std::string("gcode compensate b.nc --map m.json -o m.json") + force, "m.json", words);
    expect_refused(std::string("gcode lengths b.nc --map m.json -o b.nc") + force, "b.nc", words);
    expect_refused(std::string("query m.json 0 0 -o m.json") + force, "m.json", words);
    expect_refused(std::string("check m.json g.json -o g.json") + force, "g.json", words);
  }
}

TEST_F(Outputs, KnowAFileByWhatItIsNotByItsName) {
  fs::create_symlink("g.json", folder_ / "link.json");
  fs::create_hard_link(folder_ / "g.json", folder_ / "twin.json");
  fs::create_directory(folder_ / "sub");
  const char* words = "found a file that is read here";
  expect_refused("fit link.json -o g.json --force", "g.json", words);
  expect_refused("fit g.json -o twin.json --force", "g.json", words);
  expect_refused("fit g.json -o sub/../g.json --force", "g.json", words);
  expect_refused("fit g.json -o - --force >> g.json", "g.json", words);
}

TEST_F(Outputs, DoNotReplaceTheMachineThatAGridNames) {
  fs::copy_file(fixture("machines/classic.json"), folder_ / "machine.json");
  std::string text = content_of(folder_ / "g.json");
  const std::size_t machine = text.find("\"machine\": {");
  ASSERT_NE(machine, std::string::npos);
  std::size_t end = text.find('{', machine);
  for (int depth = 0; end < text.size(); ++end) {
    depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
    if (depth == 0) break;
  }
  text.replace(machine, end + 1 - machine, "\"machine_file\": \"machine.json\"");
  write("named.json", text);
  ASSERT_EQ(run("fit named.json -o m.json").code, 0);
  expect_refused(
      "fit named.json -o machine.json --force", "machine.json", "found a file that is read here");
}

TEST_F(Outputs, ReplaceWhatChaintrueMadeAndNothingElse) {
  make_map();
  EXPECT_EQ(run("fit g.json -o m.json").code, 0) << "a map over a map";
  write("notes.txt", "measured on Sunday\n");
  expect_refused(
      "fit g.json -o notes.txt", "notes.txt", "found a file that chaintrue did not make");
  expect_refused("report m.json -o notes.txt", "notes.txt", "--force to replace it");
  fs::copy_file(folder_ / "m.json", folder_ / "other.json");
  expect_refused("report m.json -o other.json", "other.json", "found a file of another kind");
  EXPECT_EQ(run("fit g.json -o notes.txt --force").code, 0);
  EXPECT_THAT(content_of(folder_ / "notes.txt"), HasSubstr("chaintrue_map"));
  write("program.nc", "G0 X1\n");
  expect_refused("gcode compensate b.nc --map m.json -o program.nc",
                 "program.nc",
                 "found a file that chaintrue did not make");
  ASSERT_EQ(run("gcode compensate b.nc --map m.json -o true.nc --report page.html").code, 0);
  EXPECT_EQ(run("gcode compensate b.nc --map m.json -o true.nc --report page.html").code, 0);
  ASSERT_EQ(run("gcode lengths b.nc --map m.json -o l.csv").code, 0);
  EXPECT_EQ(run("gcode lengths b.nc --map m.json -o l.csv").code, 0);
  ASSERT_EQ(run("query m.json 0 0 -o q.csv").code, 0);
  EXPECT_EQ(run("query m.json 1 1 -o q.csv").code, 0);
  EXPECT_EQ(run("query m.json 1 1 --json -o q.csv").code, 0);
  EXPECT_EQ(run("query m.json 1 1 --json -o q.csv").code, 0);
  write("empty", "");
  EXPECT_EQ(run("fit g.json -o empty").code, 0) << "nothing is lost with an empty file";
}

TEST_F(Outputs, ReplaceMeasurementsOnlyWhileNobodyChangedThem) {
  const std::string machine = " --machine " + fixture("machines/classic.json");
  ASSERT_EQ(run("simulate" + machine + " --grid 4x3 --seed 1 -o s.json").code, 0);
  EXPECT_EQ(run("simulate" + machine + " --grid 4x3 --seed 2 -o s.json").code, 0);
  std::string text = content_of(folder_ / "s.json");
  // The last one is a reading; the first is the machine's.
  const std::size_t digit = text.rfind("\"left_mm\": ") + 13;
  text[digit] = text[digit] == '5' ? '6' : '5';
  write("s.json", text);
  const char* words = "found a file that somebody wrote or changed";
  expect_refused("simulate" + machine + " --grid 4x3 --seed 2 -o s.json", "s.json", words);
  expect_refused("simulate" + machine + " --grid 4x3 --seed 2 -o g.json", "g.json", words);
  for (const char* kind : {"--points 12", "--holes 6"}) {
    SCOPED_TRACE(kind);
    const std::string plan = "plan" + machine + " " + kind + " -o plan.csv";
    fs::remove(folder_ / "plan.csv");
    ASSERT_EQ(run(plan).code, 0);
    EXPECT_EQ(run(plan).code, 0);
    std::string list = content_of(folder_ / "plan.csv");
    list.insert(list.find('\n', list.find('\n') + 1), ",1583.4,3050.2");
    write("plan.csv", list);
    expect_refused(plan, "plan.csv", words);
  }
}

TEST_F(Outputs, StandApartBeforeAnyWork) {
  make_map();
  const char* twice = "found a name given twice";
  const char* verbs[] = {"gcode compensate b.nc --map m.json -o s --report s",
                         "gcode compensate b.nc --map m.json -o s --report ./s",
                         "gcode compensate b.nc --map m.json -o - --report -",
                         "diagnose g.json -o s --report s",
                         "diagnose g.json --extended-machine s --corrected-grid s"};
  for (const char* arguments : verbs) {
    SCOPED_TRACE(arguments);
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = run(arguments);
    // A diagnosis of these points takes seconds; two seconds allow for a slow machine.
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr(twice));
    EXPECT_FALSE(exists("s"));
    EXPECT_EQ(outcome.out, "");
  }
  const Outcome outcome = run("gcode compensate b.nc --map m.json -o t.nc --report nodir/x.html");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("nodir/x.html: found a folder that does not exist"));
  EXPECT_FALSE(exists("t.nc"));
  EXPECT_EQ(run("gcode compensate b.nc --map m.json -o /dev/null --report /dev/null").code, 0);
}

TEST_F(Outputs, ThatCannotBeWrittenAreSaid) {
  make_map();
  for (const char* line : {"$C gcode compensate b.nc --map m.json -o - > /dev/full",
                           "$C gcode lengths b.nc --map m.json > /dev/full",
                           "$C gcode check b.nc > /dev/full",
                           "$C gcode explain b.nc:2 > /dev/full",
                           "$C query m.json 0 0 > /dev/full",
                           "$C fit g.json -o - > /dev/full",
                           "$C diagnose g.json --json > /dev/full",
                           "$C effects > /dev/full",
                           "$C --help > /dev/full",
                           "$C query m.json 0 0 >&-",
                           "$C effects >&-"}) {
    SCOPED_TRACE(line);
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("standard output: found "));
  }
  // A map that was written to a file remains, even if the messages about it cannot be written.
  EXPECT_EQ(shell("$C fit g.json -o n.json >&- 2>&-").code, 0);
  EXPECT_EQ(content_of(folder_ / "n.json"), content_of(folder_ / "m.json"));
  EXPECT_EQ(shell("$C fit g.json -o n.json 2>/dev/full").code, 0);
}

TEST_F(Outputs, EndQuietlyWhenNobodyReadsOn) {
  make_map();
  for (const char* line : {"$C effects --markdown | head -1",
                           "$C gcode lengths b.nc --map m.json --every-mm 0.01 | head -1",
                           "(trap '' PIPE; $C effects --markdown) | head -1"}) {
    const Outcome outcome = shell(line);
    EXPECT_EQ(outcome.code, 0) << line;
    EXPECT_EQ(outcome.err, "") << line;
  }
}

TEST_F(Outputs, KeepLinksRightsAndDevices) {
  make_map();
  const std::string verbs[] = {"gcode compensate b.nc --map m.json -o ",
                               "gcode lengths b.nc --map m.json -o "};
  for (const std::string& verb : verbs) {
    SCOPED_TRACE(verb);
    fs::remove(folder_ / "real");
    fs::remove(folder_ / "link");
    ASSERT_EQ(run(verb + "real").code, 0);
    fs::create_symlink("real", folder_ / "link");
    fs::permissions(folder_ / "real", static_cast<fs::perms>(0755));
    ASSERT_EQ(run(verb + "link").code, 0);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(static_cast<unsigned>(fs::status(folder_ / "real").permissions()), 0755U);
    fs::permissions(folder_ / "real", static_cast<fs::perms>(0444));
    const Outcome outcome = run(verb + "real --force");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("real: found a protected file"));
    ASSERT_EQ(::mkfifo((folder_ / "fifo").c_str(), 0600), 0);
    EXPECT_EQ(shell("cat fifo > got & $C " + verb + "fifo && wait").code, 0);
    EXPECT_TRUE(fs::is_fifo(folder_ / "fifo"));
    EXPECT_EQ(content_of(folder_ / "got"), content_of(folder_ / "real"));
    fs::remove(folder_ / "fifo");
    EXPECT_EQ(run(verb + "/dev/null").code, 0);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(shell("echo before > log; $C " + verb + "/dev/stdout >> log").code, 0);
    EXPECT_EQ(content_of(folder_ / "log"), "before\n" + content_of(folder_ / "real"));
  }
}

TEST_F(Outputs, LeaveNothingBehindWhenTheyAreStopped) {
  make_map();
  std::string program = "G21 G90\nG0 X0 Y0\n";
  for (int i = 0; i < 20000; ++i)
    program += "G1 X" + std::to_string(i % 700) + " Y" + std::to_string(i % 300) + " F500\n";
  write("long.nc", program);
  const std::size_t before = files();
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    for (const int wait_ms : {20, 120, 300}) {
      const pid_t child = ::fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        ASSERT_EQ(::chdir(folder_.c_str()), 0);
        const int nowhere = ::open("/dev/null", O_WRONLY);
        ::dup2(nowhere, STDERR_FILENO);
        ::execl(CHAINTRUE_COMMAND,
                "chaintrue",
                "gcode",
                "lengths",
                "long.nc",
                "--map",
                "m.json",
                "--every-mm",
                "0.5",
                "-o",
                "rows.csv",
                nullptr);
        ::_exit(127);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));
      ::kill(child, signal_number);
      int status = 0;
      ASSERT_EQ(::waitpid(child, &status, 0), child);
      ASSERT_TRUE(WIFSIGNALED(status)) << "it was over before the signal";
      EXPECT_EQ(WTERMSIG(status), signal_number);
      EXPECT_EQ(files(), before) << signal_number << " after " << wait_ms << " ms";
    }
  }
}

// File names of a user's own notes or results.
TEST_F(Outputs, InAFolderReplaceNothingOfAPerson) {
  const std::string sweep = "sweep " + fixture("sweeps/quick.json") + " -o .";
  const std::string machine = fixture("machines/groundcontrol.json");
  struct Case {
    const char* file;
    std::string command;
  };
  for (const Case& c : {Case{"results.csv", sweep},
                        Case{"summary.json", sweep},
                        Case{"report.html", sweep},
                        Case{"machine.md", "formats --all ."},
                        Case{"map.schema.json", "formats --all ."},
                        Case{"marks.csv", "start " + machine + " ."}}) {
    write(c.file, "mine\n");
    const std::size_t before = files();
    expect_refused(
        c.command, c.file, std::string(c.file) + ": found a file that chaintrue did not make");
    EXPECT_EQ(files(), before) << c.command;
    fs::remove(folder_ / c.file);
  }
}

TEST_F(Outputs, InAFolderAreReplacedByNewOnes) {
  for (int time = 0; time < 2; ++time) {
    EXPECT_EQ(run("formats --all formats").code, 0);
    EXPECT_EQ(run("sweep " + fixture("sweeps/quick.json") + " -o sweep --resume").code, 0);
  }
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "sweep"))
    names.insert(entry.path().filename().string());
  EXPECT_THAT(names, testing::ElementsAre("parts", "report.html", "results.csv", "summary.json"));
  write("sweep/summary.json", "mine\n");
  expect_refused("sweep " + fixture("sweeps/quick.json") + " -o sweep --resume",
                 "sweep/summary.json",
                 "a file that chaintrue did not make");
  EXPECT_EQ(run("sweep " + fixture("sweeps/quick.json") + " -o sweep --resume --force").code, 0);
}

// After an option without its value.
TEST_F(Outputs, AreNeverCalledAsAnOptionIs) {
  const std::size_t before = files();
  const Outcome outcome = run("effects chain_stretch --machine " +
                              fixture("machines/classic.json") + " --draw= --force");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--force, expected the name of a file"));
  EXPECT_EQ(files(), before);
}

TEST_F(Outputs, OfWhichOneCanHaveNoNameAreAllLeftUnwritten) {
  const std::size_t before = files();
  const Outcome outcome = run("square --machine " + fixture("machines/classic.json") +
                              " --controller-machine " + fixture("machines/groundcontrol.json") +
                              " -o square.svg --gcode " + std::string(300, 'x'));
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(files(), before);
}

// File systems do not accept names of this length.
TEST_F(Outputs, InAFolderThatCannotBeMadeAreRefused) {
  const std::string long_name(300, 'x');
  for (const std::string& command :
       {"formats --all " + long_name,
        std::string("formats --all ''"),
        std::string("formats --all -"),
        "start " + long_name,
        "sweep " + fixture("sweeps/quick.json") + " -o " + long_name}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.code, 3) << command;
    EXPECT_THAT(outcome.err, HasSubstr(", expected ")) << command;
  }
}

TEST_F(Outputs, OfASweepNeedAFolder) {
  const std::string sweep = "sweep " + fixture("sweeps/quick.json");
  for (const char* folder : {" -o ''", " -o -"}) {
    const Outcome outcome = run(sweep + folder);
    EXPECT_EQ(outcome.code, 3) << folder;
    EXPECT_THAT(outcome.err, HasSubstr("expected the name of a folder"));
  }
  EXPECT_FALSE(exists("-"));
}

}  // namespace
}  // namespace chaintrue

// SPDX-License-Identifier: GPL-3.0-or-later
// At a terminal: long work shows its progress, and Ctrl-C stops it without leaving files behind.
// The timing is tested in progress_test.cpp.
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::ContainsRegex;

struct Seen {
  int status = 0;
  std::string text;
};

class Terminal : public testing_support::CommandFixture {
 protected:
  /// Runs the command on its own terminal; types Ctrl-C once `words` are there.
  Seen stopped_after(const std::string& words, const std::string& arguments) const {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      const std::string line =
          "cd " + folder_.string() + " && exec " CHAINTRUE_COMMAND " " + arguments;
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    Seen screen;
    char buffer[4096];
    // On Linux reading from a terminal fails once its last process has ended.
    for (ssize_t count = 0; (count = ::read(terminal, buffer, sizeof buffer)) > 0;) {
      screen.text.append(buffer, static_cast<std::size_t>(count));
      if (screen.text.find(words) != std::string::npos && ::write(terminal, "\x03", 1) != 1) break;
    }
    ::waitpid(child, &screen.status, 0);
    ::close(terminal);
    return screen;
  }
};

// Ten million rows, written as they are computed: no machine is done before the first word.
TEST_F(Terminal, ControlCStopsAndClearsTheProgress) {
  write("b.nc", "G21 G90\nG0 X-1000 Y0\nG1 X1000 Y0 F500\nM2\n");
  done("fit " CHAINTRUE_FIXTURES "/grids/seven_by_four.json -o m.json");
  const Seen screen =
      stopped_after("s left", "gcode lengths b.nc --map m.json --every-mm 0.0002 -o l.csv");
  EXPECT_THAT(
      screen.text,
      ContainsRegex("gcode: [0-9]+ s, step 2 of 2, .*, [0-9]+ % done, about [0-9]+ s left"));
  EXPECT_TRUE(WIFSIGNALED(screen.status) && WTERMSIG(screen.status) == SIGINT) << screen.text;
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_THAT(entry.path().filename(), testing::AnyOf("b.nc", "m.json", "out.txt", "err.txt"));
}

TEST_F(Terminal, ASweepShowsTheTimeLeft) {
  const Seen screen = stopped_after(
      "s left", "sweep " CHAINTRUE_FIXTURES "/sweeps/ten_thousand.json -o sweep --threads 1");
  EXPECT_THAT(screen.text, ContainsRegex("sweep: [0-9]+ s, [0-9]+ % done, about [0-9]+ s left"));
}

}  // namespace
}  // namespace chaintrue

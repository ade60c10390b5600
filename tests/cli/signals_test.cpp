// SPDX-License-Identifier: GPL-3.0-or-later
// A command that a signal stops leaves no partial output behind.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

class Signals : public testing_support::CommandFixture {
 protected:
  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder_);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
};

// A table of ten million rows: its temporary file is there long before it is done.
TEST_F(Signals, LeaveNothingBehind) {
  write("b.nc", "G21 G90\nG0 X-1000 Y0\nG1 X1000 Y0 F500\nM2\n");
  done("fit " CHAINTRUE_FIXTURES "/grids/seven_by_four.json -o m.json");
  const std::size_t before = files();
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
      const std::string line = "cd " + folder_.string() +
                               " && exec " CHAINTRUE_COMMAND
                               " gcode lengths b.nc --map m.json --every-mm 0.0002 -o rows.csv";
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    int status = 0;
    while (files() == before && ::waitpid(child, &status, WNOHANG) == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GT(files(), before) << "no row was being written";
    ::kill(child, signal_number);
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal_number) << status;
    EXPECT_EQ(files(), before) << signal_number;
  }
}

}  // namespace
}  // namespace chaintrue

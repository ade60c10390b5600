// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command itself: killed and resumed, divided into shards, and run by several processes, a
/// sweep gives the same bytes.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/files.hpp"

namespace chaintrue {
namespace {

namespace fs = std::filesystem;
using testing_support::read_text;

const std::string kCommand = CHAINTRUE_COMMAND;
const std::string kMpirun = CHAINTRUE_MPIRUN;
const std::string kSpec = std::string(CHAINTRUE_FIXTURES) + "/sweeps/quick.json";

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) /
                          ("chaintrue_sweep_command_" + name + "_" + std::to_string(getpid()));
  fs::remove_all(folder);
  return folder;
}

pid_t start(const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  return child;
}

int finish(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string results(const fs::path& folder) {
  return read_text(folder / "results.csv") + read_text(folder / "summary.json") +
         read_text(folder / "report.html");
}

class SweepCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (kCommand.empty()) GTEST_SKIP() << "the command is not built";
    whole_folder_ = fresh_folder("whole");
    ASSERT_EQ(finish(start({kCommand, "sweep", kSpec, "-o", whole_folder_})), 0);
    whole_ = results(whole_folder_);
    ASSERT_GT(whole_.size(), 1000U);
  }
  fs::path whole_folder_;
  std::string whole_;
};

TEST_F(SweepCommand, ItsPageAnswersTheQuestion) {
  // 4 x 3 and 7 x 4 marks, two kinds of spacing.
  EXPECT_NE(whole_.find("<li>From 12 to 28 points the error goes from "), std::string::npos);
  // Both kinds agree to a hundredth.
  EXPECT_NE(whole_.find(": no difference, 0.26 mm rms at the tool with each."), std::string::npos);
}

TEST_F(SweepCommand, KilledAtAnyMomentItGoesOnToTheSameBytes) {
  const fs::path folder = fresh_folder("killed");
  for (const int milliseconds : {20, 60, 150, 300, 500}) {
    const pid_t child =
        start({kCommand, "sweep", kSpec, "-o", folder, "--resume", "--threads", "1"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, SIGKILL);
    finish(child);
  }
  ASSERT_EQ(finish(start({kCommand, "sweep", kSpec, "-o", folder, "--resume"})), 0);
  EXPECT_EQ(results(folder), whole_);
}

TEST_F(SweepCommand, ShardsGiveTheSameBytes) {
  const fs::path folder = fresh_folder("shards");
  for (const char* shard : {"2/3", "3/3", "1/3"}) {
    ASSERT_EQ(finish(start({kCommand, "sweep", kSpec, "-o", folder, "--resume", "--shard", shard})),
              0);
  }
  EXPECT_EQ(results(folder), whole_);
}

TEST_F(SweepCommand, RefusesAFolderWithResultsUnlessToldToGoOn) {
  const fs::path& folder = whole_folder_;
  EXPECT_EQ(finish(start({kCommand, "sweep", kSpec, "-o", folder})), 3);
  EXPECT_EQ(finish(start({kCommand, "sweep", kSpec, "-o", folder, "--resume"})), 0);
  EXPECT_EQ(results(folder), whole_);
}

TEST_F(SweepCommand, FourProcessesGiveTheSameBytes) {
  if (kMpirun.empty()) GTEST_SKIP() << "MPI was not found (Debian: libopenmpi-dev, openmpi-bin)";
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  // Memory that MPI's own libraries keep until the end is not a leak of this program.
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
  const fs::path folder = fresh_folder("mpi");
  ASSERT_EQ(finish(start({kMpirun,
                          "-n",
                          "4",
                          "--oversubscribe",
                          kCommand,
                          "sweep",
                          kSpec,
                          "-o",
                          folder,
                          "--threads",
                          "1"})),
            0);
  EXPECT_EQ(results(folder), whole_);
}

}  // namespace
}  // namespace chaintrue

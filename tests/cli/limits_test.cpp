// SPDX-License-Identifier: GPL-3.0-or-later
// Oversized input is refused while it is read: 256 MB of memory and 2 s of processor time for any
// refused input.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

constexpr std::size_t kAlmostTooLarge =
    15'900'000;  // bytes; files over 16 MiB are refused by their size
constexpr std::uintmax_t kFarTooLarge = 200'000'000;

using Line = std::function<std::string(std::size_t)>;
Line same(const std::string& line) {
  return [line](std::size_t) { return line; };
}

struct Flood {
  std::string file, head;
  Line line;
  std::string command;  ///< the file's name follows
};

const std::vector<Flood>& floods() {
  static const std::string kMachine =
      R"({"file_type": "chaintrue_machine", "format_version": "1.0")";
  static const std::vector<Flood> all = {
      {"marks.csv", "x_mm,y_mm,left_mm,right_mm\n", same("1.5,2.5,1700.25,1700.5\n"), "fit"},
      {"places.csv", "from_x_mm,from_y_mm,to_x_mm,to_y_mm,distance_mm\n",
       same("-300,0,300,0,604\n"), "fit"},
      {"points.json", R"({"file_type": "chaintrue_grid", "format_version": "1.0", "points": [{})",
       same(",{\"x_mm\": 1, \"y_mm\": 2, \"left_mm\": 1700, \"right_mm\": 1700}\n"), "fit"},
      {"keys.json", kMachine, [](std::size_t i) { return ",\n\"k" + std::to_string(i) + "\": 1"; },
       "fit " CHAINTRUE_FIXTURES "/grids/seven_by_four.json --machine"},
      {"twice.ini", "[Maslow Settings]\n", same("bedwidth = 2438.4\n"), "import groundcontrol"},
      {"keys.ini", "[Maslow Settings]\n",
       [](std::size_t i) { return "k" + std::to_string(i) + " = 1\n"; }, "import groundcontrol"},
      {"names.h", "#define POLARGRAPH\n#define X_BED_SIZE A0\n",
       [](std::size_t i) {
         return "#define A" + std::to_string(i) + " A" + std::to_string(i + 1) + "+1\n";
       },
       "import plotter"},
      {"deep.h", "#define POLARGRAPH\n", same("#if A\n#define B\n"), "import plotter"},
      {"long.h", "#define POLARGRAPH\n#define X_BED_SIZE 1\\\n", same("+1\\\n"), "import plotter"},
      {"keys.yaml", "kinematics:\n  WallPlotter:\n",
       [](std::size_t i) { return "    k" + std::to_string(i) + ": 1\n"; }, "import plotter"},
      {"run.log", "", same("[MSG:INFO: hello]\n"), "import maslow4"},
  };
  return all;
}

class Limits : public testing_support::CommandFixture {
 protected:
  /// Runs the command: its exit code, memory and time.
  void expect_refused_soon(const std::string& command) const {
    SCOPED_TRACE(command);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      ::dup2(::open((folder_ / "said").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      const std::string line =
          "cd " + folder_.string() + " && exec " CHAINTRUE_COMMAND " " + command + " -o out.json";
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    int status = 0;
    rusage used{};
    ASSERT_EQ(::wait4(child, &status, 0, &used), child);
    EXPECT_EQ(WIFEXITED(status) ? WEXITSTATUS(status) : -1, 3)
        << testing_support::content_of(folder_ / "said");
    EXPECT_FALSE(exists("out.json"));
    constexpr std::uintmax_t kMostSaid = 4000;  // bytes: a page of the terminal
    EXPECT_LT(std::filesystem::file_size(folder_ / "said"), kMostSaid);
// Sanitizers and unoptimised builds take several times as much of either.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    constexpr long kMostKb = 256L * 1024L;
#if defined(_GLIBCXX_ASSERTIONS)
    constexpr double kMostSeconds = 4.0;  // each access of a container is checked in such a build
#else
    constexpr double kMostSeconds = 2.0;
#endif
    EXPECT_LT(used.ru_maxrss, kMostKb);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    EXPECT_LT(seconds(used.ru_utime) + seconds(used.ru_stime), kMostSeconds);
#endif
  }
};

TEST_F(Limits, ApplyToEveryKindOfFile) {
  for (const Flood& flood : floods()) {
    std::string text = flood.head;
    for (std::size_t i = 0; text.size() < kAlmostTooLarge; ++i) text += flood.line(i);
    if (flood.file.ends_with(".json")) text += flood.file == "points.json" ? "]}" : "}";
    write(flood.file, text);
    expect_refused_soon(flood.command + " " + flood.file);
    // Twelve times as much; no more of it is read.
    if (&flood != &floods().front()) continue;
    std::filesystem::resize_file(folder_ / flood.file, kFarTooLarge);
    for (const char* command : {"fit ", "import groundcontrol ", "import plotter "})
      expect_refused_soon(command + flood.file);
  }
}

}  // namespace
}  // namespace chaintrue

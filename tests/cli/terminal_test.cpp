// SPDX-License-Identifier: GPL-3.0-or-later
// Behaviour at a terminal: progress with the time so far is shown, and Ctrl-C stops the work
// without leaving files behind.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using Clock = std::chrono::steady_clock;
using testing::ContainsRegex;
using testing::HasSubstr;

constexpr const char* kCtrlC = "\x03";
constexpr const char* kEraseLine = "\r\x1b[K";

/// The result of a command on its own terminal.
struct Seen {
  int status = 0;
  std::string text;
  /// Seconds until the first byte.
  double quiet_s = 0.0;
};

/// Lets a process run a fifth of the time, as on a slower machine: what is shown after a second
/// must not depend on the machine's speed.
class Slowed {
 public:
  explicit Slowed(pid_t process)
      : thread_([this, process] {
          while (!over_) {
            ::kill(process, SIGSTOP);
            std::this_thread::sleep_for(std::chrono::milliseconds(40));
            ::kill(process, SIGCONT);
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
          }
        }) {}
  ~Slowed() {
    over_ = true;
    thread_.join();
  }
  Slowed(const Slowed&) = delete;
  Slowed& operator=(const Slowed&) = delete;

 private:
  std::atomic<bool> over_{false};
  std::thread thread_;  // last: it uses the other
};

enum class Speed { whole, a_fifth };

class Terminal : public testing_support::CommandFixture {
 protected:
  /// Runs the command in the folder; after each new output `reply` returns the keys to type.
  [[nodiscard]] Seen shown(
      const std::string& arguments,
      const std::function<std::string(const std::string&)>& reply =
          [](const auto&) { return std::string(); },
      Speed speed = Speed::whole) const {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      const std::string line =
          fmt::format("cd {} && exec {} {}", folder_.string(), CHAINTRUE_COMMAND, arguments);
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    Seen screen;
    if (child < 0) {
      ADD_FAILURE() << "no terminal could be opened";
      return screen;
    }
    const Clock::time_point start = Clock::now();
    std::optional<Slowed> slowed;
    if (speed == Speed::a_fifth) slowed.emplace(child);
    char buffer[4096];
    // On Linux reading from a terminal fails once its last process has ended.
    for (ssize_t count = 0; (count = ::read(terminal, buffer, sizeof buffer)) > 0;) {
      if (screen.text.empty())
        screen.quiet_s = std::chrono::duration<double>(Clock::now() - start).count();
      screen.text.append(buffer, static_cast<std::size_t>(count));
      const std::string typed = reply(screen.text);
      if (!typed.empty()) {
        EXPECT_EQ(::write(terminal, typed.data(), typed.size()),
                  static_cast<ssize_t>(typed.size()));
      }
    }
    slowed.reset();
    ::waitpid(child, &screen.status, 0);
    ::close(terminal);
    return screen;
  }
  template <typename Prepare>
  [[nodiscard]] Seen shown_of_enough(const Prepare& prepare,
                                     const std::string& arguments,
                                     const std::string& words) const;
  void write_cuts(const std::string& name, int blocks) const {
    std::string program = "G21 G90\nG0 X-500 Y-300\n";
    for (int i = 0; i < blocks; ++i)
      program += fmt::format("G1 X{} Y{} F1500\n", i % 1000 - 500, i / 1000 % 600 - 300);
    write(name, program + "M2\n");
  }
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      count += name != "out.txt" && name != "err.txt" ? 1 : 0;
    }
    return count;
  }
  void simulate(int points) const {
    ASSERT_EQ(run(fmt::format("simulate --machine {}/machines/classic.json --random {} "
                              "--length-noise-mm 0.2 --position-noise-mm 0.3 --seed 1 -o g.json",
                              CHAINTRUE_FIXTURES,
                              points))
                  .code,
              0);
  }
};

// Some seconds of work at least: 300 points in diagnose (docs/reliability.md).
constexpr int kManyPoints = 300;

TEST_F(Terminal, ShowsThatWorkGoesOnAndForHowLong) {
  simulate(3000);
  const Seen screen = shown(
      "fit g.json -o m.json", [](const auto&) { return std::string(); }, Speed::a_fifth);
  ASSERT_TRUE(WIFEXITED(screen.status));
  EXPECT_EQ(WEXITSTATUS(screen.status), 0) << screen.text;
  EXPECT_GE(screen.quiet_s, 1.0) << "short work is not worth a word";
  EXPECT_THAT(screen.text, ContainsRegex("fit: 1 s, step [12] of 2, "));
  EXPECT_THAT(screen.text, ContainsRegex("settings and correction, pass [0-9]+ until it settles"));
  // The progress line is removed before the messages of the fit.
  const std::size_t words = screen.text.find("Your machine needs no map");
  ASSERT_NE(words, std::string::npos);
  EXPECT_EQ(screen.text.substr(words - std::string(kEraseLine).size(), words).find(kEraseLine), 0U);
}

TEST_F(Terminal, ShowsHowFarASweepIsAndHowLongItWillTake) {
  const Seen screen =
      shown("sweep " CHAINTRUE_FIXTURES "/sweeps/ten_thousand.json -o sweep --threads 1",
            [](const std::string& text) {
              return text.find("s left") != std::string::npos ? kCtrlC : "";
            });
  EXPECT_THAT(screen.text, ContainsRegex("sweep: [0-9]+ s, [0-9]+ % done, about [0-9]+ s left"));
}

/// Stops once `words` have been printed.
std::function<std::string(const std::string&)> stop_after(std::string words) {
  return [words = std::move(words)](const std::string& text) {
    return text.find(words) != std::string::npos ? kCtrlC : "";
  };
}

/// Runs the command on increasing amounts of work until `words` are printed: how much work takes
/// more than the second after which progress is shown depends on the machine.
template <typename Prepare>
Seen Terminal::shown_of_enough(const Prepare& prepare,
                               const std::string& arguments,
                               const std::string& words) const {
  Seen screen;
  // 400,000 take about a second on the development machine; 64 times that suits much faster ones.
  for (int amount = 400000; amount <= 64 * 400000; amount *= 4) {
    prepare(amount);
    screen = shown(arguments, stop_after(words));
    if (screen.text.find(words) != std::string::npos) break;
  }
  return screen;
}

TEST_F(Terminal, ShowsAtWhichStepADiagnosisIsAndHowLongTheGainWillTake) {
  simulate(kManyPoints);
  EXPECT_THAT(shown("diagnose g.json -o d.json", stop_after("s left")).text,
              ContainsRegex("step 3 of 4, what a name gains, block by block, [0-9]+ % done, about "
                            "[0-9]+ s left"));
  // With few points a fast machine has compared the causes before anything is shown.
  std::string text;
  const std::string words = "step 1 of 4, the causes against each other";
  for (int points = kManyPoints; points <= 4 * kManyPoints; points *= 2) {
    simulate(points);
    text = shown("diagnose g.json -o d.json", stop_after(words)).text;
    if (text.find(words) != std::string::npos) break;
  }
  EXPECT_THAT(text, ContainsRegex("diagnose: [0-9]+ s, " + words));
}

TEST_F(Terminal, ShowsHowFarACheckIsAndHowLongItWillTake) {
  simulate(300);
  ASSERT_EQ(run("fit g.json -o m.json").code, 0);
  simulate(20000);
  const Seen screen = shown("check m.json g.json", stop_after("s left"), Speed::a_fifth);
  EXPECT_THAT(screen.text,
              ContainsRegex("check: [0-9]+ s, step 1 of 2, the map at the new points, [0-9]+ % "
                            "done, about [0-9]+ s left"));
}

TEST_F(Terminal, ShowsHowFarAProgramIsAndHowLongItWillTake) {
  ASSERT_EQ(run(fmt::format("fit {}/grids/seven_by_four.json -o m.json", CHAINTRUE_FIXTURES)).code,
            0);
  for (const auto& [arguments, words] :
       {std::pair("gcode compensate b.nc --map m.json -o t.nc", "step 1 of 2, the program"),
        std::pair("gcode verify b.nc b.nc --map m.json",
                  "step 1 of 2, the program on the simulated machine"),
        std::pair("gcode check b.nc --map m.json", "step 2 of 2, its compensation")}) {
    SCOPED_TRACE(arguments);
    const Seen screen = shown_of_enough(
        [&](int blocks) { write_cuts("b.nc", blocks); }, arguments, std::string(words) + ", ");
    EXPECT_THAT(screen.text,
                ContainsRegex(
                    fmt::format("gcode: [0-9]+ s, {}, [0-9]+ % done, about [0-9]+ s left", words)));
  }
}

TEST_F(Terminal, ShowsHowFarAPlanOfHolesIs) {
  const Seen screen =
      shown(fmt::format("plan --machine {}/machines/classic.json --holes 24 -o p.json",
                        CHAINTRUE_FIXTURES),
            stop_after("s left"));
  EXPECT_THAT(screen.text,
              ContainsRegex("plan: [0-9]+ s, step 1 of 2, where the holes are cut, pass 1, [0-9]+ "
                            "% done, about [0-9]+ s left"));
}

TEST_F(Terminal, ShowsHowManyPointsOfAQueryAreAnswered) {
  ASSERT_EQ(run(fmt::format("fit {}/grids/seven_by_four.json -o m.json", CHAINTRUE_FIXTURES)).code,
            0);
  const Seen screen = shown_of_enough(
      [&](int count) {
        std::string points = "x_mm,y_mm\n";
        for (int i = 0; i < count; ++i)
          points += fmt::format("{},{}\n", i % 2000 - 1000, i / 2000 % 1000 - 500);
        write("p.csv", points);
      },
      "query m.json --points p.csv -o a.csv",
      "s left");
  EXPECT_THAT(screen.text, ContainsRegex("query: [0-9]+ s, [0-9]+ % done, about [0-9]+ s left"));
}

TEST_F(Terminal, ShowsHowFarASimulationIs) {
  const Seen screen =
      shown(fmt::format("simulate --machine {}/machines/classic.json --random 1000000 "
                        "--length-noise-mm 0.2 -o g.json",
                        CHAINTRUE_FIXTURES),
            stop_after("s left"));
  EXPECT_THAT(screen.text,
              ContainsRegex("simulate: [0-9]+ s, the machine read at every mark, [0-9]+ % done, "
                            "about [0-9]+ s left"));
}

TEST_F(Terminal, StopsOnControlCAndLeavesNothingBehind) {
  simulate(kManyPoints);
  write("b.nc", "G21 G90\nG0 X-1000 Y0\nG1 X1000 Y0 F500\nM2\n");
  ASSERT_EQ(run(fmt::format("fit {}/grids/seven_by_four.json -o m.json", CHAINTRUE_FIXTURES)).code,
            0);
  const std::size_t before = files();
  const auto once_seen = [](const char* words) {
    return [words](const std::string& text) {
      return text.find(words) != std::string::npos ? kCtrlC : "";
    };
  };
  for (const auto& [arguments, verb] :
       {std::pair("diagnose g.json -o d.json --report r.html", "diagnose: "),
        // Ten million rows, written as they are computed.
        std::pair("gcode lengths b.nc --map m.json --every-mm 0.0002 -o l.csv", "gcode: ")}) {
    SCOPED_TRACE(arguments);
    const Seen screen = shown(arguments, once_seen(verb));
    if (std::string(verb) == "gcode: ") {
      EXPECT_THAT(screen.text, ContainsRegex("[0-9]+ % done, about [0-9]+ s left"));
    }
    EXPECT_TRUE(WIFSIGNALED(screen.status) && WTERMSIG(screen.status) == SIGINT)
        << screen.status << " " << screen.text;
    EXPECT_EQ(files(), before);
  }
}

}  // namespace
}  // namespace chaintrue

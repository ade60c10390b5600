// SPDX-License-Identifier: GPL-3.0-or-later
// chaintrue square through the command: its table, its drawing, its rejections.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace chaintrue::cli {
namespace {

using testing::HasSubstr;

struct Outcome {
  int code = -1;
  std::string output;  // stdout and stderr
};

Outcome run(const std::string& arguments) {
  const std::string command =
      std::string("\"") + CHAINTRUE_COMMAND + "\" square " + arguments + " 2>&1";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return outcome;
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe))
    outcome.output.append(buffer, n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

std::string machines(const std::string& controller = "believed_straight.json") {
  const std::string folder = std::string(CHAINTRUE_FIXTURES) + "/machines/";
  return "--machine " + folder + "classic.json --controller-machine " + folder + controller;
}

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("chaintrue_square_" + name);
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(SquareCommand, PrintsWhatARulerWouldShow) {
  const Outcome outcome = run(machines() + " --at -1040 535 --below");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  for (const char* words :
       {"commanded_mm", "left", "top", "right", "bottom", "diagonal rising", "moved as a whole"}) {
    EXPECT_THAT(outcome.output, HasSubstr(words));
  }
  const Outcome own = run(machines("classic.json") + " --at -1040 535 --below");
  EXPECT_THAT(own.output, HasSubstr("100.000     100.000    "));
}

TEST(SquareCommand, DrawsTheSameBytesTwice) {
  const auto first = temporary("a.svg"), second = temporary("b.svg");
  EXPECT_EQ(run(machines() + " --at -1040 -465 -o " + first.string()).code, 0);
  EXPECT_EQ(run(machines() + " --at -1040 -465 -o " + second.string()).code, 0);
  const std::string svg = content(first);
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, testing::EndsWith("</svg>\n"));
  EXPECT_THAT(svg, HasSubstr("100 mm square at (-1040, -465) mm"));
  EXPECT_EQ(svg, content(second));
  std::filesystem::remove(first);
  std::filesystem::remove(second);
}

TEST(SquareCommand, SaysWhyAPointCannotBeCutAndWritesNothing) {
  const auto drawing = temporary("unreachable.svg");
  const Outcome outcome = run(machines() + " --at 0 1050 -o " + drawing.string());
  EXPECT_EQ(outcome.code, 4);
  EXPECT_THAT(outcome.output, HasSubstr("a sled can only hang below them"));
  EXPECT_FALSE(std::filesystem::exists(drawing));
}

TEST(SquareCommand, RefusesValuesThatAreSlips) {
  const Outcome size = run(machines() + " --at -1040 -465 --size-mm 0");
  EXPECT_EQ(size.code, 3);
  EXPECT_THAT(size.output, HasSubstr("--size-mm"));
  EXPECT_THAT(size.output, HasSubstr("1 to 5000"));
  const Outcome at = run(machines() + " --at nan -465");
  EXPECT_NE(at.code, 0);
  EXPECT_EQ(run(machines() + " --at -1040").code, 2);
  EXPECT_EQ(run("--machine /nowhere.json --controller-machine /nowhere.json --at 0 0").code, 3);
}

TEST(SquareCommand, SpeaksJson) {
  const Outcome outcome = run(machines() + " --at -1040 -465 --json");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("\"length_mm\": "));
  EXPECT_THAT(outcome.output, HasSubstr("\"rotation_rad\": "));
}

}  // namespace
}  // namespace chaintrue::cli

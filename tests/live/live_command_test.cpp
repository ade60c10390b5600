// SPDX-License-Identifier: GPL-3.0-or-later
// chaintrue maslow4, as a script and a person run it, against a machine on the loopback.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "tests/cli/command_fixture.hpp"
#include "tests/live/fake_machine.hpp"

namespace chaintrue::live {
namespace live_command_test {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;

const std::string kSettings = " --settings " CHAINTRUE_FIXTURES "/machines/maslow.yaml";

std::string the_log() {
  return grid::files::read_whole_file(CHAINTRUE_FIXTURES "/good/maslow4_log.txt");
}

class LiveCommand : public testing_support::CommandFixture {
 protected:
  [[nodiscard]] static std::string line(int port, const std::string& more) {
    return fmt::format("maslow4 --host 127.0.0.1 --port {} -o log.txt {}", port, more);
  }
  [[nodiscard]] std::string saved() const { return content_of(folder_ / "log.txt"); }
  /// On a terminal of its own; after each new output `reply` returns the keys to type.
  [[nodiscard]] std::pair<int, std::string> at_terminal(
      const std::string& arguments,
      const std::function<std::string(const std::string&)>& reply) const {
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      const std::string shell =
          fmt::format("cd {} && exec {} {}", folder_.string(), CHAINTRUE_COMMAND, arguments);
      ::execl("/bin/sh", "sh", "-c", shell.c_str(), nullptr);
      ::_exit(127);
    }
    std::string text;
    char buffer[4096];
    for (ssize_t count = 0; (count = ::read(terminal, buffer, sizeof buffer)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(count));
      const std::string keys = reply(text);
      if (!keys.empty()) {
        EXPECT_EQ(::write(terminal, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
      }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(terminal);
    return {WEXITSTATUS(status), text};
  }
};

struct Answer {
  std::string question;
  std::string keys;
};
/// Types each answer once, when its question is there.
class Answers {
 public:
  explicit Answers(std::vector<Answer> answers) : answers_(std::move(answers)) {}
  std::string operator()(const std::string& text) {
    if (next_ == answers_.size()) return "";
    const std::size_t at = text.find(answers_[next_].question, seen_);
    if (at == std::string::npos) return "";
    seen_ = at + answers_[next_].question.size();
    return answers_[next_++].keys;
  }
  [[nodiscard]] bool all_given() const { return next_ == answers_.size(); }

 private:
  std::vector<Answer> answers_;
  std::size_t next_ = 0;
  std::size_t seen_ = 0;
};

TEST_F(LiveCommand, ShowsAnchorsAndSavesTheLog) {
  const FakeMachine machine(Protocol::websocket, {Script{in_packets(the_log(), 1000, 20ms)}});
  const Outcome live = run(line(machine.port(), kSettings));
  EXPECT_EQ(live.code, 0) << live.err;
  EXPECT_THAT(live.out,
              AllOf(HasSubstr("31 places. Anchors: tl x -31.8 +- 0.4, "),
                    HasSubstr("No further place is expected to tell more.")));
  EXPECT_THAT(live.err,
              AllOf(HasSubstr("the machine closed the connection"),
                    HasSubstr("lines are saved in log.txt."),
                    HasSubstr("Next: chaintrue import maslow4 log.txt -o belts.json")));
  EXPECT_EQ(saved(), the_log());
  const Outcome import = run("import maslow4 log.txt -o belts.json");
  EXPECT_EQ(import.code, 0);
  EXPECT_THAT(import.err, HasSubstr("31 points read."));
}

TEST_F(LiveCommand, SendsNothingButQueries) {
  // No places: nothing is computed, and the machine is asked in time.
  Script script = printing("Grbl 3.0 [FluidNC]\r\n", Script::End::stays);
  script.replies = {{"?", "<Idle|MPos:0,0>\r\n"}};
  const FakeMachine machine(Protocol::telnet, {script});
  const Outcome live = run(line(machine.port(), "--telnet --patience-s 0.2 --most-s 5"));
  EXPECT_EQ(live.code, 0) << live.err;
  std::string heard = machine.heard();
  EXPECT_THAT(heard, testing::StartsWith("$GSTATE\n?"));
  heard.erase(0, 8);
  EXPECT_EQ(heard, std::string(heard.size(), '?'));
}

TEST_F(LiveCommand, ADisconnectInTheMiddleOfALineIsSavedAndSaid) {
  const std::string log = the_log().substr(0, 1234);
  ASSERT_NE(log.back(), '\n');
  const FakeMachine machine(Protocol::telnet, {printing(log)});
  const Outcome live = run(line(machine.port(), "--telnet"));
  EXPECT_EQ(live.code, 3);
  EXPECT_THAT(live.err, HasSubstr("has no end: it is saved as far as it came."));
  EXPECT_EQ(saved(), log);
}

TEST_F(LiveCommand, ConnectsAgainAndGoesOn) {
  const std::string log = the_log();
  const std::size_t middle = log.find("Measured waypoint 12") + 5;
  const FakeMachine machine(Protocol::telnet, {printing(log.substr(0, middle)), printing(log)});
  const Outcome live = run(line(machine.port(), "--telnet --reconnect 1" + kSettings));
  EXPECT_EQ(live.code, 0) << live.err;
  EXPECT_EQ(machine.connections(), 2);
  EXPECT_EQ(saved(), log.substr(0, middle) + "\n" + log);
  EXPECT_THAT(live.out, HasSubstr("31 places. "));
}

TEST_F(LiveCommand, OffersToConnectAgainAtATerminal) {
  const FakeMachine machine(Protocol::telnet, {printing("[MSG:INFO: Meas"), printing(the_log())});
  Answers answers(std::vector<Answer>{{"Connect again?", "y\n"}, {"Connect again?", "n\n"}});
  const auto [code, text] = at_terminal(line(machine.port(), "--telnet"),
                                        [&](const auto& known) { return answers(known); });
  EXPECT_TRUE(answers.all_given()) << text;
  EXPECT_EQ(code, 0) << text;
  EXPECT_EQ(saved(), "[MSG:INFO: Meas\n" + the_log());
}

TEST_F(LiveCommand, AMachineThatNeverAnswersIsGivenUp) {
  const FakeMachine mute(Protocol::websocket, {Script{{}, Script::End::stays, true}});
  const Outcome no_handshake = run(line(mute.port(), "--patience-s 0.3"));
  EXPECT_EQ(no_handshake.code, 3);
  EXPECT_THAT(no_handshake.err, HasSubstr("no answer in 0.3 s. Is the machine on"));

  const std::string log = the_log();
  const FakeMachine silent(Protocol::telnet, {printing(log, Script::End::stays)});
  const Outcome gone = run(line(silent.port(), "--telnet --patience-s 1 --force"));
  EXPECT_EQ(gone.code, 3);
  EXPECT_THAT(gone.err, HasSubstr("it says nothing any more"));
  EXPECT_EQ(saved(), log);
}

TEST_F(LiveCommand, AMachineThatIsNotThereIsASentence) {
  const Outcome refused = run(line(free_port(), "--telnet"));
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("127.0.0.1, port "),
                    HasSubstr("no connection ("),
                    HasSubstr("does its page open in a browser?")));
  EXPECT_THAT(refused.err, Not(HasSubstr("Next:")));
  EXPECT_FALSE(exists("log.txt"));
  write("log.txt", the_log());
  EXPECT_EQ(run(line(free_port(), "--telnet --force")).code, 3);
  EXPECT_EQ(saved(), the_log());
}

TEST_F(LiveCommand, AFloodIsSavedWhole) {
  std::string packet;
  while (packet.size() < 100000)
    packet += "[MSG:INFO: Servo fault!]\n<Idle|MPos:0.000,0.000|FS:0,0>\n";
  std::string all;
  std::vector<Step> steps;
  while (all.size() < std::size_t{10} << 20U) {
    steps.push_back({packet});
    all += packet;
  }
  steps.push_back({the_log()});
  all += the_log();
  const FakeMachine machine(Protocol::websocket, {Script{std::move(steps)}});
  const Outcome live = run(line(machine.port(), ""));
  EXPECT_EQ(live.code, 0) << live.err;
  EXPECT_TRUE(saved() == all);
  EXPECT_THAT(live.out, HasSubstr("31 places. "));
}

TEST_F(LiveCommand, AFileThatCannotGrowEndsIt) {
  const FakeMachine machine(Protocol::telnet, {Script{in_packets(the_log(), 500, 20ms)}});
  const Outcome live =
      run_line("(ulimit -f 4; chaintrue " + line(machine.port(), "--telnet") + ")");
  EXPECT_EQ(live.code, 3);
  EXPECT_THAT(live.err, HasSubstr("log.txt: found File too large, expected a place"));
  EXPECT_FALSE(saved().empty());
  EXPECT_TRUE(the_log().starts_with(saved()));
}

TEST_F(LiveCommand, ExistingFilesAndWrongOptionsAreRefused) {
  write("log.txt", "mine\n");
  EXPECT_EQ(run(line(free_port(), "")).code, 3);
  EXPECT_EQ(saved(), "mine\n");
  EXPECT_EQ(run("maslow4").code, 2);
  EXPECT_EQ(run("maslow4 --host 127.0.0.1").code, 2);
  EXPECT_EQ(run(line(free_port(), "--patience-s 0 --force")).code, 3);
  const Outcome drive = run(line(free_port(), "--drive --force") + " </dev/null");
  EXPECT_EQ(drive.code, 2);
  EXPECT_THAT(drive.err, HasSubstr("needs a terminal"));
}

/// Idle at first; works while it finds its anchors, then prints its log.
Script that_finds_anchors() {
  Script script = printing("<Idle|MPos:0,0>\r\n", Script::End::stays);
  script.replies = {{"?", "<Idle|MPos:0,0>\r\n"},
                    {"$CAL", "<Home|MPos:0,0>\r\n" + the_log() + "<Idle|MPos:0,0>\r\n"}};
  return script;
}

TEST_F(LiveCommand, DrivesOnlyWhereYIsTyped) {
  const FakeMachine machine(Protocol::telnet, {that_finds_anchors()});
  Answers answers(std::vector<Answer>{{"Type y to send $CAL", "y\n"}});
  const auto [code, text] =
      at_terminal(line(machine.port(), "--telnet --drive --most-s 300" + kSettings),
                  [&](const auto& known) { return answers(known); });
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, AllOf(HasSubstr("31 places. "), HasSubstr("Nothing is left to drive to.")));
  std::string heard = machine.heard();
  EXPECT_EQ(heard.find("$CAL\n"), heard.rfind("$CAL\n"));
  EXPECT_NE(heard.find("$CAL\n"), std::string::npos);
  EXPECT_EQ(heard.find("$J"), std::string::npos);
}

TEST_F(LiveCommand, ARefusalEnds) {
  const FakeMachine machine(Protocol::telnet, {that_finds_anchors()});
  Answers answers(std::vector<Answer>{{"Type y to send $CAL", "yes\n"}});
  const auto [code, text] = at_terminal(line(machine.port(), "--telnet --drive --most-s 300"),
                                        [&](const auto& known) { return answers(known); });
  EXPECT_EQ(code, 0) << text;
  EXPECT_THAT(text, HasSubstr("Nothing was sent."));
  EXPECT_EQ(machine.heard().find("$CAL"), std::string::npos);
}

TEST_F(LiveCommand, ReplaysALog) {
  write("log.txt", the_log());
  const Outcome replayed = run("maslow4 --replay log.txt" + kSettings);
  EXPECT_EQ(replayed.code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, AllOf(HasSubstr("6 places. "), HasSubstr("31 places. ")));
  write("empty.txt", "");
  EXPECT_EQ(run("maslow4 --replay empty.txt").code, 3);
  EXPECT_EQ(run("maslow4 --replay log.txt --port 81").code, 3);
}

}  // namespace live_command_test
}  // namespace chaintrue::live

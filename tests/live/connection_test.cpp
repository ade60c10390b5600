// SPDX-License-Identifier: GPL-3.0-or-later
// Connections on the loopback: every byte arrives, whatever the machine does.
#include "tools/live/connection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "grid/files/whole_file.hpp"
#include "tests/live/fake_machine.hpp"

namespace chaintrue::live {
namespace connection_test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using State = Connection::State;

/// Far more than a loopback needs: a machine that is busy with a build has taken seconds.
constexpr auto kLongEnough = 60s;

std::string the_log() {
  return grid::files::read_whole_file(CHAINTRUE_FIXTURES "/good/maslow4_log.txt");
}

struct Received {
  std::string saved;
  std::string taken;
  Connection::End end = Connection::End::none;
};

/// Until the connection ends.
Received all_of(const Address& address) {
  Received result;
  std::mutex mutex;
  Connection link(address, [&](std::string_view bytes) {
    const std::lock_guard lock(mutex);
    result.saved += bytes;
  });
  const auto begin = Clock::now();
  while (link.state() != State::over && Clock::now() - begin < kLongEnough) {
    link.wait(100ms);
    result.taken += link.take();
  }
  result.taken += link.take();
  result.end = link.end();
  return result;
}

class Connections : public testing::TestWithParam<Protocol> {
 protected:
  [[nodiscard]] static Address at(int port) { return {"127.0.0.1", port, GetParam()}; }
};

TEST_P(Connections, EveryByteArrivesInOrder) {
  for (const std::size_t packet : {std::size_t{1}, std::size_t{97}, std::size_t{100000}}) {
    const std::string log = the_log();
    const FakeMachine machine(GetParam(), {Script{in_packets(log, packet, 0ms)}});
    const Received received = all_of(at(machine.port()));
    EXPECT_EQ(received.saved, log) << packet;
    EXPECT_EQ(received.taken, log) << packet;
    EXPECT_EQ(received.end, Connection::End::closed) << packet;
  }
}

TEST_P(Connections, WhatCameBeforeAnAbruptEndIsThere) {
  const std::string log = the_log().substr(0, 1000);
  // Time for it to be read: a reset throws away what lies in the system's buffers.
  Script script = printing(log, Script::End::abrupt);
  script.steps.push_back({"", 3000ms});
  const FakeMachine machine(GetParam(), {script});
  const Received received = all_of(at(machine.port()));
  EXPECT_EQ(received.saved, log);
  EXPECT_EQ(received.end, Connection::End::lost);
}

TEST_P(Connections, NobodyListens) {
  const Received received = all_of(at(free_port()));
  EXPECT_EQ(received.end, Connection::End::no_connection);
  EXPECT_EQ(received.saved, "");
}

TEST_P(Connections, AFloodIsSavedWholeAndHeldBack) {
  const std::string line =
      "[MSG:ERR: Bad connection on Top Left encoder, failed to read 12 times]\n";
  std::string packet;
  while (packet.size() < 100000) packet += line;
  constexpr std::size_t kPackets = 105;
  const FakeMachine machine(GetParam(), {Script{std::vector<Step>(kPackets, Step{packet})}});
  std::atomic<std::size_t> saved{0};
  Connection link(at(machine.port()), [&](std::string_view bytes) { saved += bytes.size(); });
  // Nobody takes anything: what is held in memory ends at the inbox and a message.
  std::size_t before = 1;
  while (saved != before || saved == 0) {
    before = saved;
    std::this_thread::sleep_for(300ms);
  }
  EXPECT_LT(saved, (std::size_t{1} << 20U) + 2 * packet.size());
  std::size_t taken = 0;
  const auto begin = Clock::now();
  while (link.state() != State::over && Clock::now() - begin < kLongEnough) {
    link.wait(100ms);
    taken += link.take().size();
  }
  taken += link.take().size();
  EXPECT_EQ(taken, kPackets * packet.size());
  EXPECT_EQ(saved, kPackets * packet.size());
}

TEST_P(Connections, SendsQueriesAndConfirmedMoves) {
  const FakeMachine machine(GetParam(), {Script{{}, Script::End::stays}});
  {
    Connection link(at(machine.port()), [](std::string_view) {});
    const auto begin = Clock::now();
    while (link.state() == State::connecting && Clock::now() - begin < kLongEnough) link.wait(50ms);
    link.send(Query::calibration_state);
    link.send(Query::status);
    link.send(*ConfirmedMove::ask({Move::Kind::find_anchors, {}}, [](const auto&) { return "y"; }));
    while (machine.heard().find("$CAL") == std::string::npos && Clock::now() - begin < kLongEnough)
      std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(machine.heard(), "$GSTATE\n?$CAL\n");
}

INSTANTIATE_TEST_SUITE_P(OfBoth,
                         Connections,
                         testing::Values(Protocol::websocket, Protocol::telnet),
                         [](const auto& protocol) {
                           return protocol.param == Protocol::websocket ? "Websocket" : "Telnet";
                         });

TEST(Connection, AMessageOfThePageBreaksNoLine) {
  const std::string log = the_log();
  Script script;
  script.steps = {Step{"CURRENT_ID:0", 0ms, true},
                  Step{log.substr(0, 700)},
                  Step{"PING:1", 0ms, true},
                  Step{log.substr(700)}};
  const FakeMachine machine(Protocol::websocket, {script});
  const Received received = all_of({"127.0.0.1", machine.port(), Protocol::websocket});
  const std::size_t end = log.find('\n', 700) + 1;
  EXPECT_EQ(received.saved, "CURRENT_ID:0\n" + log.substr(0, end) + "PING:1\n" + log.substr(end));
}

TEST(Connection, AnotherServerIsNoWebsocket) {
  const FakeMachine machine(Protocol::telnet, {printing("SSH-2.0-OpenSSH_9.2\r\n\r\n")});
  const Received received = all_of({"127.0.0.1", machine.port(), Protocol::websocket});
  EXPECT_EQ(received.end, Connection::End::no_websocket);
}

TEST(Connection, AMachineThatSaysNothingKeepsNobodyWaiting) {
  const FakeMachine machine(Protocol::websocket, {Script{{}, Script::End::stays, true}});
  const auto begin = Clock::now();
  {
    Connection link({"127.0.0.1", machine.port(), Protocol::websocket}, [](std::string_view) {});
    link.wait(200ms);
    EXPECT_EQ(link.state(), State::connecting);
  }
  EXPECT_LT(Clock::now() - begin, kLongEnough);
}

}  // namespace connection_test
}  // namespace chaintrue::live

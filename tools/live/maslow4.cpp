// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue maslow4: listens to a machine while it finds its anchors.
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tools/cli/import_maslow4.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/verb.hpp"
#include "tools/live/watch.hpp"

namespace chaintrue::cli {
namespace {

struct LiveCommand {
  std::string host;
  std::string replay;
  std::optional<int> port;
  bool telnet = false;
  std::string output;
  double patience_s = 10.0;
  std::optional<double> most_s;
  int reconnect = 0;
  bool drive = false;
  LogReading reading;
};

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds));
}

live::WatchOptions options_of_watch(const LiveCommand& command) {
  live::WatchOptions options;
  options.address.host = command.host;
  options.address.protocol = command.telnet ? live::Protocol::telnet : live::Protocol::websocket;
  options.address.port =
      command.port.value_or(command.telnet ? live::kTelnetPort : live::kWebsocketPort);
  options.output = command.output;
  options.patience = milliseconds(command.patience_s);
  if (command.most_s) options.most = milliseconds(*command.most_s);
  options.reconnects = command.reconnect;
  options.drive = command.drive;
  options.reading = options_of(command.reading);
  return options;
}

int run_maslow4(Verb verb, const LiveCommand& command) {
  refuse_what_does_nothing(verb, command.replay.empty() ? facts::connected : facts::replayed);
  if (!command.replay.empty()) return live::replay(command.replay, options_of(command.reading));
  return live::watch(options_of_watch(command));
}

void check_usage(const LiveCommand& command) {
  if (command.host.empty()) return;
  if (command.output.empty()) missing_option("--output");
  if (command.drive && ::isatty(STDIN_FILENO) == 0) {
    usage_error("--drive",
                "needs a terminal, where somebody who sees the machine confirms each move");
  }
}

void add_connection_options(Verb verb, LiveCommand& command) {
  add_number(
      verb,
      "--port",
      command.port,
      {"", 1.0, 65535.0},
      "Where it listens: 81 for its websocket, 23 for telnet, unless it was set up otherwise");
  verb.add_flag("--telnet", command.telnet, "By telnet, in place of the websocket");
  add_output(verb,
             "-o,--output",
             command.output,
             {Origin::table},
             "Everything that the machine prints, at once: a log as import maslow4 reads it");
  add_number(
      verb,
      "--patience-s",
      command.patience_s,
      {"s", 0.1, 3600.0},
      "For a connection; after as much silence the machine is asked for a status report, and as "
      "much later taken to be gone")
      .shows_default();
  add_number(verb,
             "--most-s",
             command.most_s,
             {"s", 0.1, 1e6},
             "Ends after this time; else the machine does, or Ctrl-C");
  add_number(verb,
             "--reconnect",
             command.reconnect,
             {"", 0.0, 10000.0},
             "How often a lost connection is made again without a question")
      .shows_default();
  verb.add_flag(
      "--drive",
      command.drive,
      "Offer to drive to the place that would tell most and to find anchors from there; each "
      "move is sent only after y is typed");
}

}  // namespace

void add_maslow4(Verb app, Run& run) {
  auto command = std::make_shared<LiveCommand>();
  Verb verb =
      app.add_verb("maslow4",
                   "Listen to a Maslow 4 while it finds its anchors: anchors as places come in, "
                   "and where to measure next");
  const Verb source = verb.add_choice("source");
  source.add_option("--host", command->host, "The machine's name or address, as in maslow.local");
  add_input(source,
            "--replay",
            command->replay,
            "A saved log in its place: what would have been shown while it came in");
  add_connection_options(verb, *command);
  add_log_reading(verb, command->reading);
  verb.footer(
      "Nothing is sent but two queries, ? and $GSTATE, which move nothing; moves only with "
      "--drive, each "
      "after a y.\n\n"
      "Example:\n"
      "  build/chaintrue maslow4 --replay fixtures/good/maslow4_log.txt --settings "
      "fixtures/machines/maslow.yaml");
  verb.when_chosen([command, verb, &run] {
    check_usage(*command);
    run = [command, verb] { return run_maslow4(verb, *command); };
  });
}

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/watch_words.hpp"

#include <fmt/format.h>

namespace chaintrue::live {
namespace {

constexpr const char* kWhatToSee =
    "Is the machine on and in this network, and does its page open in a browser? Its websocket "
    "lies one "
    "above the page's port (--port 81), or at the page's own with newer firmware (--port 80); "
    "--telnet "
    "takes port 23, where telnet is switched on.";

double seconds(std::chrono::milliseconds time) {
  return static_cast<double>(time.count()) / 1000.0;
}

}  // namespace

bool is_unreached(Outcome outcome) {
  return outcome == Outcome::no_name || outcome == Outcome::no_connection ||
         outcome == Outcome::no_answer || outcome == Outcome::no_websocket;
}

std::string words_of(Outcome outcome, const WatchOptions& options, const std::string& system) {
  const std::string where = fmt::format("{}, port {}", options.address.host, options.address.port);
  switch (outcome) {
    case Outcome::no_name:
      return fmt::format(
          "{}: nobody in this network has that name. Type what opens the machine's page in a "
          "browser, as "
          "in --host maslow.local or --host 192.168.1.40.",
          options.address.host);
    case Outcome::no_connection:
      return fmt::format("{}: no connection ({}). {}", where, system, kWhatToSee);
    case Outcome::no_answer:
      return fmt::format(
          "{}: no answer in {:g} s. {}", where, seconds(options.patience), kWhatToSee);
    case Outcome::no_websocket:
      return fmt::format("{}: something answers there that is not the machine's websocket ({}). {}",
                         where,
                         system,
                         kWhatToSee);
    case Outcome::silent:
      return fmt::format(
          "{}: it says nothing any more: no answer to a query in {:g} s. Is the machine still on? "
          "Close "
          "other pages and programs that are connected to it; it serves few at a time.",
          where,
          seconds(options.patience));
    case Outcome::closed:
      return fmt::format("{}: the machine closed the connection.", where);
    case Outcome::lost:
      return fmt::format("{}: the connection was lost ({}).", where, system);
    case Outcome::time_is_over:
    case Outcome::drive_ended:
      return "";
  }
  return "";
}

}  // namespace chaintrue::live

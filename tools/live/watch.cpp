// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"
#include "tools/live/log_file.hpp"
#include "tools/live/session.hpp"
#include "tools/live/watch_words.hpp"

namespace chaintrue::live {
namespace {

namespace files = grid::files;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// An answer is computed once nothing has come for this long, since a list comes in several packets.
constexpr auto kQuiet = 300ms;
/// And at least this often, however much comes.
constexpr auto kBetweenAnswers = 2s;
/// While somebody waits for a move to end.
constexpr auto kBetweenReports = 500ms;
/// For a machine that starts anew.
constexpr auto kBeforeReconnecting = 2s;

void show(const std::vector<std::string>& lines, std::FILE* stream) {
  for (const std::string& line : lines) fmt::print(stream, "{}\n", line);
  std::fflush(stream);
}

std::optional<std::string> typed(const std::string& question) {
  fmt::print(stderr, "{}", question);
  std::fflush(stderr);
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  return line;
}

/// How long a machine has said nothing, and since when it owes an answer.
class Silence {
 public:
  explicit Silence(Clock::time_point now) : heard_(now), asked_(now), owed_since_(now) {}
  void broken(Clock::time_point now) {
    heard_ = now;
    is_owed_ = false;
  }
  void asked(Clock::time_point now) {
    asked_ = now;
    if (!is_owed_) owed_since_ = now;
    is_owed_ = true;
  }
  [[nodiscard]] Clock::duration since(Clock::time_point now) const { return now - heard_; }
  [[nodiscard]] bool is_to_ask(Clock::time_point now, const WatchOptions& options) const {
    if (options.drive) return now - asked_ > kBetweenReports;
    return !is_owed_ && now - heard_ > options.patience;
  }
  [[nodiscard]] bool is_unanswered(Clock::time_point now, std::chrono::milliseconds most) const {
    return is_owed_ && now - owed_since_ > most;
  }

 private:
  Clock::time_point heard_;
  Clock::time_point asked_;
  Clock::time_point owed_since_;
  bool is_owed_ = false;
};

class Watch {
 public:
  explicit Watch(const WatchOptions& options)
      : options_(options),
        stream_(options.output == "-" ? stderr : stdout),
        file_(options.output),
        session_(files::name_in_messages(options.output), options.reading),
        start_(Clock::now()) {}

  int run() {
    for (int left = options_.reconnects;; --left) {
      const Outcome outcome = listen();
      show(session_.news(), stream_);
      file_.check();
      if (outcome == Outcome::time_is_over || outcome == Outcome::drive_ended)
        return finish(cli::kDone);
      const std::string sentence = words_of(outcome, options_, system_words_);
      if (left <= 0 && is_unreached(outcome) && session_.text().count() == 0)
        throw files::InputError({{"", "", "", "", sentence}});
      fmt::print(stderr, "{}\n", sentence);
      const bool is_in_order = outcome == Outcome::closed && session_.text().open_line().empty();
      if (!goes_on(left)) return finish(is_in_order ? cli::kDone : cli::kBadInput);
      end_open_line();
    }
  }

 private:
  /// One connection, to its end.
  Outcome listen() {
    Connection link(options_.address, [this](std::string_view bytes) { file_.write(bytes); });
    if (const auto failed = connect(link)) return *failed;
    link.send(Query::calibration_state);
    Silence silence(Clock::now());
    Clock::time_point answered = Clock::now();
    for (;;) {
      link.wait(100ms);
      const bool is_over = link.state() == Connection::State::over;
      const std::string bytes = link.take();
      session_.take(bytes);
      file_.check();
      const Clock::time_point now = Clock::now();
      if (!bytes.empty()) silence.broken(now);
      if (is_over) {
        system_words_ = link.end_in_words();
        return link.end() == Connection::End::closed ? Outcome::closed : Outcome::lost;
      }
      if (is_time_over(now)) return Outcome::time_is_over;
      if (silence.since(now) > kQuiet || now - answered > kBetweenAnswers) {
        show(session_.news(), stream_);
        if (options_.drive && !offer_move(link)) return Outcome::drive_ended;
        answered = Clock::now();
      }
      if (silence.is_unanswered(now, options_.patience)) return Outcome::silent;
      if (!silence.is_to_ask(now, options_)) continue;
      link.send(Query::status);
      silence.asked(now);
    }
  }

  /// Empty once it is open.
  std::optional<Outcome> connect(Connection& link) {
    const Clock::time_point begin = Clock::now();
    while (link.state() == Connection::State::connecting) {
      link.wait(50ms);
      const Clock::time_point now = Clock::now();
      if (link.state() != Connection::State::connecting) break;
      if (is_time_over(now)) return Outcome::time_is_over;
      if (now - begin > options_.patience) return Outcome::no_answer;
    }
    system_words_ = link.end_in_words();
    switch (link.end()) {
      case Connection::End::no_name:
        return Outcome::no_name;
      case Connection::End::no_connection:
        return Outcome::no_connection;
      case Connection::End::no_websocket:
        return Outcome::no_websocket;
      default:
        return std::nullopt;  // what came before it ended is taken first
    }
  }

  /// False where a move is refused, or none is left.
  bool offer_move(Connection& link) {
    const auto move =
        driver_.due(session_.text().status(), session_.places(), session_.tells_most());
    if (driver_.is_done()) {
      show({"Nothing is left to drive to."}, stream_);
      return false;
    }
    if (!move) return true;
    const auto confirmed = ConfirmedMove::ask(*move, typed);
    if (!confirmed) {
      show({"Nothing was sent."}, stream_);
      return false;
    }
    link.send(*confirmed);
    driver_.sent(*move, session_.text().status());
    return true;
  }

  [[nodiscard]] bool is_time_over(Clock::time_point now) const {
    return options_.most && now - start_ > *options_.most;
  }

  [[nodiscard]] static bool goes_on(int left) {
    if (left > 0) {
      std::this_thread::sleep_for(kBeforeReconnecting);
      return true;
    }
    return ::isatty(STDIN_FILENO) != 0 &&
           typed("Connect again? Type y (anything else ends): ").value_or("") == "y";
  }

  /// What comes after a connection broke is another line.
  void end_open_line() {
    if (session_.text().open_line().empty()) return;
    file_.write("\n");
    session_.take("\n");
  }

  int finish(int code) {
    show(session_.last_words(), stream_);
    const ReceivedText& text = session_.text();
    if (!text.open_line().empty()) {
      fmt::print(stderr,
                 "Line {} of {} has no end: it is saved as far as it came.\n",
                 text.count() + 1,
                 files::name_in_messages(options_.output));
    }
    const bool is_saved = text.count() > 0 || !text.open_line().empty();
    if (is_saved) {
      fmt::print(stderr,
                 "{} lines are saved in {}.\n",
                 text.count() + (text.open_line().empty() ? 0 : 1),
                 files::name_in_messages(options_.output));
    }
    if (session_.places() > 0)
      cli::say_next({"import", "maslow4", options_.output, "-o", "belts.json"});
    return code;
  }

  const WatchOptions& options_;
  std::FILE* stream_;
  LogFile file_;
  Session session_;
  Driver driver_;
  Clock::time_point start_;
  std::string system_words_;
};

}  // namespace

int watch(const WatchOptions& options) {
  // Time goes by without work.
  cli::end_progress();
  return Watch(options).run();
}

int replay(const std::string& file, const files::Maslow4Options& reading) {
  constexpr std::size_t kSteps = 200;
  const std::string log = files::read_whole_file(file);
  Session session(files::name_in_messages(file), reading);
  cli::end_progress();
  const std::size_t step = log.size() / kSteps;
  for (std::size_t begin = 0; begin < log.size();) {
    const std::size_t least = std::min(begin + step, log.size() - 1);
    const std::size_t end = std::min(log.find('\n', least), log.size() - 1) + 1;
    session.take(std::string_view(log).substr(begin, end - begin));
    show(session.news(), stdout);
    begin = end;
  }
  const std::vector<std::string> last = session.last_words();
  show(last, session.places() == 0 ? stderr : stdout);
  if (session.places() == 0) return cli::kBadInput;
  cli::say_next({"import", "maslow4", file, "-o", "belts.json"});
  return cli::kDone;
}

}  // namespace chaintrue::live

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/canonical.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <locale>
#include <regex>
#include <sstream>

#include "tools/gcode/path.hpp"
#include "tools/gcode/program.hpp"

namespace chaintrue::witness {
namespace {

/// Stored values have nine decimals and were converted through inches; a metre has sixteen digits.
constexpr double kPlaceMm = 1e-6;
/// A centre computed from a radius: for a half circle up to rounding, half the chord is within
/// 1e-12 of the radius, and the square root of that is lost.
constexpr double kCentreMm = 1e-5;
/// Twelve digits are written, and the conversion through inches costs one.
constexpr double kFeed = 1e-9;

Call read_call(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  Call call;
  words >> call.kind;
  if (call.kind == "STATE") {
    std::getline(words >> std::ws, call.state);
    return call;
  }
  words >> call.line;
  const auto place = [&](std::array<double, 3>& values) {
    for (double& value : values) words >> value;
  };
  std::string word;
  if (call.kind == "DWELL" || call.kind == "TOOL") {
    words >> call.value;
    return call;
  }
  place(call.to);
  if (call.kind == "ARC") {
    words >> word;
    place(call.centre);
    words >> call.plane >> call.turns;
  }
  if (call.kind == "ARC" || call.kind == "FEED") {
    words >> word;
    call.feed_mm_per_min = std::stod(word.substr(1));
  }
  return call;
}

/// Converts our events to calls.
class Listener final : public gcode::Sink {
 public:
  void move(const gcode::Move& move) override {
    static constexpr const char* kKinds[] = {"RAPID", "FEED", "ARC", "PROBE"};
    Call call;
    call.kind = kKinds[static_cast<std::size_t>(move.kind)];
    call.line = move.line;
    call.to = {move.to.x_mm, move.to.y_mm, move.to.z_mm};
    call.feed_mm_per_min = move.feed.mode == gcode::FeedMode::inverse_time
                               ? move.feed.value * gcode::length_mm(move)
                               : move.feed.value;
    call.feed_tolerance = kFeed;
    if (move.arc) {
      const auto& arc = *move.arc;
      // Its length, and with it an inverse-time feed, is that of a radius between the two that the
      // rounded words give.
      if (move.feed.mode == gcode::FeedMode::inverse_time) {
        call.feed_tolerance += std::fabs(arc.end_radius_mm - arc.start_radius_mm) /
                               std::min(arc.end_radius_mm, arc.start_radius_mm);
      }
      call.centre = {arc.centre.x_mm, arc.centre.y_mm, arc.centre.z_mm};
      call.axes[0] = {arc.first.x_mm, arc.first.y_mm, arc.first.z_mm};
      call.axes[1] = {arc.second.x_mm, arc.second.y_mm, arc.second.z_mm};
      call.plane = arc.first.z_mm != 0.0 ? 18 : arc.second.z_mm != 0.0 ? 19 : 17;
      call.turns = arc.turns;
    }
    say(std::move(call));
  }

  void word(const gcode::PassedWord& word) override {
    arrive(word.line);
    const std::string& text = word.text;
    const auto number = [&](std::size_t from) {
      double value = 0.0;
      std::from_chars(text.data() + from, text.data() + text.size(), value);
      return value;
    };
    if (text.starts_with("S")) speed_ = number(1);
    if (text.starts_with("T")) selected_ = number(1);
    if (text == "M3" || text == "M4" || text == "M5") spindle_ = text;
    if (text == "M7") mist_ = true;
    if (text == "M8") flood_ = true;
    if (text == "M9") mist_ = flood_ = false;
    if (text.starts_with("G4 P")) say(with_value("DWELL", word.line, number(4)));
    if (text == "M6") {
      say(with_value("TOOL", word.line, selected_));
      spindle_ = "M5";  // the spindle stops for a tool change
    }
  }

  std::vector<Call> calls;

 private:
  static Call with_value(const char* kind, std::size_t line, double value) {
    Call call;
    call.kind = kind;
    call.line = line;
    call.value = value;
    return call;
  }

  void arrive(std::size_t line) {
    if (line == line_) return;
    line_ = line;
    found_ = state();
  }

  std::string state() const {
    std::string speed = fmt::format("{:.9f}", speed_);
    speed.erase(speed.find_last_not_of('0') + 1);
    if (speed.ends_with('.')) speed.pop_back();
    const char* coolant = mist_ && flood_ ? "M7 M8" : mist_ ? "M7" : flood_ ? "M8" : "M9";
    return fmt::format("S{} {} {}", speed, spindle_, coolant);
  }

  void say(Call call) {
    arrive(call.line);
    if (found_ != told_) {
      told_ = found_;
      Call change;
      change.kind = "STATE";
      change.state = found_;
      calls.push_back(std::move(change));
    }
    calls.push_back(std::move(call));
  }

  std::size_t line_ = 0;
  double speed_ = 0.0;
  double selected_ = 0.0;
  std::string spindle_ = "M5";
  bool mist_ = false;
  bool flood_ = false;
  std::string found_ = state();  ///< after the current line
  std::string told_ = found_;
};

std::string shown(const Call& call) {
  if (call.kind == "STATE") return "STATE " + call.state;
  if (call.kind == "DWELL" || call.kind == "TOOL")
    return fmt::format("{} {} {}", call.kind, call.line, call.value);
  std::string text = fmt::format("{} {} {:.6f} {:.6f} {:.6f}", call.kind, call.line, call.to[0],
                                 call.to[1], call.to[2]);
  if (call.kind == "ARC") {
    text += fmt::format(" C {:.6f} {:.6f} {:.6f} plane {} turns {}", call.centre[0], call.centre[1],
                        call.centre[2], call.plane, call.turns);
  }
  if (call.kind == "ARC" || call.kind == "FEED") text += fmt::format(" F{}", call.feed_mm_per_min);
  return text;
}

bool near(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= kPlaceMm;
}

/// In the arc's plane: along its axis canonical calls have no centre.
bool same_centre(const Call& linuxcnc, const Call& here) {
  for (const auto& axis : here.axes) {
    double across = 0.0;
    for (std::size_t i = 0; i < 3; ++i) across += axis[i] * (linuxcnc.centre[i] - here.centre[i]);
    if (std::fabs(across) > kCentreMm) return false;
  }
  return true;
}

bool same(const Call& linuxcnc, const Call& here) {
  if (linuxcnc.kind != here.kind) return false;
  if (linuxcnc.kind == "STATE") return linuxcnc.state == here.state;
  if (linuxcnc.line != here.line) return false;
  if (linuxcnc.kind == "DWELL" || linuxcnc.kind == "TOOL") {
    return std::fabs(linuxcnc.value - here.value) <=
           1e-11 * std::fabs(linuxcnc.value);  // 12 digits
  }
  if (!near(linuxcnc.to, here.to)) return false;
  if (linuxcnc.kind == "ARC" && (linuxcnc.plane != here.plane || linuxcnc.turns != here.turns ||
                                 !same_centre(linuxcnc, here))) {
    return false;
  }
  return linuxcnc.kind == "RAPID" || linuxcnc.kind == "PROBE" ||
         std::fabs(linuxcnc.feed_mm_per_min - here.feed_mm_per_min) <=
             here.feed_tolerance * linuxcnc.feed_mm_per_min;
}

/// Without moves of zero length: a row of cycles has a rapid to its retract plane at every hole,
/// even if it is there already. The first move is always kept.
Answer with_ways(const Answer& answer) {
  Answer result = answer;
  const std::array<double, 3>* here = nullptr;
  std::vector<Call> calls;
  for (const Call& call : answer.calls) {
    const bool straight = call.kind == "RAPID" || call.kind == "FEED";
    const bool stays = straight && here != nullptr && near(*here, call.to);
    if (straight || call.kind == "ARC" || call.kind == "PROBE") here = &call.to;
    if (!stays) calls.push_back(call);
  }
  result.calls = std::move(calls);
  return result;
}

}  // namespace

Answer read_truth(std::string_view truth) {
  Answer answer;
  std::istringstream lines{std::string(truth)};
  for (std::string line; std::getline(lines, line);) {
    if (line == "ACCEPTED") {
      answer.accepted = true;
    } else if (line.starts_with("UNKNOWN")) {
      answer.unknown = true;
    } else if (line.starts_with("REFUSED")) {
      answer.refusal = line.substr(std::min<std::size_t>(line.size(), 8));
    } else {
      answer.calls.push_back(read_call(line));
    }
  }
  return answer;
}

Answer ours(const std::string& program, gcode::Dialect dialect) {
  dialect.home_is_zero = true;  // as LinuxCNC's is
  auto source = gcode::LineSource::from_text(program);
  Listener listener;
  const auto outcome = gcode::run_program(source, dialect, listener);
  Answer answer;
  answer.calls = std::move(listener.calls);
  answer.accepted = outcome.has_value();
  if (!outcome) {
    answer.refusal = outcome.error().message();
    answer.problem = gcode::name(outcome.error().name);
    answer.problem_line = outcome.error().place.line;
  }
  return answer;
}

std::optional<std::string> difference(const Answer& linuxcnc_said, const Answer& here_said) {
  if (linuxcnc_said.unknown) return std::nullopt;
  const Answer linuxcnc = with_ways(linuxcnc_said);
  const Answer here = with_ways(here_said);
  if (linuxcnc.accepted != here.accepted) {
    return linuxcnc.accepted ? "LinuxCNC accepts, here: " + here.refusal
                             : "accepted here, LinuxCNC: " + linuxcnc.refusal;
  }
  const std::size_t both = std::min(linuxcnc.calls.size(), here.calls.size());
  for (std::size_t i = 0; i < both; ++i) {
    if (same(linuxcnc.calls[i], here.calls[i])) continue;
    return fmt::format("call {}: LinuxCNC says {}, here: {}", i, shown(linuxcnc.calls[i]),
                       shown(here.calls[i]));
  }
  if (!here.accepted || linuxcnc.calls.size() == here.calls.size()) return std::nullopt;
  const bool more = linuxcnc.calls.size() > both;
  return fmt::format("{} goes on: {}", more ? "LinuxCNC" : "our interpreter",
                     shown(more ? linuxcnc.calls[both] : here.calls[both]));
}

std::optional<std::string> unlisted_difference(const std::string& program, const Answer& linuxcnc,
                                               const Answer& here) {
  if (linuxcnc.accepted && !here.accepted &&
      (here.problem == "unsupported_code" || here.problem == "unsupported_axis" ||
       (here.problem == "bad_flow" && here.refusal.find("has no end") != std::string::npos))) {
    return std::nullopt;
  }
  static const std::regex cycle("[gG] *0*(73|8[1-9])");
  static const std::regex retract("[gG] *9[89]");
  if (std::regex_search(program, cycle) && !std::regex_search(program, retract))
    return std::nullopt;
  return difference(linuxcnc, here);
}

}  // namespace chaintrue::witness

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/belts_record.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/parse_double.hpp"
#include "grid/files/problems.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::files {
namespace {

// The lines of a pasted log as the machine printed them: without colours and control characters, and
// with messages that a terminal broke in two put together again. Private to grid/files.

struct LogLine {
  std::string text;
  std::size_t number = 0;  ///< in the file, from 1; of a message over two lines the first
};

/// The length of a colour code at `at` ("\x1b[0;32m", or "[0;32m" where a clipboard lost the first
/// character); 0 if there is none.
std::size_t colour_code(std::string_view text, std::size_t at) {
  const bool has_escape = text[at] == '\x1b';
  std::size_t next = at + (has_escape ? 1 : 0);
  if (next >= text.size() || text[next] != '[') return has_escape ? 1 : 0;
  const std::size_t first = ++next;
  while (next < text.size() && (is_digit(text[next]) || text[next] == ';')) ++next;
  if (next >= text.size()) return has_escape ? next - at : 0;
  const bool is_code = has_escape ? std::isalpha(static_cast<unsigned char>(text[next])) != 0
                                  : text[next] == 'm' && next > first;
  return is_code ? next + 1 - at : has_escape ? 1 : 0;
}

/// Without blanks and quotation marks at either end.
std::string_view unquoted(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"'";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string cleaned(std::string_view line) {
  std::string text;
  for (std::size_t at = 0; at < line.size();) {
    if (line[at] == '\x1b' || line[at] == '[') {
      if (const std::size_t length = colour_code(line, at)) {
        at += length;
        continue;
      }
    }
    const char c = line[at++];
    if (c == '\t') text += ' ';
    if (static_cast<unsigned char>(c) >= 0x20U && c != '\x7f') text += c;
  }
  return text;
}

/// A message without readings that its line does not end. The list of waypoints is the longest.
bool is_message_without_end(std::string_view line) {
  constexpr std::size_t kLongestMessage = 8000;
  return line.starts_with("[MSG") && line.find('{') == std::string_view::npos &&
         line.find("CLBM") == std::string_view::npos && line.size() < kLongestMessage &&
         std::count(line.begin(), line.end(), '[') > std::count(line.begin(), line.end(), ']');
}

/// True for a line that the machine or a terminal prints between others: a message, a status report,
/// an answer to a command.
bool is_other_output(std::string_view line) {
  const std::string_view text = unquoted(line);
  if (text.empty()) return true;
  if (text.front() == '<' || text.front() == '$' || text == "ok" || text.starts_with("error:") ||
      text.starts_with("ALARM"))
    return true;
  // "[MSG:INFO: ...]", "[G92:0,0]", "[ESP400]", but not "[{bl:.."
  return text.size() > 1 && text.front() == '[' &&
         std::isupper(static_cast<unsigned char>(text[1])) != 0 &&
         text.find('{') == std::string_view::npos;
}

/// "Run 2:", "// run three", but not "More runs:" or a sentence that runs on.
bool is_heading(std::string_view line) {
  std::string word;
  std::size_t at = line.find_first_not_of("/# \t");
  for (; at < line.size() && std::isalpha(static_cast<unsigned char>(line[at])) != 0; ++at) {
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(line[at])));
  }
  if (word != "run" || at >= line.size() || line[at] != ' ') return false;
  const std::string_view rest = unquoted(line.substr(at));
  constexpr std::size_t kLongestName = 12;
  return !rest.empty() && rest.find(' ') == std::string_view::npos && rest.size() <= kLongestName;
}

std::vector<LogLine> log_lines(const std::string& text) {
  std::vector<LogLine> lines;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = cleaned(std::string_view(text).substr(begin, end - begin));
    ++number;
    begin = end + 1;
    const bool goes_on = !lines.empty() && !line.empty() && lines.back().number + 1 == number &&
                         is_message_without_end(lines.back().text) && !is_other_output(line) &&
                         !is_heading(line) && line.find('{') == std::string::npos &&
                         line.find("CLBM") == std::string::npos;
    if (goes_on) {
      lines.back().text += line;
    } else {
      lines.push_back({std::move(line), number});
    }
  }
  return lines;
}

/// The number that follows a word, blanks skipped; empty if there is none.
std::optional<double> number_after(std::string_view line, std::string_view word) {
  const std::size_t at = line.find(word);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t from = at + word.size();
  while (from < line.size() && line[from] == ' ') ++from;
  const std::size_t end = line.find_first_not_of("+-.0123456789eE", from);
  return number_of(line.substr(from, end == std::string_view::npos ? end : end - from));
}

/// The number of a waypoint; empty if a line that looks like a message contains none.
std::optional<int> waypoint_of(std::optional<double> number) {
  constexpr double kMost = 1e6;  // the firmware's are a few hundred
  if (!number || !(*number >= 0.0) || !(*number <= kMost) || *number != std::floor(*number))
    return std::nullopt;
  return static_cast<int>(*number);
}

/// A reading has some 60 characters; a terminal breaks it over two lines, seldom three.
constexpr std::size_t kLongestReading = 200;
constexpr std::size_t kMostLines = 3;

}  // namespace

using model::Belt;
using model::kBelts;

void ReadingReader::begin(std::size_t number, std::size_t column) {
  open_ = true;
  text_.clear();
  outside_.clear();
  line_ = number;
  column_ = column;
  lines_ = 1;
}

ReadingReader::Found ReadingReader::take(std::string_view line, std::size_t number) {
  Found found;
  const auto add = [&found](std::optional<ScannedReading> reading) {
    if (reading) found.readings.push_back(*std::move(reading));
  };
  outside_.clear();
  if (open_) ++lines_;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (open_ && (c == '}' || c == '{' || c == ']')) {
      open_ = false;
      // A number that another sign ends is whole, though the bracket is lost.
      add(read(text_, End::closed));
      found.list_ends = found.list_ends || c == ']';
      if (c == '{') begin(number, at + 1);
    } else if (open_) {
      text_ += c;
    } else if (c == '{') {
      begin(number, at + 1);
    } else if (c == '}') {
      line_ = number;
      column_ = 1;
      add(read(outside_, End::closed));
      outside_.clear();
    } else if (c == ']') {
      found.list_ends = true;
    } else {
      outside_ += c;
    }
  }
  if (open_ && (text_.size() > kLongestReading || lines_ > kMostLines)) add(give_up());
  return found;
}

std::optional<ScannedReading> ReadingReader::give_up() {
  if (!open_) return std::nullopt;
  open_ = false;
  return read(text_, End::lost);
}

std::optional<ScannedReading> ReadingReader::read(const std::string& text, End end) const {
  Problems problems(file_);
  const std::string place = line_and_column(line_, column_);
  model::PerBelt<double> lengths_mm;
  model::PerBelt<bool> known;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, comma - begin);
    begin = comma + 1;
    const std::size_t colon = part.find(':');
    if (colon == std::string_view::npos) continue;
    const auto belt = model::belt_of(unquoted(part.substr(0, colon)));
    if (!belt) continue;
    if (known[*belt]) {
      problems.add(place,
                   std::string(unquoted(part)),
                   "each belt once in a reading",
                   ProblemKind::repeated_value);
      continue;
    }
    known[*belt] = true;
    const auto value = checked_number(
        unquoted(part.substr(colon + 1)), place, name(*belt), kBeltLengthMm, problems);
    if (value) lengths_mm[*belt] = *value;
  }
  // Objects of other programs.
  if (none_of(kBelts, [&](Belt belt) { return known[belt]; })) return std::nullopt;
  const std::string whole = fmt::format("{{{}{}", unquoted(text), end == End::lost ? "" : "}");
  for (const Belt belt : kBelts) {
    if (!known[belt]) {
      problems.add(place,
                   whole,
                   fmt::format("a length of {} too; a reading has tl, tr, bl and br", name(belt)),
                   ProblemKind::missing);
    }
  }
  if (end == End::lost && !problems.any())
    problems.add(place,
                 whole,
                 "a complete reading; the log ends in the middle of this one",
                 ProblemKind::missing);
  ScannedReading reading;
  reading.line = line_;
  reading.problems = problems.list();
  if (!problems.any()) reading.lengths_mm = lengths_mm;
  return reading;
}

namespace {

using model::Belt;
using model::kBelts;
using Singles = model::PerBelt<std::vector<double>>;

/// Unreadable entries match anything.
bool same(const ScannedReading& a, const ScannedReading& b) {
  return !a.lengths_mm || !b.lengths_mm || *a.lengths_mm == *b.lengths_mm;
}

/// `list` begins with `points`, or the other way round.
bool begins_equally(const std::vector<ScannedReading>& points,
                    const std::vector<ScannedReading>& list) {
  const auto shared = static_cast<std::ptrdiff_t>(std::min(points.size(), list.size()));
  return std::equal(points.begin(), points.begin() + shared, list.begin(), same);
}

class Scanner {
 public:
  explicit Scanner(const std::string& file) : reader_(file) {}

  ScannedLog scan(const std::string& text) {
    for (const LogLine& line : log_lines(text)) {
      line_ = line.number;
      take_line(line.text);
    }
    return finish();
  }

 private:
  ScannedRun& run() {
    if (runs_.empty()) begin_run("");
    return runs_.back();
  }

  /// Readings from here on belong to another run.
  void begin_run(std::string heading) {
    if (!runs_.empty() && runs_.back().points.empty()) {
      if (!heading.empty()) runs_.back().heading = std::move(heading);
      return;
    }
    runs_.emplace_back();
    runs_.back().heading = std::move(heading);
    runs_.back().first_line = line_;
    runs_.back().pull_ma = pull_ma_;
    ended_.reset();
  }

  void take_line(std::string_view line) {
    const std::size_t comment = line.find("//");
    const std::size_t brace = line.find_first_of("{}");
    const bool is_list = line.find("CLBM:") != std::string_view::npos;
    if (is_list) open_list();
    if (reader_.is_open() && !is_list) {
      if (is_other_output(line)) return take_message(line);
      return take_braces(line.substr(0, comment), false);
    }
    if (brace == std::string_view::npos || comment < brace) {
      if (is_heading(line)) {
        close_list();
        begin_run(std::string(unquoted(line)));
      }
      take_message(line);
      if (is_open_list_ && !is_other_output(line)) take_braces(line.substr(0, comment), false);
      return;
    }
    take_braces(line.substr(0, comment), is_list);
  }

  void open_list() {
    give_up();
    close_list();
    is_open_list_ = true;
  }

  void close_list() {
    is_open_list_ = false;
    take_list();
    list_.clear();
  }

  /// In a list without its heading, several readings are on a line.
  void take_braces(std::string_view line, bool is_list) {
    const bool is_bare_list =
        !is_list && !is_open_list_ && std::count(line.begin(), line.end(), '{') > 1;
    ReadingReader::Found found = reader_.take(line, line_);
    if (is_bare_list) is_open_list_ = true;
    is_bare_ = is_bare_list || (is_bare_ && is_open_list_);
    if (is_open_list_) {
      for (ScannedReading& reading : found.readings) list_.push_back(std::move(reading));
      if (found.list_ends || (is_bare_ && !reader_.is_open())) close_list();
    } else {
      for (ScannedReading& reading : found.readings) run().points.push_back(std::move(reading));
    }
  }

  void give_up() {
    auto reading = reader_.give_up();
    if (!reading) return;
    (is_open_list_ ? list_ : run().points).push_back(*std::move(reading));
  }

  /// Waypoints may be printed again in the middle of a run: a list that begins with the previous
  /// run continues it.
  void join_longer_list() {
    if (runs_.size() < 2 || !runs_.back().points.empty()) return;
    ScannedRun& before = runs_[runs_.size() - 2];
    if (before.points.size() > list_.size() || !begins_equally(before.points, list_)) return;
    ScannedRun& own = runs_.back();
    for (const auto& [waypoint, at] : own.commanded) before.commanded[waypoint] = at;
    for (auto& [waypoint, lengths] : own.thrown_away_mm)
      before.thrown_away_mm[waypoint] = std::move(lengths);
    for (auto& [waypoint, lengths] : own.last_attempt_mm)
      before.last_attempt_mm[waypoint] = std::move(lengths);
    before.last_measured = std::max(before.last_measured, own.last_measured);
    before.last_announced = std::max(before.last_announced, own.last_announced);
    runs_.pop_back();
  }

  /// A list grows and is printed again; single points follow one by one. If one print is damaged
  /// the other may have the reading.
  void take_list() {
    if (list_.empty()) return;
    join_longer_list();
    std::vector<ScannedReading>& points = run().points;
    if (begins_equally(points, list_)) {
      for (std::size_t i = 0; i < list_.size(); ++i) {
        if (i >= points.size()) {
          points.push_back(list_[i]);
        } else if (!points[i].lengths_mm && list_[i].lengths_mm) {
          points[i] = list_[i];
        }
      }
    } else if (list_.size() == 1) {
      if (!same(points.back(), list_.front())) points.push_back(list_.front());
    } else {
      begin_run("");
      run().points = list_;
    }
    run().is_list = true;
    if (list_.size() > 1)
      run().list_is_short = static_cast<int>(list_.size()) < run().last_measured + 1;
  }

  void take_message(std::string_view line) {
    if (line.find("Waypoints [") != std::string_view::npos) {
      close_list();
      if (line.find("Waypoints [0-") != std::string_view::npos) begin_run("");
      take_waypoints(line);
    } else if (const auto measured = waypoint_of(number_after(line, "Measured waypoint "))) {
      if (*measured == 0 && !run().points.empty()) begin_run("");
      run().last_measured = std::max(run().last_measured, *measured);
      note_thrown_away(*measured);
      ended_.reset();
    } else if (const auto at = waypoint_of(number_after(line, "Waypoint "));
               at && line.find("coordinates:") != std::string_view::npos) {
      const auto x = number_after(line, "X=");
      const auto y = number_after(line, "Y=");
      if (x && y) run().commanded[*at] = {*x, *y};
    } else if (const auto rms = number_after(line, "Find Anchors fit: rms=")) {
      run().fit = FirmwareFit{*rms, number_after(line, "max=").value_or(0.0)};
      ended_.reset();
    } else if (const auto pull_ma = number_after(line, "Maslow_Calibration_Current_Threshold=")) {
      constexpr double kMostMilliamperes = 1e5;
      if (*pull_ma > 0.0 && *pull_ma < kMostMilliamperes) pull_ma_ = *pull_ma;
      if (!runs_.empty() && runs_.back().points.empty()) runs_.back().pull_ma = pull_ma_;
    } else if (is_setting_refused(line)) {
      if (!refused_) refused_ = SettingsRefused{line_, std::string(unquoted(line))};
    } else if (const auto kind = stop_of(line)) {
      if (*kind == StopKind::readings_disagree) attempt_ = {};
      if (!ended_ || *kind == StopKind::gave_up_reading)
        ended_ = RunStopped{*kind, line_, std::string(unquoted(line))};
    } else {
      take_single_reading(line);
    }
  }

  /// `(0:-9.0,10.4) (1:141.0,10.4)`
  void take_waypoints(std::string_view line) {
    for (std::size_t at = line.find('('); at != std::string_view::npos;
         at = line.find('(', at + 1)) {
      const std::size_t end = line.find(')', at);
      if (end == std::string_view::npos) return;
      const std::string_view entry = line.substr(at + 1, end - at - 1);
      const std::size_t colon = entry.find(':');
      const std::size_t comma = entry.find(',');
      if (colon == std::string_view::npos || comma == std::string_view::npos || comma < colon)
        continue;
      const auto waypoint = waypoint_of(number_of(unquoted(entry.substr(0, colon))));
      const auto x = number_of(unquoted(entry.substr(colon + 1, comma - colon - 1)));
      const auto y = number_of(unquoted(entry.substr(comma + 1)));
      if (!waypoint || !x || !y) continue;
      run().commanded[*waypoint] = {*x, *y};
      run().last_announced = std::max(run().last_announced, *waypoint);
    }
  }

  void take_single_reading(std::string_view line) {
    constexpr std::array<std::pair<std::string_view, Belt>, 4> kLabels = {
        std::pair{"Top Left ", Belt::tl},
        std::pair{"Top Right ", Belt::tr},
        std::pair{"Bottom Left ", Belt::bl},
        std::pair{"Bottom Right ", Belt::br}};
    bool is_reading = false;
    for (const auto& [label, belt] : kLabels) {
      const auto value = number_after(line, label);
      if (!value || !kBeltLengthMm.holds(*value)) continue;
      is_reading = true;
      loose_[belt].push_back(*value);
      attempt_[belt].push_back(*value);
    }
    const std::string_view text = unquoted(line);
    const bool is_comment = text.starts_with('#') || text.starts_with("//");
    if (!is_reading && !text.empty() && !is_comment && !first_passed_over_)
      first_passed_over_ = line_;
  }

  /// Single readings that were discarded are printed before the measurement of their waypoint.
  void note_thrown_away(int waypoint) {
    if (loose_ != Singles{}) {
      run().thrown_away_mm[waypoint] = std::move(loose_);
      run().last_attempt_mm[waypoint] = std::move(attempt_);
    }
    loose_ = {};
    attempt_ = {};
  }

  ScannedLog finish() {
    ScannedLog log;
    log.list_has_end = !reader_.is_open() && !is_open_list_;
    give_up();
    close_list();
    if (!runs_.empty()) {
      const ScannedRun& last = runs_.back();
      const auto measured = std::max(last.last_measured, static_cast<int>(last.points.size()) - 1);
      // A log without an end gives the reason in its last lines; measured and announced waypoints
      // show the rest.
      if (!ended_ && last.last_measured >= 0 && measured < last.last_announced)
        ended_ = RunStopped{StopKind::log_ends, line_, ""};
      // An error of something else, after the last waypoint.
      if (ended_ && ended_->kind == StopKind::other_error && !last.points.empty() &&
          measured >= last.last_announced)
        ended_.reset();
      if (ended_) {
        ended_->last_measured = measured;
        ended_->last_announced = last.last_announced;
        ended_->readings_mm = attempt_;
      }
    }
    log.stopped = std::move(ended_);
    log.refused = std::move(refused_);
    log.first_passed_over = first_passed_over_;
    std::erase_if(runs_, [](const ScannedRun& run) {
      return run.points.empty() && run.last_attempt_mm.empty();
    });
    log.runs = std::move(runs_);
    return log;
  }

  ReadingReader reader_;
  std::vector<ScannedRun> runs_;
  std::size_t line_ = 0;
  bool is_open_list_ = false;
  bool is_bare_ = false;  ///< the open list has no heading: it ends with its line
  std::vector<ScannedReading> list_;
  Singles loose_;
  Singles attempt_;  ///< of these the last attempt's
  std::optional<RunStopped> ended_;
  std::optional<SettingsRefused> refused_;
  std::optional<std::size_t> first_passed_over_;
  std::optional<double> pull_ma_;
};

}  // namespace

ScannedLog scan_maslow4(const std::string& text, const std::string& file) {
  return Scanner(file).scan(text);
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_scan.hpp"

#include <algorithm>
#include <array>

#include "grid/containers.hpp"
#include "grid/files/maslow4_text.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/pattern.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

using Singles = PerBelt<std::vector<double>>;

/// Unreadable entries match anything.
bool same(const ScannedReading& a, const ScannedReading& b) {
  return !a.lengths_mm || !b.lengths_mm || *a.lengths_mm == *b.lengths_mm;
}

/// `list` begins with `points`, or the other way round.
bool begins_equally(const std::vector<ScannedReading>& points,
                    const std::vector<ScannedReading>& list) {
  const auto shared = as_index(std::min(points.size(), list.size()));
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
    const bool is_list = has(line, "CLBM:");
    if (is_list) open_list();
    if (reader_.is_open() && !is_list) {
      if (is_other_output(line)) return take_message(line);
      return take_braces(line.substr(0, comment), false);
    }
    if (brace == npos || comment < brace) {
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
    const bool is_bare_list = !is_list && !is_open_list_ && count_equal(line, '{') > 1;
    ReadingReader::Found found = reader_.take(line, line_);
    if (is_bare_list) is_open_list_ = true;
    is_bare_ = is_bare_list || (is_bare_ && is_open_list_);
    for (ScannedReading& reading : found.readings) take(std::move(reading));
    if (is_open_list_ && (found.list_ends || (is_bare_ && !reader_.is_open()))) close_list();
  }

  void give_up() {
    if (auto reading = reader_.give_up()) take(*std::move(reading));
  }

  void take(ScannedReading reading) {
    (is_open_list_ ? list_ : run().points).push_back(std::move(reading));
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
      for (const auto i : each_index(list_)) {
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
    if (list_.size() > 1) run().list_is_short = as_int(list_.size()) < run().last_measured + 1;
  }

  void take_message(std::string_view line) {
    if (has(line, "Waypoints [")) {
      close_list();
      if (has(line, "Waypoints [0-")) begin_run("");
      take_waypoints(line);
    } else if (const auto measured = waypoint_of(number_after(line, "Measured waypoint "))) {
      if (*measured == 0 && !run().points.empty()) begin_run("");
      run().last_measured = std::max(run().last_measured, *measured);
      note_thrown_away(*measured);
      ended_.reset();
    } else if (const auto at = waypoint_of(number_after(line, "Waypoint "));
               at && has(line, "coordinates:")) {
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
    for (std::size_t at = line.find('('); at != npos; at = line.find('(', at + 1)) {
      const std::size_t end = line.find(')', at);
      if (end == npos) return;
      const auto part = match(line.substr(at + 1, end - at - 1), "([^:,]*):([^,]*),(.*)");
      if (part.empty()) continue;
      const auto waypoint = waypoint_of(number_of(unquoted(part[1])));
      const auto x = number_of(unquoted(part[2]));
      const auto y = number_of(unquoted(part[3]));
      if (!waypoint || !x || !y) continue;
      run().commanded[*waypoint] = {*x, *y};
      run().last_announced = std::max(run().last_announced, *waypoint);
    }
  }

  void take_single_reading(std::string_view line) {
    constexpr std::array<std::pair<std::string_view, Belt>, 4> kLabels = {
        std::pair{"Top Left ", Belt::tl}, std::pair{"Top Right ", Belt::tr},
        std::pair{"Bottom Left ", Belt::bl}, std::pair{"Bottom Right ", Belt::br}};
    bool is_reading = false;
    for (const auto& [label, belt] : kLabels) {
      const auto value = number_after(line, label);
      if (!value || !kLengthMm.holds(*value)) continue;
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
      const auto measured = std::max(last.last_measured, as_int(last.points.size()) - 1);
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

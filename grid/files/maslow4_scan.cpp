// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/maslow4_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "grid/files/belts_record.hpp"
#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Belt;
using model::kBelts;

std::string_view unquoted(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n\"'";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// The number that begins at `from`, blanks skipped.
std::optional<double> number_at(std::string_view line, std::size_t from) {
  while (from < line.size() && line[from] == ' ') ++from;
  const std::size_t end = line.find_first_not_of("+-.0123456789eE", from);
  return number_of(line.substr(from, end == std::string_view::npos ? end : end - from));
}

std::optional<double> number_after(std::string_view line, std::string_view word) {
  const std::size_t at = line.find(word);
  return at == std::string_view::npos ? std::nullopt : number_at(line, at + word.size());
}

/// The number of a waypoint; empty if a line that looks like a message contains none.
std::optional<int> waypoint_of(std::optional<double> number) {
  constexpr double kMost = 1e6;  // the firmware's are a few hundred
  if (!number || !(*number >= 0.0) || !(*number <= kMost) || *number != std::floor(*number))
    return std::nullopt;
  return static_cast<int>(*number);
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

class Scanner {
 public:
  Scanner(const std::string& text, Problems& problems) : text_(text), problems_(problems) {}

  std::vector<ScannedRun> scan() {
    std::size_t begin = 0;
    while (begin < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      ++line_;
      take_line(begin, end);
      begin = end + 1;
    }
    finish();
    return std::move(runs_);
  }

 private:
  ScannedRun& run() {
    if (runs_.empty()) runs_.emplace_back();
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
  }

  void take_line(std::size_t begin, std::size_t end) {
    const std::string_view line(text_.data() + begin, end - begin);
    if (open_reading_) {
      take_braces(line);
      return;
    }
    const std::size_t comment = line.find("//");
    const std::size_t brace = line.find('{');
    if (brace == std::string_view::npos || comment < brace) {
      if (is_heading(line)) begin_run(std::string(unquoted(line)));
      if (list_line_ == 0) take_message(line);
      if (line.find("CLBM:[") != std::string_view::npos) open_list();
      close_list(line);
      return;
    }
    if (line.find("CLBM:[") != std::string_view::npos) open_list();
    take_braces(line.substr(0, comment));
  }

  void open_list() {
    list_line_ = line_;
    list_.clear();
  }

  void close_list(std::string_view line) {
    if (list_line_ == 0 || line.find(']') == std::string_view::npos) return;
    list_line_ = 0;
    take_list();
  }

  /// Readings of a line, or its part of a list that continues over lines.
  void take_braces(std::string_view line) {
    for (std::size_t at = 0; at < line.size(); ++at) {
      const char c = line[at];
      if (open_reading_) {
        if (c == '}') {
          open_reading_ = false;
          take_reading();
        } else {
          reading_ += c;
        }
      } else if (c == '{') {
        open_reading_ = true;
        reading_.clear();
        reading_line_ = line_;
        reading_column_ = at + 1;
      } else if (c == ']') {
        close_list("]");
      }
    }
    if (open_reading_) reading_ += ' ';
  }

  /// `bl:2960.58, br:3150.08, tr:3067.72, tl:3049.85`; objects of other programs are skipped.
  void take_reading() {
    ScannedPoint point;
    point.line = reading_line_;
    model::PerBelt<bool> seen;
    bool is_reading = false;
    bool is_whole = true;
    std::size_t begin = 0;
    while (begin < reading_.size()) {
      const std::size_t end = std::min(reading_.find(',', begin), reading_.size());
      const std::string_view part(reading_.data() + begin, end - begin);
      begin = end + 1;
      const std::size_t colon = part.find(':');
      const auto belt = model::belt_of(unquoted(part.substr(0, colon)));
      if (!belt || colon == std::string_view::npos) continue;
      is_reading = true;
      if (seen[*belt]) {
        is_whole = false;
        problems_.add(place(), std::string(unquoted(part)), "each belt once in a reading");
      }
      seen[*belt] = true;
      const auto value = checked_number(
          unquoted(part.substr(colon + 1)), place(), name(*belt), kBeltLengthMm, problems_);
      if (value) point.lengths_mm[*belt] = *value;
      is_whole = is_whole && value.has_value();
    }
    if (!is_reading) return;
    for (const Belt belt : kBelts) {
      if (seen[belt]) continue;
      is_whole = false;
      problems_.add(
          place(),
          fmt::format("{{{}}}", unquoted(reading_)),
          fmt::format("a length of {} as well: a reading has tl, tr, bl and br", name(belt)));
    }
    if (!is_whole) return;
    if (list_line_ != 0) {
      list_.push_back(point);
    } else {
      run().points.push_back(point);
    }
  }

  /// Waypoints may be printed again in the middle of a run: a list that begins with the previous
  /// run continues it.
  void join_longer_list() {
    if (runs_.size() < 2 || !runs_.back().points.empty()) return;
    ScannedRun& before = runs_[runs_.size() - 2];
    const bool goes_on =
        before.points.size() <= list_.size() &&
        std::equal(before.points.begin(),
                   before.points.end(),
                   list_.begin(),
                   [](const auto& a, const auto& b) { return a.lengths_mm == b.lengths_mm; });
    if (!goes_on) return;
    for (const auto& [waypoint, at] : runs_.back().commanded) before.commanded[waypoint] = at;
    for (auto& [waypoint, lengths] : runs_.back().thrown_away_mm) {
      before.thrown_away_mm[waypoint] = std::move(lengths);
    }
    runs_.pop_back();
  }

  /// A list grows and is printed again; single points follow one by one.
  void take_list() {
    if (list_.empty()) return;
    const auto same = [](const ScannedPoint& a, const ScannedPoint& b) {
      return a.lengths_mm == b.lengths_mm;
    };
    join_longer_list();
    std::vector<ScannedPoint>& points = run().points;
    const std::size_t shared = std::min(points.size(), list_.size());
    const bool is_again = std::equal(
        points.begin(), points.begin() + static_cast<std::ptrdiff_t>(shared), list_.begin(), same);
    if (points.empty() || is_again) {
      if (list_.size() > points.size()) points = list_;
    } else if (list_.size() == 1) {
      if (!same(points.back(), list_.front())) points.push_back(list_.front());
    } else {
      begin_run("");
      run().points = list_;
    }
    run().is_list = true;
  }

  void take_message(std::string_view line) {
    if (line.find("Waypoints [") != std::string_view::npos) {
      if (line.find("Waypoints [0-") != std::string_view::npos) begin_run("");
      take_waypoints(line);
    } else if (const auto measured = waypoint_of(number_after(line, "Measured waypoint "))) {
      if (*measured == 0 && !run().points.empty()) begin_run("");
      note_thrown_away(*measured);
    } else if (const auto at = waypoint_of(number_after(line, "Waypoint "));
               at && line.find("coordinates:") != std::string_view::npos) {
      const auto x = number_after(line, "X=");
      const auto y = number_after(line, "Y=");
      if (x && y) run().commanded[*at] = {*x, *y};
    } else if (const auto rms = number_after(line, "Find Anchors fit: rms=")) {
      run().fit = FirmwareFit{*rms, number_after(line, "max=").value_or(0.0)};
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
      if (waypoint && x && y) run().commanded[*waypoint] = {*x, *y};
    }
  }

  void take_single_reading(std::string_view line) {
    constexpr std::array<std::pair<std::string_view, Belt>, 4> kLabels = {
        std::pair{"Top Left ", Belt::tl},
        std::pair{"Top Right ", Belt::tr},
        std::pair{"Bottom Left ", Belt::bl},
        std::pair{"Bottom Right ", Belt::br}};
    for (const auto& [label, belt] : kLabels) {
      const auto value = number_after(line, label);
      if (value && kBeltLengthMm.holds(*value)) loose_[belt].push_back(*value);
    }
  }

  /// Single readings that were discarded are printed before the measurement of their waypoint.
  void note_thrown_away(int waypoint) {
    if (loose_ == model::PerBelt<std::vector<double>>{}) return;
    run().thrown_away_mm[waypoint] = std::move(loose_);
    loose_ = {};
  }

  void finish() {
    if (open_reading_) {
      problems_.add(
          place(),
          fmt::format("{{{}", unquoted(reading_)),
          "the whole log: it ends in the middle of a reading; paste it once more from its "
          "beginning to its end");
    } else if (list_line_ != 0) {
      problems_.add(
          fmt::format("line {}", list_line_),
          fmt::format("a list of {} readings without an end", list_.size()),
          "the whole log: the list CLBM:[...] ends with \"]\"; paste it once more from its "
          "beginning to its end");
    }
    std::erase_if(runs_, [](const ScannedRun& run) { return run.points.empty(); });
  }

  [[nodiscard]] std::string place() const {
    return line_and_column(reading_line_, reading_column_);
  }

  const std::string& text_;
  Problems& problems_;
  std::vector<ScannedRun> runs_;
  std::size_t line_ = 0;
  std::size_t list_line_ = 0;  ///< where an open list began; 0: none is open
  std::vector<ScannedPoint> list_;
  bool open_reading_ = false;
  std::string reading_;
  std::size_t reading_line_ = 0;
  std::size_t reading_column_ = 0;
  model::PerBelt<std::vector<double>> loose_;
};

}  // namespace

std::vector<ScannedRun> scan_maslow4(const std::string& text, Problems& problems) {
  return Scanner(text, problems).scan();
}

}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/live/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "grid/diagnosis/diagnose.hpp"
#include "tools/cli/belts_frame_chart.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::live {
namespace {

namespace files = grid::files;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::MeasurementKind;

/// Twice as many take four times as long (docs/maslow4.md).
constexpr std::size_t kMostWeighed = 500;

std::vector<model::PerBelt<double>> lengths_of(const grid::MeasuredBelts& belts) {
  std::vector<model::PerBelt<double>> lengths;
  for (const grid::BeltPoint& point : belts.points) lengths.push_back(point.lengths_mm);
  return lengths;
}

std::string counted(std::size_t places) {
  return places == 1 ? std::string("1 place") : fmt::format("{} places", places);
}

double worst_sigma_mm(const Diagnosis& found) {
  double worst = 0.0;
  for (const auto& c : found.belts->coordinates) worst = std::max(worst, c.sigma_mm);
  return worst;
}

/// "tl x -27.1 +- 0.8, ... mm"
std::string anchors_in_words(const Diagnosis& found) {
  std::string text;
  for (const auto& c : found.belts->coordinates) {
    text += fmt::format("{}{} {:.1f} +- {:.1f}",
                        text.empty() ? "" : ", ",
                        cli::coordinate_title(c.name),
                        c.fitted_mm,
                        c.sigma_mm);
  }
  return text + " mm";
}

/// Where the first further place lies; empty where none tells more.
std::optional<std::size_t> first_place(const Diagnosis& found) {
  const auto& list = found.next_measurements;
  const auto is_place = [](const auto& next) {
    return next.mark && next.kind != MeasurementKind::distance;
  };
  const auto first = std::find_if(list.begin(), list.end(), is_place);
  if (first == list.end()) return std::nullopt;
  return static_cast<std::size_t>(first - list.begin());
}

std::vector<std::string> next_in_words(const Diagnosis& found) {
  const std::vector<std::string> sentences = cli::follow_ups_in_words(found);
  std::vector<std::string> lines;
  if (const auto first = first_place(found)) {
    lines.push_back(
        fmt::format("Most would tell: {}{}", sentences[*first], cli::chance_then(found, *first)));
  } else {
    lines.emplace_back("No further place is expected to tell more.");
  }
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    if (found.next_measurements[i].kind == MeasurementKind::distance)
      lines.push_back(fmt::format("A tape would tell: {}", sentences[i]));
  }
  return lines;
}

}  // namespace

Session::Session(std::string file, files::Maslow4Options options)
    : file_(std::move(file)), options_(std::move(options)) {}

std::vector<std::string> Session::news() {
  std::vector<std::string> lines;
  for (const std::string& message : text_.take_messages())
    lines.push_back("The machine: " + message);
  if (text_.telling() == seen_) return lines;
  seen_ = text_.telling();
  read(text_.lines(), lines);
  return lines;
}

void Session::read(const std::string& log, std::vector<std::string>& lines) {
  // Before the first reading there is nothing to be right or wrong.
  if (log.find('{') == std::string::npos) return;
  try {
    const files::Maslow4Import read = files::parse_maslow4(log, file_, options_);
    said_wrong_.clear();
    stopped_ = read.stopped;
    for (const files::Warning& warning : read.warnings) {
      const std::string message = warning.message();
      // What is said of the whole changes with each place. The numbers of lines are those of the file
      // as long as none was forgotten.
      const bool is_known =
          std::find(warnings_.begin(), warnings_.end(), message) != warnings_.end();
      if (is_known || !text_.is_whole() || !warning.place.starts_with("line ")) continue;
      warnings_.push_back(message);
      lines.push_back(message);
    }
    auto lengths = lengths_of(read.belts);
    if (lengths == places_) return;
    places_ = std::move(lengths);
    answer(read.belts, lines);
  } catch (const files::InputError& error) {
    stopped_.reset();
    const std::string message = error.problems().front().message();
    if (message != said_wrong_) lines.push_back(message);
    said_wrong_ = message;
  }
}

void Session::answer(const grid::MeasuredBelts& belts, std::vector<std::string>& lines) {
  tells_most_.reset();
  const std::string count = counted(belts.points.size());
  if (belts.points.size() < grid::kFewestBeltPoints) {
    lines.push_back(fmt::format("{}: anchors take {} of them.", count, grid::kFewestBeltPoints));
    return;
  }
  if (belts.points.size() > kMostWeighed) {
    lines.push_back(
        fmt::format("{}: more than are weighed while the machine runs ({}); chaintrue fit takes "
                    "them all from {}.",
                    count,
                    kMostWeighed,
                    file_));
    return;
  }
  const auto found = grid::diagnosis::diagnose(belts);
  if (!found) {
    lines.push_back(fmt::format("{}: {}", count, found.error().sentence()));
    return;
  }
  const double worst = worst_sigma_mm(*found);
  const std::string before =
      worst_sigma_mm_ ? fmt::format(" ({:.1f} mm before)", *worst_sigma_mm_) : "";
  worst_sigma_mm_ = worst;
  lines.push_back(fmt::format("{}. Anchors: {}; known to {:.1f} mm at worst{}.",
                              count,
                              anchors_in_words(*found),
                              worst,
                              before));
  lines.push_back(found->sentence);
  for (std::string& line : next_in_words(*found)) lines.push_back(std::move(line));
  if (const auto first = first_place(*found)) {
    const model::MarkPoint& mark = *found->next_measurements[*first].mark;
    tells_most_ = model::BedPoint{mark.x_mm, mark.y_mm};
  }
}

std::vector<std::string> Session::last_words() {
  std::vector<std::string> lines;
  if (!text_.open_line().empty()) read(text_.lines() + text_.open_line(), lines);
  if (!text_.is_whole()) {
    lines.push_back(fmt::format(
        "More came than is kept in memory: the answers are of the last part, {} has all of it.",
        file_));
  }
  if (!said_wrong_.empty()) lines.push_back(said_wrong_);
  if (stopped_) lines.push_back(*stopped_);
  if (places_.empty() && said_wrong_.empty()) {
    lines.emplace_back(
        "No place was read: the machine prints its readings while it finds its anchors. Start that "
        "in "
        "its own page while this listens.");
  }
  return lines;
}

}  // namespace chaintrue::live

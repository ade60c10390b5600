// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Cases that are not compensated: points off the map, corrections that are too large or too steep,
/// commands that the controller would clamp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/gcode/compensator.hpp"

#include "grid/files/parse_double.hpp"

namespace chaintrue::gcode {
namespace {

/// Between nearer points rounding dominates the slope.
constexpr double kSlopeBaseMm = 1.0;

}  // namespace

void Findings::add(Problem problem) {
  const std::size_t line = problem.place.line;
  if (line != 0 && std::exchange(last_line_, line) == line) return;
  ++problem_count;
  if (problems.size() < kMostKept) problems.push_back(std::move(problem));
}

void Findings::add(Note note) {
  if (note.problem) return add(Problem{*note.problem, {note.line, 0}, std::move(note.sentence)});
  ++note_count;
  if (notes.size() < kMostKept) notes.push_back(std::move(note));
}

void Compensator::object(const Move& move, const CorrectionFailure& failure, Point place) {
  findings_.add(
      Problem{failure.reason == CorrectionReason::controller ? ProblemName::outside_controller
                                                             : ProblemName::outside_map,
              {move.line, 0},
              fmt::format("X{:.3f} Y{:.3f} {}", place.x_mm, place.y_mm, failure.sentence())});
}

/// Checks a sample against the limits.
void Compensator::examine(const Move& move, const PathSample& sample) {
  const double dx = sample.command.x_mm - sample.target.x_mm;
  const double dy = sample.command.y_mm - sample.target.y_mm;
  const double size = std::hypot(dx, dy);
  if (size > summary_.largest_correction_mm) {
    summary_.largest_correction_mm = size;
    summary_.largest_correction_line = move.line;
  }
  const auto object_to = [&](ProblemName name, std::string sentence) {
    findings_.add(Problem{name, {move.line, 0}, std::move(sentence)});
  };
  if (size > options_.largest_correction_mm) {
    object_to(
        ProblemName::correction_too_large,
        fmt::format(
            "X{:.3f} Y{:.3f} would be corrected by {:.2f} mm, more than the {} mm that are allowed",
            sample.target.x_mm,
            sample.target.y_mm,
            size,
            options_.largest_correction_mm));
  }
  if (const auto& box = options_.clamp_box) {
    const double beyond = std::max(std::fabs(sample.command.x_mm) - box->half_width_mm,
                                   std::fabs(sample.command.y_mm) - box->half_height_mm);
    if (beyond > 0.0) {
      object_to(
          ProblemName::outside_controller,
          fmt::format(
              "X{:.3f} Y{:.3f} needs the command X{:.3f} Y{:.3f}, {:.2f} mm beyond the bed, where "
              "the controller silently cuts it off; enlarge the bed in its settings by {:.0f} mm",
              sample.target.x_mm,
              sample.target.y_mm,
              sample.command.x_mm,
              sample.command.y_mm,
              beyond,
              std::ceil(2.0 * beyond)));
    }
  }
  if (here_) {
    const double way = std::hypot(sample.target.x_mm - here_->target.x_mm,
                                  sample.target.y_mm - here_->target.y_mm);
    if (way >= kSlopeBaseMm && !has_play()) {
      const double slope = std::hypot(dx - (here_->command.x_mm - here_->target.x_mm),
                                      dy - (here_->command.y_mm - here_->target.y_mm)) /
                           way;
      summary_.steepest_correction = std::max(summary_.steepest_correction, slope);
      if (slope > options_.steepest_correction) {
        object_to(ProblemName::correction_too_steep,
                  fmt::format("before X{:.3f} Y{:.3f} the correction changes by {:.3f} mm per "
                              "mm, more than the {} that are allowed",
                              sample.target.x_mm,
                              sample.target.y_mm,
                              slope,
                              options_.steepest_correction));
      }
    }
  }
  if (corrector_.map().status({sample.target.x_mm, sample.target.y_mm}) >=
      grid::MapStatus::extrapolated) {
    findings_.add(Note{move.line,
                       "extrapolated",
                       fmt::format("X{:.3f} Y{:.3f} lies outside the measured points: the "
                                   "correction there is extrapolated",
                                   sample.target.x_mm,
                                   sample.target.y_mm)});
  }
}

/// The word is written all the same: it does not affect the path.
void Compensator::note_unknown(const PassedWord& word) {
  const char letter = word.text.front();
  if (letter != 'G' && letter != 'M') return;
  const std::string code = word.text.substr(0, word.text.find(' '));
  const Firmware& firmware = corrector_.firmware();
  double number = 0.0;
  grid::files::parse_double(code.data() + 1, code.data() + code.size(), number);
  const int tenths = static_cast<int>(std::lround(10.0 * number));
  if (knows_code(firmware, letter, tenths) || !unknown_words_.insert(code).second) return;
  findings_.add(Note{
      word.line, "code_not_known", fmt::format("{} {} {}", firmware.name, firmware.unknown, code)});
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The cases that are not compensated, and those that are not written.
#include "tools/gcode/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "tools/gcode/block.hpp"

namespace chaintrue::gcode {
namespace {

/// Between nearer points rounding dominates the slope.
constexpr double kSlopeBaseMm = 1.0;

/// As many per line as fit, each line separately.
std::vector<std::string> settings_lines(const std::vector<std::string>& settings) {
  constexpr std::string_view kHead = "(settings";
  std::vector<std::string> lines;
  for (const std::string& setting : settings) {
    if (lines.empty() || lines.back().size() + setting.size() + 2 > kMaxOutputLine)
      lines.emplace_back(kHead);
    lines.back() += " " + setting;
  }
  for (std::string& line : lines) line += ")";
  return lines;
}

}  // namespace

Limits::Limits(const Corrector& corrector, const CompensateOptions& options, ByteSink out)
    : corrector_(corrector),
      options_(options),
      emitter_(std::move(out), options.decimals, corrector.firmware().semicolon_comments) {}

void Limits::header(double home_x_mm, double home_y_mm) {
  std::vector<std::string> lines;
  if (options_.made_by) lines = comments_of(*options_.made_by);
  lines.push_back(fmt::format("(controller {}, tolerance {} mm)", corrector_.firmware().name,
                              options_.tolerance_mm));
  lines.push_back(fmt::format("(home was X{} Y{})", home_x_mm, home_y_mm));
  grid::append_all(lines, settings_lines(options_.settings));
  emitter_.header(lines);
}

CompensateSummary Limits::summary() const {
  CompensateSummary summary = summary_;
  summary.commands = emitter_.commands();
  return summary;
}

void Limits::command(const Move& move, double feed_mm_per_min, const PathSample& sample) {
  examine(move, sample);
  if (here_ && options_.on_command) options_.on_command(move, *here_, sample);
  here_ = sample;
  if (!hold()) return;
  emitter_.command(move, sample.command, feed_mm_per_min);
}

void Limits::height(const Move& move, double feed_mm_per_min) {
  if (!hold()) return;
  if (here_) here_->target.z_mm = here_->command.z_mm = move.to.z_mm;
  if (length_mm(move) == 0.0 && move.feed.mode == FeedMode::inverse_time) return;
  emitter_.command(move, move.to, feed_mm_per_min, false);
  if (here_ && options_.on_command) options_.on_command(move, *here_, *here_);
}

void Limits::word(const PassedWord& word) {
  const Firmware& firmware = corrector_.firmware();
  const bool is_length = word.code == g::tool_length || word.code == g::tool_length_stated;
  if (is_length && !firmware.tool_lengths) {
    refuse(not_emittable, {word.line},
           "{}: {} stores no tool lengths, so every height after it could be wrong; "
           "remove G43 and set Z to zero with each tool",
           word.text, firmware.name);
  }
  if (word.moves_itself && !knows_code(firmware, *word.code)) {
    refuse(not_emittable, {word.line},
           "{}: {} does not support {} and would read the height as one above the "
           "work; write a safe height above the work (G0 Z...)",
           word.text, firmware.name, name(*word.code));
  }
  if (word.leaves_xy) here_.reset();
  note_unknown(word);
  if (hold()) emitter_.word(word);
}

void Limits::comment(const Comment& comment) {
  refuse_compensated(comment);
  if (hold()) emitter_.comment(comment);
}

void Limits::object(const Move& move, const CorrectionFailure& failure, Point place) {
  findings_.add(
      Problem{failure.reason == CorrectionReason::controller ? outside_controller : outside_map,
              {move.line},
              fmt::format("{} {}", in_xy(place), failure.sentence())});
}

/// Checks a sample against the limits.
void Limits::examine(const Move& move, const PathSample& sample) {
  const Point correction = sample.command - sample.target;
  const double size = level_mm(correction);
  if (size > summary_.largest_correction_mm) {
    summary_.largest_correction_mm = size;
    summary_.largest_correction_line = move.line;
  }
  const auto object_to = [&](ProblemName name, std::string sentence) {
    findings_.add(Problem{name, {move.line}, std::move(sentence)});
  };
  if (size > options_.largest_correction_mm) {
    object_to(correction_too_large,
              fmt::format("{} would be corrected by {:.2f} mm, more than the {} mm allowed",
                          in_xy(sample.target), size, options_.largest_correction_mm));
  }
  if (const auto& box = options_.clamp_box) {
    const double beyond = std::max(std::fabs(sample.command.x_mm) - box->half_width_mm,
                                   std::fabs(sample.command.y_mm) - box->half_height_mm);
    if (beyond > 0.0) {
      object_to(
          outside_controller,
          fmt::format(
              "{} needs the command {}, {:.2f} mm beyond the bed, where "
              "the controller silently cuts it off; enlarge the bed in its settings by {:.0f} mm",
              in_xy(sample.target), in_xy(sample.command), beyond, std::ceil(2.0 * beyond)));
    }
  }
  if (here_) {
    const double way = level_mm(sample.target - here_->target);
    if (way >= kSlopeBaseMm && !options_.has_play()) {
      const double slope = level_mm(correction - (here_->command - here_->target)) / way;
      summary_.steepest_correction = std::max(summary_.steepest_correction, slope);
      if (slope > options_.steepest_correction) {
        object_to(correction_too_steep,
                  fmt::format("before {} the correction changes by {:.3f} mm per mm, more than the "
                              "{} allowed",
                              in_xy(sample.target), slope, options_.steepest_correction));
      }
    }
  }
  if (corrector_.map().status(sample.target) >= grid::MapStatus::extrapolated) {
    findings_.add(Note{move.line, "extrapolated",
                       fmt::format("{} is outside the measured points; the correction there is "
                                   "extrapolated",
                                   in_xy(sample.target))});
  }
}

/// The word is written anyway, because it does not affect the path.
void Limits::note_unknown(const PassedWord& word) {
  const Firmware& firmware = corrector_.firmware();
  if (!word.code || knows_code(firmware, *word.code) || !unknown_.insert(*word.code).second) return;
  findings_.add(Note{word.line, "code_not_known",
                     fmt::format("{} {} {}", firmware.name, firmware.unknown, name(*word.code))});
}

}  // namespace chaintrue::gcode

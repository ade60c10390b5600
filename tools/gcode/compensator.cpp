// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Converts moves to commands.
#include "tools/gcode/compensator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace chaintrue::gcode {
namespace {

/// Share of the tolerance for the error of the tables; included in the segmenter's kSpare.
constexpr double kTableShare = 0.005;
/// The correction of a smooth map is interpolated to 1e-6 mm in cells of 16 mm; cells of 4 mm
/// resolve a wave with the period of a sprocket's turn (63.5 mm).
constexpr double kCellMm = 16.0;
constexpr int kHalvings = 2;
/// A program of fewer places needs no tables to be quick.
constexpr int kExactFirst = 2000;
/// A circle keeps its shape even if the tolerance would allow a point.
constexpr double kMostTurnRad = 0.25 * std::numbers::pi;

int sign(double value, int otherwise) { return value > 0.0 ? 1 : value < 0.0 ? -1 : otherwise; }

}  // namespace

Compensator::Compensator(const Corrector& corrector, CompensateOptions options, ByteSink out)
    : corrector_(corrector),
      options_(std::move(options)),
      limits_(corrector, options_, std::move(out)),
      segmenter_(corrector, options_.tolerance_mm, options_.decimals),
      table_(offsets_of_command(corrector),
             {kCellMm, kTableShare * options_.tolerance_mm, kHalvings, kExactFirst}) {}

Result<CompensateSummary> Compensator::run(LineSource& source, const Dialect& dialect) {
  limits_.header(dialect.home_mm[0], dialect.home_mm[1]);
  return run_program(source, dialect, *this).map([&](const ProgramSummary& program) {
    CompensateSummary summary = limits_.summary();
    summary.blocks = program.blocks;
    summary.moves = moves_;
    summary.path_mm = path_mm_;
    return summary;
  });
}

Corrected<model::BedPoint> Compensator::command(model::BedPoint target) {
  // Beyond the measured points a map may refuse, place by place.
  if (corrector_.map().status(target) < grid::MapStatus::extrapolated) {
    if (const auto offset = table_.value(target.x_mm, target.y_mm)) {
      return model::BedPoint{target.x_mm + (*offset)[0], target.y_mm + (*offset)[1]};
    }
  }
  return corrector_.command(target);
}

Curve Compensator::curve(const Move& move, ChainDirections directions) {
  return [this, &move, directions](double t) -> Corrected<PathSample> {
    const Point target = at(move, t);
    const auto command = options_.has_play()
                             ? corrector_.command(target, options_.half_play_mm, directions)
                             : this->command(target);
    if (!command) return tl::unexpected(command.error());
    return PathSample{t, target, {command->x_mm, command->y_mm, target.z_mm}};
  };
}

/// The directions of motion of the chains after t; a chain that does not move keeps its direction.
ChainDirections Compensator::directions_at(const Move& move, double t,
                                           ChainDirections otherwise) const {
  const double step = std::min(1.0, 0.01 / std::max(length_mm(move), 0.01));
  const double from = std::clamp(t, 0.0, 1.0 - step);
  const auto before = corrector_.map().lengths(at(move, from));
  const auto behind = corrector_.map().lengths(at(move, from + step));
  if (!before || !behind) return otherwise;
  return {sign(behind->left_mm - before->left_mm, otherwise.left),
          sign(behind->right_mm - before->right_mm, otherwise.right)};
}

void Compensator::piece(const Move& move, double feed, double from, double to,
                        ChainDirections directions) {
  const Curve commands = curve(move, directions);
  const auto visit = [&](const PathSample& sample) { limits_.command(move, feed, sample); };
  // Without play the last command is the start of this one.
  const std::optional<PathSample>& here = limits_.here();
  const bool known = here && !options_.has_play() && from == 0.0 && here->target == move.from;
  const auto start = known ? PathSample{0.0, here->target, here->command} : commands(from);
  if (!start) return limits_.object(move, start.error(), at(move, from));
  // While the play is taken up, the chains move and the tool stays.
  if (options_.has_play() && here && directions != directions_) visit(*start);
  directions_ = directions;
  const double length = (to - from) * length_mm(move);
  const bool whole = move.kind == MoveKind::rapid && options_.keep_rapids_whole;
  if (whole || (!move.arc && length <= segmenter_.unchecked_mm())) {
    const auto end = commands(to);
    if (!end) return limits_.object(move, end.error(), at(move, to));
    return visit(*end);
  }
  const double turn = move.arc ? std::fabs(move.arc->sweep_rad) * (to - from) : 0.0;
  const double longest = turn > kMostTurnRad ? length * kMostTurnRad / turn : length;
  const auto done = segmenter_.run(commands, *start, to, {length, longest, feed}, visit);
  if (!done) {
    limits_.object(move, done.error(), here ? here->target : at(move, from));
  }
}

/// In pieces between the points where a chain reverses, if there is play.
void Compensator::along(const Move& move, double feed) {
  const bool from_home = std::exchange(homed_, false) && !move.arc;
  if (from_home && move.kind != MoveKind::rapid) {
    note({move.line, "way_from_home",
          "the move from home to the first place is not changed; only its end is compensated"});
  }
  if (!limits_.here() && (move.kind == MoveKind::rapid || from_home)) {
    // The tool's position before the first move is unknown, and so are the directions of its
    // chains: only the end of that move is compensated, as if both chains had been paid out.
    const auto end = curve(move, directions_)(1.0);
    if (!end) return limits_.object(move, end.error(), move.to);
    return limits_.command(move, feed, *end);
  }
  if (!options_.has_play()) return piece(move, feed, 0.0, 1.0, {});
  constexpr double kLookMm = 20.0;
  const int looks =
      static_cast<int>(std::clamp(length_mm(move) / kLookMm, move.arc ? 16.0 : 4.0, 1e4));
  double from = 0.0;
  ChainDirections now = directions_at(move, 0.0, directions_);
  for (int i = 1; i <= looks; ++i) {
    double high = static_cast<double>(i) / looks;
    while (directions_at(move, high, now) != now) {
      double low = from;
      double end = high;
      while (end - low > 1e-9) {
        const double middle = 0.5 * (low + end);
        (directions_at(move, middle, now) == now ? low : end) = middle;
      }
      piece(move, feed, from, end, now);
      now = directions_at(move, end, now);
      from = end;
      if (end >= high) break;
    }
  }
  if (from < 1.0) piece(move, feed, from, 1.0, now);
}

/// A program that cuts before it states X and Y starts at the controller's position, which is zero.
/// The tool's position differs from the program's start by the correction.
void Compensator::go_to_assumed_start(const Move& move) {
  note(
      {move.line, "start_assumed",
       fmt::format("the program cuts before it moves in X and Y; it is assumed to start at X{:.6g} "
                   "Y{:.6g}",
                   move.from.x_mm, move.from.y_mm)});
  Move start = move;
  start.kind = MoveKind::rapid;
  start.arc.reset();
  start.to = start.from;
  start.names_z = false;
  along(start, 0.0);
}

void Compensator::move(const Move& move) {
  ++moves_;
  if (move.kind == MoveKind::probe) {
    refuse(not_emittable, {move.line},
           "probing needs a code with a decimal point, which some controllers misread; probe "
           "before the job, not within it");
  }
  for (const double turn : move.turn_deg) {
    if (turn != 0.0) {
      refuse(unsupported_axis, {move.line}, "a two-chain router has no axis A, B or C");
    }
  }
  path_mm_ += length_mm(move);
  const double feed = feed_mm_per_min(move);
  const bool cuts =
      move.kind != MoveKind::rapid && (move.names_xy || move.to.z_mm < move.from.z_mm);
  if (!limits_.here() && cuts && !homed_ && limits_.hold()) go_to_assumed_start(move);
  if (move.names_xy && !(stays(move) && limits_.here())) {
    along(move, feed);
  } else if (move.names_z) {
    limits_.height(move, feed);
  }
}

void Compensator::word(const PassedWord& word) {
  homed_ = homed_ || word.leaves_xy;
  limits_.word(word);
}

}  // namespace chaintrue::gcode

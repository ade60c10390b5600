// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two programs side by side: one says where the tool shall be, the other where it is.
#include "tools/gcode/verifier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

/// Places between two commands that are compared: this far apart, at most so many.
constexpr double kEvery_mm = 6.0;
constexpr int kMostPlaces = 64;

Move shifted(Move move, model::BedPoint home) {
  for (Point* point : {&move.from, &move.to}) {
    point->x_mm += home.x_mm;
    point->y_mm += home.y_mm;
  }
  if (move.arc) {
    move.arc->centre.x_mm += home.x_mm;
    move.arc->centre.y_mm += home.y_mm;
  }
  return move;
}

/// A program's events, pulled instead of pushed.
class Stream final : private Sink {
 public:
  Stream(LineSource& source, const Dialect& dialect, model::BedPoint home)
      : program_(source, dialect, *this), home_(home) {}

  /// The move behind `ahead` others, or null at the end.
  Result<const Move*> peek(std::size_t ahead) {
    while (moves_.size() <= ahead && !ended_) {
      const auto more = program_.step();
      if (!more) return tl::unexpected(more.error());
      ended_ = !*more;
    }
    return ahead < moves_.size() ? &moves_[ahead] : nullptr;
  }
  void pop() { moves_.pop_front(); }

  /// Passed words since the last call, in order.
  std::deque<std::string>& words() { return words_; }

 private:
  Result<void> move(const Move& move) override {
    moves_.push_back(shifted(move, home_));
    return {};
  }
  Result<void> word(const PassedWord& word) override {
    words_.push_back(word.text == "G61.1" ? "G61" : word.text);
    return {};
  }

  Program program_;
  model::BedPoint home_;
  std::deque<Move> moves_;
  std::deque<std::string> words_;
  bool ended_ = false;
};

/// The parameter in [from, to] of the point of a move that is nearest to p.
double nearest(const Move& move, Point p, double from, double to) {
  if (!move.arc) {
    return std::clamp(nearest_on_line(move.from, move.to, p), from, to);
  }
  // Coarse, then golden section: distance to an arc has one minimum between neighbouring samples
  // this dense.
  const int samples =
      std::max(16, static_cast<int>(std::ceil(std::fabs(move.arc->sweep_rad) / 0.2)));
  double best = from;
  double least = distance_mm(at(move, from), p);
  for (int i = 1; i <= samples; ++i) {
    const double t = from + (to - from) * i / samples;
    const double distance = distance_mm(at(move, t), p);
    if (distance < least) {
      least = distance;
      best = t;
    }
  }
  double low = std::max(from, best - (to - from) / samples);
  double high = std::min(to, best + (to - from) / samples);
  const double golden = 1.0 / std::numbers::phi;
  while (high - low > 1e-10) {
    const double a = high - golden * (high - low);
    const double b = low + golden * (high - low);
    if (distance_mm(at(move, a), p) < distance_mm(at(move, b), p)) {
      high = b;
    } else {
      low = a;
    }
  }
  const double refined = 0.5 * (low + high);
  return distance_mm(at(move, refined), p) < least ? refined : best;
}

class Verification {
 public:
  Verification(LineSource& original,
               LineSource& run,
               const Corrector& corrector,
               const Dialect& dialect,
               const VerifyOptions& options)
      : intended_(original, dialect, options.home),
        run_(run, dialect, options.run_home),
        corrector_(corrector),
        options_(options) {}

  tl::expected<VerifySummary, VerifyProblem> result() {
    for (;;) {
      const auto command = run_.peek(0);
      if (!command) return tl::unexpected(VerifyProblem{false, command.error()});
      compare_words();
      if (*command == nullptr) break;
      ++summary_.commands;
      if (auto done = execute(**command); !done) return tl::unexpected(done.error());
      run_.pop();
    }
    if (auto done = finish(); !done) return tl::unexpected(done.error());
    return summary_;
  }

 private:
  using Outcome = tl::expected<void, VerifyProblem>;

  tl::unexpected<VerifyProblem> fail(bool in_original, Problem problem) {
    return tl::unexpected(VerifyProblem{in_original, std::move(problem)});
  }

  double as_read(double value_mm) const {
    return corrector_.firmware().single_precision
               ? static_cast<double>(static_cast<float>(value_mm))
               : value_mm;
  }
  Point as_read(Point point) const {
    return {as_read(point.x_mm), as_read(point.y_mm), as_read(point.z_mm)};
  }

  /// Where the tool is when the controller believes to be at `command`.
  tl::expected<Point, VerifyProblem> tool(Point command, std::size_t line) {
    const model::BedPoint place{command.x_mm, command.y_mm};
    tl::expected<model::BedPoint, CorrectionFailure> found =
        tl::unexpected(CorrectionFailure::controller);
    const bool play = options_.half_play_mm.left_mm != 0.0 || options_.half_play_mm.right_mm != 0.0;
    if (!play) {
      found = corrector_.tool(place);
    } else if (const auto paid = corrector_.paid_out(place)) {
      // Play: a chain follows only when the motor has crossed the gap.
      const auto follow = [](std::optional<double>& chain, double motor, double half) {
        chain = chain ? std::clamp(*chain, motor - half, motor + half) : motor - half;
        return *chain;
      };
      const auto point =
          corrector_.map().tool({follow(left_, paid->left_mm, options_.half_play_mm.left_mm),
                                 follow(right_, paid->right_mm, options_.half_play_mm.right_mm)});
      if (point) found = *point;
    }
    if (!found) {
      return fail(false,
                  Problem{ProblemName::outside_map,
                          {line, 0},
                          fmt::format("X{:.3f} Y{:.3f}: the tool's place {}",
                                      command.x_mm,
                                      command.y_mm,
                                      explain(found.error()))});
    }
    return Point{found->x_mm, found->y_mm, command.z_mm};
  }

  Outcome execute(const Move& command) {
    if (!started_) {
      if (!begins(command)) return {};
      return start(command);
    }
    const Point from = as_read(command.from);
    const Point to = as_read(command.to);
    const double length = length_mm(command);
    int places = static_cast<int>(
        std::clamp(std::ceil(length / kEvery_mm), 2.0, static_cast<double>(kMostPlaces)));
    if (command.arc) places = std::max(places, 48);
    const bool rapid = command.kind == MoveKind::rapid;
    const double step_mm = tick_way_mm(command);
    if (step_mm > 0.0) {
      const double steps = length / step_mm;
      summary_.tick_overshoot_mm =
          std::max(summary_.tick_overshoot_mm, (std::ceil(steps) - steps) * step_mm);
    }
    for (int i = 1; i <= places; ++i) {
      double t = static_cast<double>(i) / places;
      // The controller stands only at its ticks, and at the end.
      if (step_mm > 0.0 && i < places)
        t = std::min(1.0, std::round(t * length / step_mm) * step_mm / length);
      if (options_.rapids_whole && rapid && i < places) continue;
      const Point place = command.arc ? at(command, t) : between(from, to, t);
      const auto on_way = command.arc ? std::optional(model::BedPoint{place.x_mm, place.y_mm})
                                      : on_the_way(corrector_.firmware(),
                                                   corrector_.kinematics(),
                                                   {from.x_mm, from.y_mm},
                                                   {to.x_mm, to.y_mm},
                                                   t);
      if (!on_way) {
        return fail(false,
                    Problem{ProblemName::outside_controller,
                            {command.line, 0},
                            "the controller's own kinematics fail here"});
      }
      const auto where =
          tool({as_read(on_way->x_mm), as_read(on_way->y_mm), place.z_mm}, command.line);
      if (!where) return tl::unexpected(where.error());
      if (auto done = match(*where, command.line, options_.rapids_whole && rapid); !done)
        return done;
    }
    return {};
  }

  double tick_way_mm(const Move& command) const {
    if (corrector_.firmware().tick_s == 0.0 || command.kind == MoveKind::rapid) return 0.0;
    const double length = length_mm(command);
    const double feed = command.feed.mode == FeedMode::inverse_time ? length * command.feed.value
                                                                    : command.feed.value;
    return feed / 60.0 * corrector_.firmware().tick_s;
  }

  /// Where a program begins: with a place in X and Y, or with a cut where it stands.
  static bool begins(const Move& move) {
    return move.names_xy || (move.kind != MoveKind::rapid && move.to.z_mm < move.from.z_mm);
  }

  /// Both paths begin at the end of a rapid or at the start of a cut.
  Outcome start(const Move& command) {
    for (;;) {
      const auto move = intended_.peek(0);
      if (!move) return fail(true, move.error());
      if (*move == nullptr) {
        return fail(
            true,
            Problem{
                ProblemName::bad_flow, {}, "the original has no path, but the other file does"});
      }
      if (begins(**move)) {
        t_ = (*move)->kind == MoveKind::rapid ? 1.0 : 0.0;
        break;
      }
      intended_.pop();
    }
    started_ = true;
    const bool rapid = command.kind == MoveKind::rapid;
    const auto where = tool(as_read(rapid ? command.to : command.from), command.line);
    if (!where) return tl::unexpected(where.error());
    last_ = *where;
    if (auto done = match(*where, command.line, false); !done || rapid) return done;
    return execute(command);
  }

  void record(const Move& move, Point intended, Point tool, std::size_t line) {
    const double distance = distance_mm(intended, tool);
    Deviation& worst = move.kind == MoveKind::rapid ? summary_.rapids : summary_.feeds;
    if (distance > worst.largest_mm) worst = {distance, intended, tool, move.line, line};
  }

  /// Goes on along the intended path to the place nearest to the tool, not much further than the
  /// tool went.
  Outcome match(Point tool, std::size_t line, bool only_end) {
    ++summary_.places;
    const double way = distance_mm(last_, tool);
    const double window = 1.2 * way + 4.0 * options_.tolerance_mm;
    std::size_t best_move = 0;
    double best_t = t_;
    double least = -1.0;
    double seen = 0.0;
    for (std::size_t ahead = 0; seen <= window || ahead == 0; ++ahead) {
      const auto move = intended_.peek(ahead);
      if (!move) return fail(true, move.error());
      if (*move == nullptr) break;
      const double from = ahead == 0 ? t_ : 0.0;
      const double length = length_mm(**move);
      // No further than the window reaches within this move.
      const double reach = length > 0.0 ? std::min(1.0, from + (window - seen) / length) : 1.0;
      const double t = nearest(**move, tool, from, reach);
      const double distance = distance_mm(at(**move, t), tool);
      if (least < 0.0 || distance < least) {
        least = distance;
        best_move = ahead;
        best_t = t;
      }
      seen += (1.0 - from) * length;
    }
    if (least < 0.0) {  // the original has ended
      summary_.feeds.largest_mm = std::max(summary_.feeds.largest_mm, way);
      last_ = tool;
      return {};
    }
    // What was passed on the way must lie on the tool's way.
    for (; best_move > 0; --best_move) {
      const Move& passed = **intended_.peek(0);
      if (!only_end)
        record(
            passed, passed.to, between(last_, tool, nearest_on_line(last_, tool, passed.to)), line);
      intended_.pop();
    }
    const Move& move = **intended_.peek(0);
    t_ = best_t;
    record(move, at(move, t_), tool, line);
    last_ = tool;
    return {};
  }

  /// What is left of the intended path was not run.
  Outcome finish() {
    double t = t_;
    for (;;) {
      const auto move = intended_.peek(0);
      if (!move) return fail(true, move.error());
      if (*move == nullptr) break;
      // Moves before the first place in X and Y have nothing to be compared with.
      if (started_) {
        record(**move, at(**move, std::max(t, 0.5)), last_, (*move)->line);
        record(**move, (*move)->to, last_, (*move)->line);
      }
      t = 0.0;
      intended_.pop();
    }
    compare_words();
    if (summary_.words_differ.empty() && !(intended_.words().empty() && run_.words().empty())) {
      const bool missing = run_.words().empty();
      summary_.words_differ =
          fmt::format("{} {}",
                      missing ? "missing:" : "too many:",
                      missing ? intended_.words().front() : run_.words().front());
    }
    return {};
  }

  void compare_words() {
    auto& expected = intended_.words();
    auto& found = run_.words();
    while (!expected.empty() && !found.empty()) {
      if (expected.front() != found.front() && summary_.words_differ.empty()) {
        summary_.words_differ = fmt::format("{} instead of {}", found.front(), expected.front());
      }
      expected.pop_front();
      found.pop_front();
    }
  }

  Stream intended_;
  Stream run_;
  const Corrector& corrector_;
  VerifyOptions options_;
  VerifySummary summary_;
  bool started_ = false;
  double t_ = 0.0;  // on the intended path's current move
  Point last_;
  std::optional<double> left_;
  std::optional<double> right_;
};

}  // namespace

tl::expected<VerifySummary, VerifyProblem> verify(LineSource& original,
                                                  LineSource& run,
                                                  const Corrector& corrector,
                                                  const Dialect& dialect,
                                                  const VerifyOptions& options) {
  return Verification(original, run, corrector, dialect, options).result();
}

}  // namespace chaintrue::gcode

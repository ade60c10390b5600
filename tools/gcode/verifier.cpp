// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Two programs read in parallel: one gives the intended path, the other the actual track. Words
/// divide both into sections; within a section the tool's track is matched with the path.
#include "tools/gcode/verifier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/gcode/path.hpp"
#include "tools/gcode/path_matcher.hpp"
#include "tools/gcode/program.hpp"
#include "tools/gcode/simulated_machine.hpp"

namespace chaintrue::gcode {
namespace {

/// Shares of the tolerance for the simulation's own errors; the rest is for the file.
constexpr double kArcShare = 0.01;       // arcs of the path are replaced by chords
constexpr double kFlatnessShare = 0.01;  // so is the tool's track
constexpr double kFieldShare = 0.005;    // error of interpolating the inverse map
constexpr double kLeft = 1.0 - kArcShare - kFlatnessShare - kFieldShare;
constexpr int kFewestChordsPerTurn = 16;
/// Shorter commands are rounded too coarsely to determine their stretch.
constexpr double kLeastStretchedMm = 2.0;

/// Start of a program: a position in X and Y, or a cut from the current position.
bool begins(const Move& move) {
  return move.names_xy || (move.kind != MoveKind::rapid && move.to.z_mm < move.from.z_mm);
}

/// Until X and Y are known only heights are compared.
Point height_of(Point point) { return {0.0, 0.0, point.z_mm}; }

/// The part of a move that ends at this place.
PathPiece piece_of(const Move& move, Point to) {
  return {to, move.kind == MoveKind::rapid, feed_mm_per_min(move), move.line};
}

std::string words(Point point) {
  return fmt::format("X{:.3f} Y{:.3f} Z{:.3f}", point.x_mm, point.y_mm, point.z_mm);
}

std::string words(const ProgramEvent& event) {
  return event.word.text.empty() ? "the end" : event.word.text;
}

std::string words(const PathPiece& piece) {
  return piece.rapid ? std::string("a rapid") : fmt::format("F{:.6g}", piece.speed_mm_per_min);
}

Dialect with_home_at_zero(Dialect dialect) {
  // A plotter's home is a fixed place in any coordinates.
  if (auto& place = dialect.plotter_home_mm) {
    for (const std::size_t axis : {0U, 1U}) (*place)[axis] += dialect.home_mm[axis];
  }
  dialect.home_mm = {};
  return dialect;
}

SimulatedMachine::Options machine_options(const VerifyOptions& options) {
  return {options.half_play_mm, kFlatnessShare * options.tolerance_mm,
          kFieldShare * options.tolerance_mm, options.rapids_whole};
}

/// Length of moves that may vanish by rounding.
double least_run_mm(const VerifyOptions& options) {
  return std::max(0.2 * options.tolerance_mm, 4.0 * std::pow(10.0, -options.decimals));
}

class Verification {
 public:
  Verification(LineSource& original, LineSource& run, const Corrector& corrector,
               const Dialect& dialect, const VerifyOptions& options)
      : intended_(original, dialect),
        run_(run, with_home_at_zero(dialect)),
        options_(options),
        machine_(corrector, machine_options(options)),
        matcher_({kLeft * options.tolerance_mm, options.speed_share, least_run_mm(options),
                  PathMatcher::Limits{}.most_open},
                 [this](PathPiece& piece) { return next_piece(piece); }) {}

  VerifySummary result() {
    static_cast<void>(matcher_.begin({}));
    while (!stopped_) {
      const ProgramEvent& event = run_.peek();
      if (event.kind == ProgramEvent::Kind::move) {
        ++summary_.commands;
        execute(event.move);
      } else {
        compare(event);
        if (event.kind == ProgramEvent::Kind::end) break;
      }
      run_.pop();
    }
    summary_.feeds = matcher_.largest(false);
    summary_.rapids = matcher_.largest(true);
    summary_.tick_overshoot_mm = machine_.tick_overshoot_mm();
    return summary_;
  }

 private:
  /// The original's next event. \throws VerifyProblem
  const ProgramEvent& expected() {
    try {
      return intended_.peek();
    } catch (const Refusal& refusal) {
      throw VerifyProblem{true, refusal.problem};
    }
  }

  /// The next piece of the intended path within the section; arcs are replaced by chords.
  bool next_piece(PathPiece& piece) {
    for (;;) {
      if (chord_ < chords_) {
        ++chord_;
        piece = piece_of(arc_, at(arc_, static_cast<double>(chord_) / chords_));
        return true;
      }
      const ProgramEvent& event = expected();
      if (event.kind != ProgramEvent::Kind::move) return false;
      const Move& move = event.move;
      if (!started_) {
        if (begins_here(move) && (move.kind != MoveKind::rapid || heights_done_)) return false;
        heights_done_ = begins_here(move);
        piece = piece_of(move, height_of(move.to));
        const bool changes_height = move.from.z_mm != move.to.z_mm;
        if (!heights_done_) intended_.pop();  // which invalidates move
        if (changes_height) return true;
        continue;
      }
      if (move.arc) {
        arc_ = move;
        chord_ = 0;
        chords_ = chords_of(*move.arc);
        intended_.pop();
        continue;
      }
      piece = piece_of(move, move.to);
      const bool stays = move.from == move.to;
      intended_.pop();
      if (!stays) return true;
    }
  }

  /// From home curves start only at a known place.
  bool begins_here(const Move& move) const { return homed_ ? move.names_xy : begins(move); }
  /// Whether both curves start at the end of this move, whose path is not compensated.
  bool starts_at_end(const Move& move) const {
    return move.kind == MoveKind::rapid || (homed_ && !move.arc);
  }

  int chords_of(const Arc& arc) const {
    constexpr double kWidestChordRad = 2.0 * std::numbers::pi / kFewestChordsPerTurn;
    return static_cast<int>(
        std::min(1e8, chords_within(std::max(arc.start_radius_mm, arc.end_radius_mm), arc.sweep_rad,
                                    kArcShare * options_.tolerance_mm,
                                    std::fabs(arc.sweep_rad) / kWidestChordRad)));
  }

  /// Both curves start: at the end of a rapid or of the way from home, or at the start of a cut.
  void start(const Move& command) {
    if (command.kind == MoveKind::rapid && command.from.z_mm != command.to.z_mm) {
      advance(piece_of(command, height_of(command.to)));
    }
    if (stopped_) return;
    const PathMatcher::Outcome before = matcher_.finish();
    const ProgramEvent& event = expected();
    if (before != PathMatcher::Outcome::follows || event.kind != ProgramEvent::Kind::move) {
      stray(before == PathMatcher::Outcome::follows
                ? fmt::format("the run moves on line {} where the original has {}", command.line,
                              event.word.text.empty() ? "its end" : event.word.text)
                : fmt::format("the heights before the first place differ (line {})", command.line));
      stopped_ = true;
      return;
    }
    started_ = true;
    const bool at_end = starts_at_end(command);
    const bool intended_at_end = starts_at_end(event.move);
    const Point intended = intended_at_end ? event.move.to : event.move.from;
    const std::size_t intended_line = event.move.line;
    if (intended_at_end) intended_.pop();
    homed_ = false;
    last_command_ = at_end ? command.to : command.from;
    last_tool_ = machine_.place(last_command_, command.line);
    ++summary_.places;
    if (matcher_.begin({0.0, intended, last_tool_, intended_line, command.line}) !=
        PathMatcher::Outcome::follows) {
      stray(place_fault());
    }
    if (!at_end) execute(command);
  }

  void execute(const Move& command) {
    if (!started_) {
      if (begins_here(command)) return start(command);
      if (command.from.z_mm != command.to.z_mm) advance(piece_of(command, height_of(command.to)));
      return;
    }
    if (command.from == command.to && !command.arc) return;
    const bool rapid = command.kind == MoveKind::rapid;
    const double feed = rapid ? 0.0 : feed_mm_per_min(command);
    last_command_ = command.from;
    machine_.run(command, [&](Point tool, Point commanded) {
      const double way = distance_mm(last_command_, commanded);
      const double stretch = way >= kLeastStretchedMm ? distance_mm(last_tool_, tool) / way : 1.0;
      last_command_ = commanded;
      last_tool_ = tool;
      ++summary_.places;
      advance({tool, rapid, feed * stretch, command.line});
      return !stopped_;
    });
  }

  void advance(const PathPiece& piece) {
    PathMatcher::Outcome outcome = matcher_.advance(piece);
    if (outcome == PathMatcher::Outcome::follows) return;
    if (outcome == PathMatcher::Outcome::wrong_speed) {
      const Deviation front = matcher_.front();
      summary_.motion_differs = fmt::format(
          "line {} of the file run moves at {}, but line {} of the original has a different motion "
          "or feed, near {}",
          piece.line, words(piece), front.original_line, words(front.intended));
      first_fault(summary_.motion_differs);
      matcher_.ignore_speed();
      outcome = matcher_.advance(piece);
    }
    if (outcome == PathMatcher::Outcome::past_end) {
      const ProgramEvent& event = expected();
      if (event.kind == ProgramEvent::Kind::word) {
        return differ(
            fmt::format("missing: {}", event.word.text),
            fmt::format("{} of line {} of the original is not at its position, {}; line "
                        "{} of the file run moves on",
                        event.word.text, event.line, words(matcher_.path_end()), piece.line));
      }
    }
    if (outcome == PathMatcher::Outcome::follows) return;
    const Deviation front = matcher_.front();
    stray(
        fmt::format("line {} of the file run moves the tool to {}, away from line {} of the "
                    "original at {}",
                    piece.line, words(piece.to), front.original_line, words(front.intended)));
    matcher_.advance_anyhow(piece);
  }

  /// A word of the file that is run, or its end: the section must end on both sides with the same
  /// word.
  void compare(const ProgramEvent& found) {
    const PathMatcher::Outcome outcome = matcher_.finish();
    const bool is_end = found.kind == ProgramEvent::Kind::end;
    const std::string name = words(found);
    if (outcome != PathMatcher::Outcome::follows) {
      if (outcome == PathMatcher::Outcome::past_end && !is_end) {
        return differ(fmt::format("{} comes too early", name),
                      fmt::format("{} on line {} of the file run is too early: the path is not "
                                  "finished at {}",
                                  name, found.line, words(matcher_.front().intended)));
      }
      stray(is_end ? fmt::format("the file run ends on line {}, before the path of line {} of the "
                                 "original is complete",
                                 found.line, matcher_.front().original_line)
                   : place_fault());
      matcher_.finish_anyhow();
    }
    const ProgramEvent& event = expected();
    if (event.kind != found.kind || event.word.text != found.word.text) {
      const bool ended = event.kind == ProgramEvent::Kind::end;
      const std::string wanted = words(event);
      const std::string difference = is_end  ? fmt::format("missing: {}", wanted)
                                     : ended ? fmt::format("too many: {}", name)
                                             : fmt::format("{} instead of {}", name, wanted);
      return differ(
          difference,
          fmt::format("line {} of the file run has {}, but line {} of the original has {}",
                      found.line, name, event.line, wanted));
    }
    if (is_end) {
      if (summary_.commands == 0 && !moves_itself_) stray("the file run does not move the tool");
      return;
    }
    moves_itself_ = moves_itself_ || found.word.moves_itself;
    const std::size_t line = event.line;
    intended_.pop();
    if (found.word.leaves_xy) {
      // Both restart where the move in machine coordinates has taken them.
      homed_ = true;
      started_ = heights_done_ = false;
      static_cast<void>(matcher_.begin({0.0, {}, {}, line, found.line}));
      return;
    }
    const Point tool = started_ ? last_tool_ : matcher_.front().tool;
    static_cast<void>(matcher_.begin({0.0, matcher_.path_end(), tool, line, found.line}));
  }

  std::string place_fault() const {
    const Deviation front = matcher_.front();
    return fmt::format(
        "on line {} of the file run the tool is at {}, {:.4f} mm from its position {} on line {} "
        "of the original",
        front.run_line, words(front.tool), front.distance_mm, words(front.intended),
        front.original_line);
  }

  void first_fault(const std::string& sentence) {
    if (summary_.fault.empty()) summary_.fault = sentence;
  }
  void stray(const std::string& sentence) {
    summary_.strays = true;
    first_fault(sentence);
  }
  /// Where the words differ, the rest cannot be matched.
  void differ(std::string difference, const std::string& sentence) {
    summary_.words_differ = std::move(difference);
    first_fault(sentence);
    stopped_ = true;
  }

  ProgramStream intended_;
  ProgramStream run_;
  VerifyOptions options_;
  SimulatedMachine machine_;
  PathMatcher matcher_;
  VerifySummary summary_;
  bool stopped_ = false;
  bool started_ = false;
  bool heights_done_ = false;
  bool homed_ = false;         ///< and not yet at a place
  bool moves_itself_ = false;  ///< a word has moved the tool in the machine's frame
  Move arc_;                   // being divided into chords
  int chord_ = 0;
  int chords_ = 0;
  Point last_tool_;
  Point last_command_;
};

}  // namespace

tl::expected<VerifySummary, VerifyProblem> verify(LineSource& original, LineSource& run,
                                                  const Corrector& corrector,
                                                  const Dialect& dialect,
                                                  const VerifyOptions& options) {
  try {
    return Verification(original, run, corrector, dialect, options).result();
  } catch (const VerifyProblem& problem) {
    return tl::unexpected(problem);
  } catch (const Refusal& refusal) {
    return tl::unexpected(VerifyProblem{false, refusal.problem});
  }
}

Result<Deviation> uncompensated(LineSource& original, const Corrector& corrector,
                                const Dialect& dialect, const VerifyOptions& options) {
  ProgramStream stream(original, dialect);
  SimulatedMachine machine(corrector, machine_options(options));
  Deviation worst;
  bool started = false;
  const auto take = [&](const Move& move) {
    if (options.on_move) options.on_move(move);
    const bool from_nowhere = !started && move.kind == MoveKind::rapid;
    started = started || begins(move);
    const auto look = [&](Point tool, Point command) {
      const double apart = distance_mm(tool, command);
      if (apart > worst.distance_mm) worst = {apart, command, tool, move.line, move.line};
      return true;
    };
    if (from_nowhere && started) {
      look(machine.place(move.to, move.line), move.to);
    } else if (started && !stays(move)) {
      machine.run(move, look);
    }
  };
  return attempt([&] {
    for (; stream.peek().kind != ProgramEvent::Kind::end; stream.pop()) {
      if (stream.peek().kind == ProgramEvent::Kind::move) take(stream.peek().move);
    }
    return worst;
  });
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The actions of a program, in order: moves in mm on the sheet, words that are passed through,
/// comments.
///
/// On the sheet: work offsets, G92 and rotation are applied, and Dialect::home_mm is added.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/coordinates.hpp"
#include "tools/gcode/problem.hpp"

namespace chaintrue::gcode {

struct Point {
  double x_mm = 0.0;
  double y_mm = 0.0;
  double z_mm = 0.0;
  friend bool operator==(const Point&, const Point&) = default;
  /// Drops the height.
  operator model::BedPoint() const { return {x_mm, y_mm}; }
};

enum class MoveKind { rapid, feed, arc, probe };
std::string_view name(MoveKind kind);

/// An arc or helix about an axis of a plane:
///   p(t) = centre + r(t) (cos(a(t)) first + sin(a(t)) second) + h(t) (first x second)
/// with t from 0 to 1 and r, a and h linear in t. r changes within the tolerance that controllers
/// grant to rounded words.
struct Arc {
  Point centre;
  /// Unit vectors of the plane; XY unless G18 or G19.
  Point first{1.0, 0.0, 0.0};
  Point second{0.0, 1.0, 0.0};
  double start_radius_mm = 0.0;
  double end_radius_mm = 0.0;
  double start_angle_rad = 0.0;
  /// Positive counter-clockwise about first x second; whole turns included.
  double sweep_rad = 0.0;
  double start_height_mm = 0.0;
  double end_height_mm = 0.0;
  /// Signed count of started turns, as in the G-code: G2 -1, G3 P2 +2.
  int turns = 0;

  /// True for the planes of G18 and G19.
  bool is_upright() const { return first.z_mm != 0.0 || second.z_mm != 0.0; }
};

enum class FeedMode { per_minute, inverse_time };

struct FeedRate {
  FeedMode mode = FeedMode::per_minute;
  /// mm/min, or 1/min: the whole move takes 1/value minutes.
  double value = 0.0;
};

struct Move {
  MoveKind kind = MoveKind::rapid;
  std::size_t line = 0;
  Point from;
  Point to;
  std::optional<Arc> arc;  ///< for MoveKind::arc
  FeedRate feed;           ///< meaningless for rapids
  /// Whether the program gives X or Y, and Z. A first move without one leaves that axis where it
  /// is.
  bool names_xy = false;
  bool names_z = false;
  /// Rotation of A, B and C in degrees; a two-chain router has no such axes.
  std::array<double, 3> turn_deg{};
};

/// A G or M code. G38.2 is {'G', 382}, M3 is {'M', 30}.
struct Code {
  char letter = 'G';
  int tenths = 0;
  friend auto operator<=>(const Code&, const Code&) = default;
};
/// `G38.2`
std::string name(Code code);

/// A word that does not affect the path and is passed through unchanged (S, T, M, G4, G43, G61
/// ...), or a motion in the machine's own frame (G53, G28, G30).
struct PassedWord {
  std::size_t line = 0;
  /// `M3`, `S1000`, `G4 P0.5`, `G53 G0 Z-1`; `G91 G28 Z0` applies to that line only.
  std::string text;
  std::optional<Code> code{};  ///< empty for S and T
  bool moves_itself = false;   ///< in the machine's frame
  bool leaves_xy = false;      ///< it moves X and Y; the next move starts from there
};

struct Comment {
  std::size_t line = 0;
  std::string text;      ///< parameters of (debug, ...) and (print, ...) are written out
  bool message = false;  ///< (msg, ...), (debug, ...), (print, ...): text is a message for the user
};

/// Information for the user that is no reason to reject the program.
struct Note {
  std::size_t line = 0;
  std::string_view name;  ///< stable, such as "no_program_end"
  std::string sentence;
  /// The problem for a reader that needs the program's places on the sheet.
  std::optional<ProblemName> problem{};
};

/// The findings of a run. Keeps the first hundred problems and notes and counts all; of consecutive
/// problems of one line, only the first is kept.
struct Findings {
  static constexpr std::size_t kMostKept = 100;
  std::vector<Problem> problems;
  std::uint64_t problem_count = 0;
  std::vector<Note> notes;
  std::uint64_t note_count = 0;

  void add(Problem problem);
  /// A note that is a problem for a reader that needs places on the sheet is added as one.
  void add(Note note);

 private:
  std::size_t last_line_ = 0;
};

/// Receives the program's events. It may reject a move; the interpreter then stops with that
/// problem.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void move(const Move& move) = 0;
  virtual void word(const PassedWord&) {}
  virtual void comment(const Comment&) {}
  virtual void note(const Note&) {}
  /// An arc that does not exist; true: the program goes on from its end.
  virtual bool goes_on_after(const Problem&) { return false; }
  /// Every code of every executed line.
  virtual void code(std::size_t /*line*/, Code) {}
  /// The program has ended at this line, by this word (`M2`, `M30`, `%`), or by the end of the file
  /// (empty).
  virtual void end(std::size_t /*line*/, std::string_view /*word*/) {}
};

}  // namespace chaintrue::gcode

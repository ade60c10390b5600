// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether a tool's track follows an intended path: the Frechet distance of two curves, decided as
/// both are read.
///
/// Both curves are polylines. The track follows the path within a distance d when two points can
/// run along them from their starts to their ends, neither ever going back, and never further
/// apart than d. That is decided exactly, by the free-space diagram: H. Alt, M. Godau, "Computing
/// the Frechet distance between two polygonal curves", Int. J. Comput. Geom. Appl. 5 (1995),
/// section 3. A move that is missing, superfluous, out of order, or gone over twice is therefore a
/// fault even where every place of the tool is near to some place of the path.
///
/// Pieces also have a kind (rapid or feed) and a speed. A piece may pass another one only where
/// these agree, from `least_run_mm` of travel on: rounding may swallow what is shorter.
///
/// Only the part of the path that the tool can stand for is kept: memory is bounded by
/// `most_open` pieces. Where more are in reach, those furthest behind are given up.
///
/// \code
///   PathMatcher matcher({.distance_mm = 0.05}, next_piece_of_the_path);
///   matcher.begin(path_start, tool_start);
///   while (track >> piece) if (matcher.advance(piece) != PathMatcher::Outcome::follows) ...
///   matcher.finish();
/// \endcode
#pragma once

#include <functional>
#include <vector>

#include "tools/gcode/events.hpp"

namespace chaintrue::gcode {

/// A straight piece, from where the last one ended.
struct PathPiece {
  Point to;
  bool rapid = false;
  double speed_mm_per_min = 0.0;  ///< of feeds
  std::size_t line = 0;
};

class PathMatcher {
 public:
  struct Limits {
    double distance_mm = 0.05;
    /// Feeds agree when their speeds differ by no more than this share.
    double speed_share = 0.06;
    double least_run_mm = 0.01;
    std::size_t most_open = 1024;
  };
  /// Gives the next piece of the path; false where the section ends.
  using Path = std::function<bool(PathPiece&)>;

  enum class Outcome {
    follows,
    strays,       ///< no such pair of runs within the distance
    wrong_speed,  ///< there is one, but with other kinds or speeds
    past_end,     ///< the tool goes on where the section of the path has ended
  };
  struct Pair {
    double distance_mm = 0.0;
    Point intended;
    Point tool;
    std::size_t intended_line = 0;
    std::size_t tool_line = 0;
  };

  PathMatcher(const Limits& limits, Path path);

  /// Starts a section, both curves at these places. \return strays where they are too far apart.
  Outcome begin(Point intended, Point tool, std::size_t line);
  /// The tool moves on. After anything but `follows` the tool is still where it was.
  Outcome advance(const PathPiece& piece);
  /// The same with whatever distance it takes, to within a tenth; for what follows a fault.
  void advance_anyhow(const PathPiece& piece);
  /// Both curves end here. past_end: the path goes on.
  Outcome finish();
  void finish_anyhow();
  /// Kinds and speeds no longer matter.
  void ignore_speed() { labels_ = false; }

  /// The end of the path so far as it was read.
  [[nodiscard]] Point path_end() const { return path_end_; }
  /// Where the tool and the last place of the path that it can stand for are, for messages.
  [[nodiscard]] Pair front() const;
  /// The largest distance of a place of the tool, or of a corner of the path, from the nearest
  /// place that the order allows. Never above the Frechet distance.
  [[nodiscard]] const Pair& largest(bool rapid) const { return largest_[rapid ? 1 : 0]; }

 private:
  /// Parameters 0 .. 1 of a piece; empty where low > high.
  struct Span {
    double low = 1.0;
    double high = 0.0;
    [[nodiscard]] bool empty() const { return low > high; }
  };
  /// Follows a curve's runs of one kind and speed.
  struct Run {
    bool rapid = false;
    double speed = -1.0;
    Point start;
    Point pinned;
  };
  struct Open {
    Point from;
    PathPiece piece;
    bool pinned = false;
    Span left;    // reachable with the tool at the start of its piece
    Span right;   // and at its end
    Pair corner;  // the nearest that the tool came to the piece's end
  };

  bool read();
  bool pin(Run& run, Point from, const PathPiece& piece) const;
  [[nodiscard]] bool agree(const PathPiece& a, const PathPiece& b) const;
  bool column(const PathPiece& piece, bool pinned, double distance_mm, bool labels);
  void cell(Open& open,
            Span bottom,
            const PathPiece& piece,
            bool pinned,
            bool labels,
            Span& right,
            Span& top) const;
  void commit(const PathPiece& piece);
  void close_up();
  void note(bool rapid, const Pair& pair);
  void note_corner(Open& open, Point tool, std::size_t line);
  [[nodiscard]] bool at_end() const;

  Limits limits_;
  Path path_;
  double distance_mm_;
  bool labels_ = true;
  bool exhausted_ = true;  // the section of the path has been read to its end
  std::vector<Open> open_;
  std::size_t first_ = 0;    // of those still in reach
  std::size_t reached_ = 0;  // the last with a left span
  Point path_end_;
  Point tool_;
  std::size_t tool_line_ = 0;
  Run path_run_;
  Run tool_run_;
  Pair largest_[2];
};

}  // namespace chaintrue::gcode

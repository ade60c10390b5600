// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether a tool's track follows an intended path: the Frechet distance of two curves, decided
/// while both are read.
///
/// Both curves are polylines. The track follows the path within a distance d if two points can move
/// along them from start to end, both monotonically, and never further apart than d. This is
/// decided exactly with the free-space diagram: H. Alt, M. Godau, "Computing the Frechet distance
/// between two polygonal curves", Int. J. Comput. Geom. Appl. 5 (1995), section 3. A move that is
/// missing, superfluous, out of order or repeated is therefore a fault even if every point of the
/// track is near to some point of the path.
///
/// Pieces also have a kind (rapid or feed) and a speed. Pieces correspond only if these agree, from
/// `least_run_mm` of travel on: shorter moves may vanish by rounding.
///
/// Only the part of the path that can correspond to the tool's position is kept: memory is bounded
/// by `most_open` pieces. If more are reachable, those furthest behind are dropped.
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

/// A straight piece, starting at the end of the previous one.
struct PathPiece {
  Point to;
  bool rapid = false;
  double speed_mm_per_min = 0.0;  ///< of feeds
  std::size_t line = 0;
};

/// A point of the tool, and the one of the path that it corresponds to.
struct Deviation {
  double distance_mm = 0.0;
  Point intended;
  Point tool;
  std::size_t original_line = 0;
  std::size_t run_line = 0;
};

class PathMatcher {
 public:
  struct Limits {
    double distance_mm = 0.05;
    /// Feeds agree if their speeds differ by no more than this share.
    double speed_share = 0.06;
    double least_run_mm = 0.01;
    std::size_t most_open = 1024;
  };
  /// Returns the next piece of the path; false at the end of the section.
  using Path = std::function<bool(PathPiece&)>;

  enum class Outcome {
    follows,
    strays,       ///< no such pair of runs within the distance
    wrong_speed,  ///< there is one, but kinds or speeds differ
    past_end,     ///< the tool continues after the end of the section of the path
  };
  PathMatcher(const Limits& limits, Path path);

  /// Starts a section with both curves at these points, of these lines. \return strays if they are
  /// too far apart.
  Outcome begin(const Deviation& start);
  /// The tool moves on. After any result but `follows` the tool is still at its previous position.
  Outcome advance(const PathPiece& piece);
  /// The same with the smallest sufficient distance, to within a tenth; used after a fault.
  void advance_anyhow(const PathPiece& piece);
  /// Both curves end here. past_end: the path continues.
  Outcome finish();
  void finish_anyhow();
  /// Kinds and speeds are ignored from here on.
  void ignore_speed() { labels_ = false; }

  /// The end of the path as far as it was read.
  Point path_end() const { return path_end_; }
  /// The tool's position and the last point of the path that can correspond to it, for messages.
  Deviation front() const;
  /// The largest distance of a point of the tool, or of a corner of the path, from the nearest
  /// point that the order allows. Never above the Frechet distance.
  const Deviation& largest(bool rapid) const { return largest_[rapid ? 1 : 0]; }

 private:
  /// Parameters 0 .. 1 of a piece; empty where low > high.
  struct Span {
    double low = 1.0;
    double high = 0.0;
    bool empty() const { return low > high; }
  };
  /// Tracks a curve's runs of one kind and speed.
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
    Span left;         // reachable with the tool at the start of its piece
    Span right;        // and at its end
    Deviation corner;  // the tool's nearest approach to the piece's end
  };

  static Span free_part(Point a, Point b, Point c, double distance2);
  bool read();
  bool pin(Run& run, Point from, const PathPiece& piece) const;
  bool agree(const PathPiece& a, const PathPiece& b) const;
  bool column(const PathPiece& piece, bool pinned, double distance_mm, bool labels);
  void cell(Open& open, Span bottom, const PathPiece& piece, bool pinned, bool labels, Span& right,
            Span& top) const;
  void commit(const PathPiece& piece);
  void close_up();
  void note(bool rapid, const Deviation& pair);
  void note_corner(Open& open, Point tool, std::size_t line);
  bool at_end() const;

  Limits limits_;
  Path path_;
  double distance_mm_;
  bool labels_ = true;
  bool exhausted_ = true;  // the section of the path has been read to its end
  std::vector<Open> open_;
  std::size_t first_ = 0;    // of the reachable ones
  std::size_t reached_ = 0;  // the last with a left span
  Point path_end_;
  std::size_t path_end_line_ = 0;
  Point tool_;
  std::size_t tool_line_ = 0;
  Run path_run_;
  Run tool_run_;
  Deviation largest_[2];
};

}  // namespace chaintrue::gcode

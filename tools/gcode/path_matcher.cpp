// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The free-space diagram, one column for each piece of the track.
///
/// Cell (i, j) belongs to piece i of the path and piece j of the track. Its left and right edges
/// are parametrised along the path, bottom and top along the track; the free part of each is an
/// interval, because a ball intersects a line in one. The reachable part of an edge is the free
/// part above (right of) the lowest reachable entry.
#include "tools/gcode/path_matcher.hpp"

#include <algorithm>
#include <cmath>

#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

/// Factor by which the distance grows after a fault until the track can be followed again.
constexpr double kWiden = 1.1;
constexpr double kMostDistanceMm = 1e6;
constexpr double kHalf = 0.5;

double squared(Point a, Point b) { return dot(a - b, a - b); }

}  // namespace

/// The part of the piece a b within a distance of c. The ends are decided by their own distances,
/// so that the four edges that meet in a corner are consistent.
PathMatcher::Span PathMatcher::free_part(Point a, Point b, Point c, double distance2) {
  const bool a_inside = squared(a, c) <= distance2;
  const bool b_inside = squared(b, c) <= distance2;
  if (a_inside && b_inside) return {0.0, 1.0};
  const double length2 = squared(a, b);
  if (length2 == 0.0) return {};
  const double along = dot(b - a, c - a) / length2;
  const double rest = distance2 - squared(a + along * (b - a), c);
  if (rest < 0.0) {
    // The line is outside, up to the rounding of an end that is just inside.
    if (a_inside) return {0.0, 0.0};
    if (b_inside) return {1.0, 1.0};
    return {};
  }
  const double reach = std::sqrt(rest / length2);
  const double low = a_inside ? 0.0 : along - reach;
  const double high = b_inside ? 1.0 : along + reach;
  if (low > 1.0 || high < 0.0) return {};
  return {std::clamp(low, 0.0, 1.0), std::clamp(high, 0.0, 1.0)};
}

PathMatcher::PathMatcher(const Limits& limits, Path path)
    : limits_(limits), path_(std::move(path)), distance_mm_(limits.distance_mm) {}

bool PathMatcher::agree(const PathPiece& a, const PathPiece& b) const {
  if (a.rapid != b.rapid) return false;
  return a.rapid || std::fabs(a.speed_mm_per_min - b.speed_mm_per_min) <=
                        limits_.speed_share * std::max(a.speed_mm_per_min, b.speed_mm_per_min);
}

/// Whether a piece is so far into its run that the other curve must have a run of the same kind.
bool PathMatcher::pin(Run& run, Point from, const PathPiece& piece) const {
  const PathPiece before{.to = from, .rapid = run.rapid, .speed_mm_per_min = run.speed, .line = 0};
  if (run.speed < 0.0 || !agree(before, piece)) {
    run = {piece.rapid, piece.speed_mm_per_min, from, from};
  }
  const Point middle = between(from, piece.to, kHalf);
  const double least2 = limits_.least_run_mm * limits_.least_run_mm;
  const bool pinned = squared(middle, run.start) >= least2 && squared(middle, run.pinned) >= least2;
  if (pinned) run.pinned = middle;
  return pinned;
}

/// Adds the next piece of the path to the open ones.
bool PathMatcher::read() {
  if (exhausted_) return false;
  Open next;
  if (!path_(next.piece)) {
    exhausted_ = true;
    return false;
  }
  next.from = path_end_;
  next.pinned = pin(path_run_, next.from, next.piece);
  next.corner.distance_mm = kMostDistanceMm;
  path_end_ = next.piece.to;
  path_end_line_ = next.piece.line;
  open_.push_back(next);
  return true;
}

PathMatcher::Outcome PathMatcher::begin(const Deviation& start) {
  exhausted_ = false;
  path_run_ = {};
  tool_run_ = {};
  path_end_ = start.intended;
  path_end_line_ = start.original_line;
  tool_ = start.tool;
  tool_line_ = start.run_line;
  open_.clear();
  first_ = reached_ = 0;
  Open place;
  place.from = start.intended;
  place.piece.to = start.intended;
  place.piece.line = start.original_line;
  place.corner.distance_mm = kMostDistanceMm;
  place.left = {0.0, 1.0};
  open_.push_back(place);
  const double apart = distance_mm(start.intended, start.tool);
  const Outcome outcome = apart <= distance_mm_ ? Outcome::follows : Outcome::strays;
  note(false, {apart, start.intended, start.tool, start.original_line, start.run_line});
  distance_mm_ = std::max(distance_mm_, apart);
  close_up();
  return outcome;
}

/// The path advances while the tool does not move.
void PathMatcher::close_up() {
  while (open_[reached_].left.high >= 1.0) {
    note_corner(open_[reached_], tool_, tool_line_);
    if (reached_ + 1 == open_.size() && !read()) return;
    Open& next = open_[reached_ + 1];
    const Span part = free_part(next.from, next.piece.to, tool_, distance_mm_ * distance_mm_);
    if (part.low > 0.0 || part.low > part.high) return;
    next.left = {0.0, part.high};
    ++reached_;
    if (reached_ - first_ >= limits_.most_open) ++first_;
  }
}

void PathMatcher::note(bool rapid, const Deviation& pair) {
  Deviation& worst = largest_[rapid ? 1 : 0];
  if (pair.distance_mm > worst.distance_mm) worst = pair;
}

void PathMatcher::note_corner(Open& open, Point tool, std::size_t line) {
  const double apart = distance_mm(open.piece.to, tool);
  if (apart < open.corner.distance_mm) {
    open.corner = {apart, open.piece.to, tool, open.piece.line, line};
  }
}

/// The reachable parts of a cell's right and top edges, given their free parts.
void PathMatcher::cell(Open& open, Span bottom, const PathPiece& piece, bool pinned, bool labels,
                       Span& right, Span& top) const {
  const Span left = open.left;
  const bool barred = labels && (open.pinned || pinned) && !agree(open.piece, piece);
  if (!barred) {
    if (bottom.empty()) right.low = std::max(right.low, left.low);
    if (left.empty()) top.low = std::max(top.low, bottom.low);
    return;
  }
  // Pieces of different kinds do not pass each other's pinned middles.
  const bool left_upper = !left.empty() && left.high >= kHalf;
  const bool left_lower = !left.empty() && left.low <= kHalf;
  const bool bottom_late = !bottom.empty() && bottom.high >= kHalf;
  const bool bottom_early = !bottom.empty() && bottom.low <= kHalf;
  if (open.pinned && pinned) {
    right.high = bottom_late ? std::min(right.high, kHalf) : -1.0;
    top.high = left_upper ? std::min(top.high, kHalf) : -1.0;
  } else if (open.pinned) {
    if (!left_upper) top.high = -1.0;
    if (bottom.empty()) right.low = std::max(right.low, left.low);
    if (!left_upper) right.high = std::min(right.high, kHalf);
    if (!left_lower && bottom.empty()) right.low = std::max(right.low, kHalf);
  } else {
    if (!bottom_late) right.high = -1.0;
    if (left.empty()) top.low = std::max(top.low, bottom.low);
    if (!bottom_late) top.high = std::min(top.high, kHalf);
    if (!bottom_early && left.empty()) top.low = std::max(top.low, kHalf);
  }
}

/// Reachability after one more piece of the track; false if nothing is reachable.
bool PathMatcher::column(const PathPiece& piece, bool pinned, double distance_mm, bool labels) {
  const double distance2 = distance_mm * distance_mm;
  Span bottom;
  bool any = false;
  std::size_t i = first_;
  for (; i < open_.size(); ++i) {
    if (open_[i].left.empty() && bottom.empty()) {
      open_[i].right = {};
      if (i > reached_) break;
      continue;
    }
    Open& open = open_[i];
    Span right = free_part(open.from, open.piece.to, piece.to, distance2);
    Span top = free_part(tool_, piece.to, open.piece.to, distance2);
    cell(open, bottom, piece, pinned, labels, right, top);
    open.right = right;
    any = any || !right.empty();
    bottom = top;
    if (top.empty()) continue;
    const double nearest =
        std::clamp(nearest_on_line(tool_, piece.to, open.piece.to), top.low, top.high);
    note_corner(open, between(tool_, piece.to, nearest), piece.line);
    if (i + 1 == open_.size()) read();
  }
  for (; i < open_.size(); ++i) open_[i].right = {};
  return any;
}

/// The tool is at the end of the piece.
void PathMatcher::commit(const PathPiece& piece) {
  Deviation nearest{kMostDistanceMm, {}, piece.to, 0, piece.line};
  bool rapid = false;
  std::size_t lowest = open_.size();
  for (std::size_t i = first_; i < open_.size(); ++i) {
    Open& open = open_[i];
    open.left = open.right;
    if (open.left.empty()) continue;
    lowest = std::min(lowest, i);
    reached_ = i;
    const double t = std::clamp(nearest_on_line(open.from, open.piece.to, piece.to), open.left.low,
                                open.left.high);
    const Point place = between(open.from, open.piece.to, t);
    const double apart = distance_mm(place, piece.to);
    if (apart < nearest.distance_mm) {
      nearest = {apart, place, piece.to, open.piece.line, piece.line};
      rapid = open.piece.rapid;
    }
  }
  note(rapid, nearest);
  if (reached_ - lowest >= limits_.most_open) lowest = reached_ - limits_.most_open + 1;
  for (; first_ < lowest; ++first_) note(open_[first_].piece.rapid, open_[first_].corner);
  if (first_ > 256) {
    open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(first_));
    reached_ -= first_;
    first_ = 0;
  }
  tool_ = piece.to;
  tool_line_ = piece.line;
}

bool PathMatcher::at_end() const {
  return exhausted_ && reached_ + 1 == open_.size() && open_[reached_].left.high >= 1.0;
}

PathMatcher::Outcome PathMatcher::advance(const PathPiece& piece) {
  const Run before = tool_run_;
  const bool pinned = labels_ && pin(tool_run_, tool_, piece);
  if (column(piece, pinned, distance_mm_, labels_)) {
    commit(piece);
    return Outcome::follows;
  }
  tool_run_ = before;
  if (at_end()) return Outcome::past_end;
  return labels_ && column(piece, pinned, distance_mm_, false) ? Outcome::wrong_speed
                                                               : Outcome::strays;
}

void PathMatcher::advance_anyhow(const PathPiece& piece) {
  while (!column(piece, false, distance_mm_, false) && distance_mm_ < kMostDistanceMm) {
    distance_mm_ *= kWiden;
  }
  const Deviation before = front();
  note(piece.rapid, {distance_mm_, before.intended, piece.to, before.original_line, piece.line});
  commit(piece);
}

PathMatcher::Outcome PathMatcher::finish() {
  while (exhausted_ == false && open_[reached_].left.high >= 1.0 && reached_ + 1 == open_.size()) {
    if (!read()) break;
  }
  if (!at_end())
    return exhausted_ && reached_ + 1 == open_.size() ? Outcome::strays : Outcome::past_end;
  for (; first_ < open_.size(); ++first_) {
    note_corner(open_[first_], tool_, tool_line_);
    note(open_[first_].piece.rapid, open_[first_].corner);
  }
  return Outcome::follows;
}

/// The rest of the path was not run: all of it is compared with the tool's last position.
void PathMatcher::finish_anyhow() {
  std::size_t i = first_;
  do {
    for (; i < open_.size(); ++i) {
      note_corner(open_[i], tool_, tool_line_);
      note(open_[i].piece.rapid, open_[i].corner);
    }
    open_.clear();
    i = 0;
  } while (read());
  // The ends correspond to each other.
  note(false, {distance_mm(path_end_, tool_), path_end_, tool_, path_end_line_, tool_line_});
}

Deviation PathMatcher::front() const {
  if (open_.empty()) return {0.0, path_end_, tool_, path_end_line_, tool_line_};
  const Open& open = open_[std::min(reached_, open_.size() - 1)];
  const double t = open.left.empty() ? 1.0 : open.left.high;
  const Point place = between(open.from, open.piece.to, t);
  return {distance_mm(place, tool_), place, tool_, open.piece.line, tool_line_};
}

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/follower/path_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chaintrue::follower {
namespace {

/// A part of a segment, as fractions of it; empty where from > to.
struct Interval {
  double from = 1.0;
  double to = 0.0;
  bool empty() const { return from > to; }
};

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// The part of the segment within the distance of a position.
Interval near(const Place& from, const Place& to, const Place& place, double distance) {
  const Place way = minus(to, from);
  const Place back = minus(from, place);
  const double a = dot(way, way);
  const double c = dot(back, back) - distance * distance;
  if (a == 0.0) return c <= 0.0 ? Interval{0.0, 1.0} : Interval{};
  const double b = dot(back, way);
  const double root = b * b - a * c;
  if (root < 0.0) return {};
  const double half = std::sqrt(root);
  return {std::max(0.0, (-b - half) / a), std::min(1.0, (-b + half) / a)};
}

/// The reachable part of the lower edges of a row of cells.
struct Edge {
  std::size_t cell;
  Interval reached;
};

}  // namespace

bool within(const std::vector<Place>& a, const std::vector<Place>& b, double distance) {
  if (a.empty() || b.empty()) return a.empty() && b.empty();
  // A path of one position is a segment of zero length.
  std::vector<Place> p = a;
  std::vector<Place> q = b;
  if (p.size() == 1) p.push_back(p.front());
  if (q.size() == 1) q.push_back(q.front());
  const auto apart = [](const Place& u, const Place& v) {
    return std::sqrt(dot(minus(u, v), minus(u, v)));
  };
  if (apart(p.front(), q.front()) > distance || apart(p.back(), q.back()) > distance) return false;
  const std::size_t cells = p.size() - 1;
  // The lower edge of the first row: along p while q is at its beginning.
  std::vector<Edge> lower;
  for (std::size_t i = 0; i < cells; ++i) {
    const Interval free = near(p[i], p[i + 1], q[0], distance);
    if (free.empty() || free.from > 0.0) break;
    lower.push_back({i, free});
    if (free.to < 1.0) break;
  }
  bool left_border = true;  // q may advance while p is at its beginning
  bool end = false;
  for (std::size_t j = 0; j + 1 < q.size(); ++j) {
    std::vector<Edge> upper;
    Interval left;  // of the cell at hand
    if (left_border) {
      left = near(q[j], q[j + 1], p[0], distance);
      if (left.from > 0.0) left = {};
      left_border = !left.empty() && left.to >= 1.0;
    }
    std::size_t next = 0;  // of lower
    for (std::size_t i = 0; i < cells; ++i) {
      while (next < lower.size() && lower[next].cell < i) ++next;
      if (left.empty()) {
        if (next == lower.size()) break;
        i = lower[next].cell;
      }
      Interval bottom;
      if (next < lower.size() && lower[next].cell == i) bottom = lower[next].reached;
      Interval right = near(q[j], q[j + 1], p[i + 1], distance);
      Interval top = near(p[i], p[i + 1], q[j + 1], distance);
      if (bottom.empty()) right.from = std::max(right.from, left.from);
      if (left.empty()) top.from = std::max(top.from, bottom.from);
      if (!top.empty()) upper.push_back({i, top});
      left = right;
      if (j + 2 == q.size() && i + 1 == cells) {
        end = (!right.empty() && right.to >= 1.0) || (!top.empty() && top.to >= 1.0);
      }
    }
    if (upper.empty() && !left_border && j + 2 < q.size()) return false;
    lower = std::move(upper);
  }
  return end;
}

double path_distance_mm(const std::vector<Place>& a, const std::vector<Place>& b, double most_mm) {
  double high = most_mm;
  if (!within(a, b, high)) return most_mm;
  double low = 0.0;
  while (high - low > 0.002 * high && high > 1e-9) {
    const double middle = 0.5 * (low + high);
    (within(a, b, middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace chaintrue::follower

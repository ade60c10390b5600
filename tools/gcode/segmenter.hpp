// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Divides a curve of commanded points into the longest straight commands that stay within a
/// tolerance.
///
/// From each sample the next is placed as far on as the tolerance allows (to within 8 %), so that
/// no other choice of samples on the curve needs markedly fewer. The deviation is measured at
/// interior points of the exact curve from the controller's own path between the two commands, in
/// space and independent of time.
///
/// Error budget of a path: chord (measured against the exact map, for arcs and lines) + rounding of
/// the words (half a unit of the last decimal in each axis) <= tolerance.
#pragma once

#include <functional>

#include "tools/gcode/corrector.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {

/// A point of the path and its command; both have the same height.
struct PathSample {
  double t = 0.0;
  Point target;
  Point command;
};

/// The curve: target and command at t.
using Curve = std::function<Corrected<PathSample>(double t)>;

/// Rounding error at this number of decimals; the tolerance must be larger.
double least_tolerance_mm(int decimals);

class Segmenter {
 public:
  /// Keeps a reference. \throws std::invalid_argument if the tolerance does not exceed the rounding.
  /// \param tolerance_mm of the path, above least_tolerance_mm(decimals).
  Segmenter(const Corrector& corrector, double tolerance_mm, int decimals);

  /// Straight moves up to this length bow by a small share of the tolerance at most.
  double unchecked_mm() const { return unchecked_mm_; }

  struct Extent {
    double length_mm = 0.0;
    double longest_mm = 0.0;
    double feed_mm_per_min = 0.0;  ///< of the commands; 0: none was stated
  };

  /// Visits the samples after `start` up to t = `end`, in order.
  /// \param extent the curve's length from start to end, which affects only the first trial and
  /// the density of checks, and the largest part of it that one command may cover.
  Corrected<void> run(const Curve& curve, const PathSample& start, double end, Extent extent,
                      const std::function<void(const PathSample&)>& visit);

 private:
  /// The largest distance from the curve between two samples to the controller's path between their
  /// commands.
  Corrected<double> deviation_mm(const Curve& curve, const PathSample& a, const PathSample& b,
                                 double length_mm, double feed_mm_per_min) const;

  const Corrector& corrector_;
  double tolerance_mm_ = 0.0;  // of a chord
  double unchecked_mm_ = 0.0;
  double last_step_mm_ = 50.0;  // a typical value, as a first guess
};

}  // namespace chaintrue::gcode

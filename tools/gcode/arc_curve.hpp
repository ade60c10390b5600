// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The commanded curve of an arc, cheap enough to be looked at often.
///
/// The correction along a stretch of the arc is interpolated at seven Chebyshev points (L. N.
/// Trefethen, "Approximation Theory and Approximation Practice", SIAM 2013, chapter 5: the
/// barycentric formula); the arc itself is exact. A stretch is used where the interpolation misses
/// the exact command by less than the bound at two places between the points; elsewhere every
/// answer is computed.
#pragma once

#include <array>

#include "tools/gcode/segmenter.hpp"

namespace chaintrue::gcode {

class ArcCurve {
 public:
  /// Keeps references.
  /// \param exact the commanded curve of `move`.
  ArcCurve(const Move& move, const Curve& exact, double bound_mm);

  /// The sample at t, for a chord that begins at `start` <= t.
  [[nodiscard]] tl::expected<PathSample, CorrectionFailure> at(double t, double start);

 private:
  static constexpr std::size_t kNodes = 7;
  tl::expected<void, CorrectionFailure> fit(double start);
  [[nodiscard]] model::BedPoint correction(double t) const;

  const Move& move_;
  const Curve& exact_;
  double bound_mm_;
  double stretch_ = 0.0;  // of t
  double from_ = 0.0;
  double to_ = -1.0;
  bool usable_ = false;
  std::array<double, kNodes> t_{};
  std::array<model::BedPoint, kNodes> value_{};
};

}  // namespace chaintrue::gcode

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A smooth surface through scattered, noisy points.
///
/// Cubic B-splines with a thin-plate penalty whose weight is chosen by restricted maximum
/// likelihood (bspline_basis.hpp, reml.hpp). Points that the others contradict are given less
/// weight and reported. A meaningless fit is rejected, with the reason: points on a line, data that
/// do not determine the surface, a surface that predicts held-out points worse than a plane does.
///
/// Notation: h_i leverage, r_i residual, e_i = r_i / (1 - h_i) the error at point i when it is left
/// out, t_i = e_i over its own sigma.

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "interp/bspline_basis.hpp"
#include "interp/reml.hpp"
#include "interp/surface.hpp"

namespace chaintrue::interp {

struct ScatteredPoint {
  double x;
  double y;
  double z;
  double sigma = 1.0;  ///< of z; relative to the other points where the noise scale is unknown
};

struct ScatteredOptions {
  std::optional<Rectangle> rectangle;  ///< of the basis; empty: the points' bounding box
  int intervals_x = 0;                 ///< 0: chosen from the number of points and the shape
  int intervals_y = 0;
  NoiseScale noise = {NoiseKnowledge::unknown, 0.0};
  bool robust = true;               ///< reduce the weight of points that the others contradict
  double contradicted_from = 4.0;   ///< |t_i| from which on a point counts as contradicted
  double same_place_within = 1e-6;  ///< points nearer than this are repeats of one another
};

enum class PointDoubt {
  contradicted,      ///< the residual from the surface through the others is too large
  repeats_disagree,  ///< at the position of another point, and differs by more than the noise
};

/// A point that the fit flags.
struct PointFlag {
  std::size_t index;
  PointDoubt doubt;
  double standardized;  ///< t_i, or the difference from the repeats' mean over its sigma
  double weight;        ///< its weight in the fit: 1 full, less for larger errors
};

struct ScatteredFailure {
  enum class Reason {
    too_few_points,  ///< fewer than six
    on_a_line,       ///< narrower than 1/1000 of its length
    rank_deficient,  ///< the points do not determine the surface
    not_converged,   ///< the choice of smoothing did not converge
    untrustworthy,   ///< left-out points are predicted worse than by a plane
  } reason;
  std::string sentence;
};

/// Errors of the surface at held-out points.
struct LeftOutErrors {
  Eigen::VectorXd error;  ///< e_i in the unit of z, one for each point
  double rms = 0.0;       ///< of e_i over points that are not flagged
  double largest = 0.0;
  double plane_rms = 0.0;  ///< the same for the best plane
  double residual_rms = 0.0;
};

/// The fitted surface. Immutable, thread safe; `at` allocates nothing. Outside the rectangle it
/// continues as BsplineBasis does.
class ScatteredSurface final : public Surface {
 public:
  [[nodiscard]] ValueGradient at(double x, double y) const override;
  [[nodiscard]] Rectangle domain() const override { return basis_.rectangle(); }
  /// Standard deviation of the surface at one point (pointwise), including the uncertainty of the
  /// smoothing.
  [[nodiscard]] double sigma(double x, double y) const;

  [[nodiscard]] const PenalisedFit& fit() const { return fit_; }
  [[nodiscard]] const BsplineBasis& basis() const { return basis_; }
  [[nodiscard]] const std::vector<PointFlag>& flags() const { return flags_; }
  [[nodiscard]] const LeftOutErrors& left_out() const { return left_out_; }

 private:
  friend class ScatteredFitter;
  ScatteredSurface(BsplineBasis basis, PenalisedFit fit)
      : basis_(std::move(basis)), fit_(std::move(fit)) {}

  BsplineBasis basis_;
  PenalisedFit fit_;
  std::vector<PointFlag> flags_;
  LeftOutErrors left_out_;
};

/// Fits. Throws std::invalid_argument where a number is not finite, a sigma not positive, or a
/// point lies outside a given rectangle. Same input, same bytes.
///
///     auto surface = fit_scattered(points);
///     if (!surface) { say(surface.error().sentence()); }
[[nodiscard]] tl::expected<ScatteredSurface, ScatteredFailure> fit_scattered(
    std::span<const ScatteredPoint> points, const ScatteredOptions& options = {});

}  // namespace chaintrue::interp

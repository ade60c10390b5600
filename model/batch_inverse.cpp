// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with -O3 -fno-math-errno -fno-trapping-math (model/CMakeLists.txt), so that the compiler
// may put square roots and both branches of a choice into vector lanes. Contraction stays off:
// both versions compute the same bytes.
#include "model/batch_inverse.hpp"

#include <fmt/format.h>

#include <array>
#include <stdexcept>

#include "model/equilibrium_newton.hpp"

// clang cannot both choose between versions and inline everything into them; it builds the plain
// version alone.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__clang__)
#define CHAINTRUE_VERSIONS __attribute__((target_clones("avx2", "default"), flatten))
#else
#define CHAINTRUE_VERSIONS __attribute__((flatten))
#endif

namespace chaintrue::model {
namespace {

constexpr std::size_t kBlock = 256;  // points whose numbers stay in the first-level cache

struct Block {
  std::array<double, kBlock> x, y, left, right;
  std::array<double, kBlock> unsettled;  // 0: the point has settled; NaN and anything else: not
};

/// atan2(vb, h) for h > 0, without a branch: the half angle from the tension, halved twice more,
/// and atan's series, whose first term left out is below 2e-17.
inline double tangent_angle(double vb, double h, double tb) {
  const double half = vb / (tb + h);
  const double quarter = half / (1.0 + std::sqrt(1.0 + half * half));
  const double t = quarter / (1.0 + std::sqrt(1.0 + quarter * quarter));
  const double q = t * t;
  return 8.0 * t *
         (1.0 - q * (1.0 / 3 -
                     q * (1.0 / 5 -
                          q * (1.0 / 7 -
                               q * (1.0 / 9 -
                                    q * (1.0 / 11 -
                                         q * (1.0 / 13 -
                                              q * (1.0 / 15 -
                                                   q * (1.0 / 17 - q * (1.0 / 19 - q / 21))))))))));
}

/// The equations of equilibrium.hpp in straight-line code over a block: three undamped Newton steps
/// from the straight start.
CHAINTRUE_VERSIONS void solve_block(const EquilibriumConstants& constants, Block& block) {
  const EquilibriumConstants m = constants;
  double* __restrict x = block.x.data();
  double* __restrict y = block.y.data();
  double* __restrict left = block.left.data();
  double* __restrict right = block.right.data();
  double* __restrict unsettled = block.unsettled.data();
  const double w = m.chain.weight_n_per_mm;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const BedPoint p{x[i], y[i]};
    EquilibriumState q = straight_start(m, p);
    EquilibriumStep step;
    double z_most = 0.0;
    const auto newton = [&] {
      const PerSide<ChainTerms> t{chain_terms<true>(m, q.h_left, q.v_left, q.s.left),
                                  chain_terms<true>(m, q.h_left - m.f, m.W - q.v_left, q.s.right)};
      EquilibriumLoad residual;
      residual.u = {t.left.tip_u - (p.x_mm - m.motors.left.x_mm),
                    t.right.tip_u - (m.motors.right.x_mm - p.x_mm)};
      residual.y = {t.left.tip_y - (m.motors.left.y_mm - p.y_mm),
                    t.right.tip_y - (m.motors.right.y_mm - p.y_mm)};
      step = solve_linearised<false>(m, t, residual, 0.0);
      const double zl = w * q.s.left / (t.left.ta + t.left.tb);
      const double zr = w * q.s.right / (t.right.ta + t.right.tb);
      z_most = std::max(z_most, std::max(zl * zl, zr * zr));
      q.h_left += step.h_left;
      q.v_left += step.v_left;
      q.s.left += step.s.left;
      q.s.right += step.s.right;
    };
    newton();
    newton();
    newton();
    const double h_right = q.h_left - m.f;
    const double vl = q.v_left + w * q.s.left, vr = m.W - q.v_left + w * q.s.right;
    const double tl_n = std::sqrt(q.h_left * q.h_left + vl * vl);
    const double tr_n = std::sqrt(h_right * h_right + vr * vr);
    const double phi_l = tangent_angle(vl, q.h_left, tl_n),
                 phi_r = tangent_angle(vr, h_right, tr_n);
    left[i] = q.s.left + m.wrap(phi_l);
    right[i] = q.s.right + m.wrap(phi_r);
    // Sums of what must be small, each by its own limit; below 1 in all.
    const double least_h = std::min(q.h_left, h_right);
    const double size = (std::abs(step.s.left) + std::abs(step.s.right)) / kLengthStepMm +
                        std::abs(step.h_left) / (kRelativeForceStep * least_h);
    const double out =
        z_most < kSeriesMost && least_h > 0.0 && q.s.left > 0.0 && q.s.right > 0.0 ? 0.0 : 1.0;
    unsettled[i] = size < 1.0 ? out : 1.0;
  }
}

}  // namespace

BatchInverse::BatchInverse(const EquilibriumParameters& parameters)
    : m_(equilibrium_constants(parameters)), scalar_(make_kinematics(parameters, Model::elastic)) {
  if (!std::holds_alternative<Ring>(parameters.attachment)) {
    throw std::invalid_argument("batch inverse needs a ring sled, not brackets");
  }
}

void BatchInverse::lengths(std::span<const BedPoint> points, std::span<Result> results) const {
  if (points.size() != results.size()) {
    throw std::invalid_argument(
        fmt::format("{} points but room for {} results", points.size(), results.size()));
  }
  const DomainLimits limits = limits_of(m_);
  Block block;
  for (std::size_t first = 0; first < points.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - first);
    for (std::size_t i = 0; i < kBlock; ++i) {
      // The last block is filled up with its first point.
      const BedPoint& p = points[first + (i < count ? i : 0)];
      block.x[i] = p.x_mm;
      block.y[i] = p.y_mm;
    }
    solve_block(m_, block);
    for (std::size_t i = 0; i < count; ++i) {
      const BedPoint& p = points[first + i];
      if (block.unsettled[i] == 0.0 && !domain_failure(limits, p)) {
        results[first + i] = ChainLengths{block.left[i], block.right[i]};
      } else {
        results[first + i] = scalar_->inverse(p).map([](const Pose& pose) { return pose.lengths; });
      }
    }
  }
}

}  // namespace chaintrue::model

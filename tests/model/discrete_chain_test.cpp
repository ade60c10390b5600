// SPDX-License-Identifier: GPL-3.0-or-later
// The pose compared with chains of links: point masses joined by springs, one end on a circle, the
// other on a rigid link to the sled. The catenary is not used; only node positions are unknown, and
// every node must be in equilibrium.
#include <gmock/gmock.h>

// Eigen's sparse solver narrows integers in its own code.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#pragma GCC diagnostic pop

#include <cmath>
#include <vector>

#include "model/catenary.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Pull of a spring on its first end, and its derivative by the second end less the first.
struct Pull {
  Vector2d force;
  Matrix2d stiffness;
};

Pull spring(const Vector2d& from, const Vector2d& to, double rest_mm, double compliance_per_n) {
  const Vector2d d = to - from;
  const double length = d.norm();
  const Vector2d t = d / length;
  const double tension = (length - rest_mm) / (rest_mm * compliance_per_n);
  const Matrix2d along = t * t.transpose();
  return {tension * t,
          along / (rest_mm * compliance_per_n) + tension / length * (Matrix2d::Identity() - along)};
}

class LinkedChains {
 public:
  LinkedChains(const EquilibriumParameters& m, ChainLengths lengths, int links)
      : m_(m), lengths_(lengths), links_(links) {}

  /// The bit's position at equilibrium. Newton starts from the guess; every start that converges
  /// ends at the same equilibrium.
  [[nodiscard]] BedPoint rest(const Pose& guess) {
    lay_out(guess);
    for (int n = 0; n < 200; ++n) {
      const Eigen::VectorXd residual = forces();
      Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(jacobian());
      const Eigen::VectorXd step = solver.solve(residual);
      // Springs are stiff and links swing: no node moves by more than a few links.
      const double share = std::min(1.0, 20.0 / step.cwiseAbs().maxCoeff());
      x_ -= share * step;
      if (step.cwiseAbs().maxCoeff() < 1e-9) return {x_[0], x_[1]};
    }
    ADD_FAILURE() << "the linked chains did not come to rest";
    return {};
  }

 private:
  // Unknowns: the bit, then per side the nodes 0 (ring) to links - 1; the last link ends on the
  // sprocket.
  [[nodiscard]] Eigen::Index index(Side side, int node) const {
    return 2 + 2 * ((side == Side::left ? 0 : links_) + node);
  }
  [[nodiscard]] Vector2d at(Eigen::Index i) const { return {x_[i], x_[i + 1]}; }

  struct Tangent {
    Vector2d point;
    double wrap_mm;
  };
  /// Tangent from a node to the sprocket, and the chain between it and 12 o'clock.
  [[nodiscard]] Tangent tangent(Side side, const Vector2d& node) const {
    const double outward = side == Side::left ? 1.0 : -1.0;  // towards the sled
    const double r = m_.sprocket_radius_mm, sg = m_.feed == Feed::over_top ? 1.0 : -1.0;
    const double away = outward * (node.x() - m_.motors[side].x_mm),
                 below = m_.motors[side].y_mm - node.y();
    const double d = std::hypot(away, below);
    const double phi = std::atan2(below, away) + sg * std::asin(r / d);
    return {{m_.motors[side].x_mm + outward * sg * r * std::sin(phi),
             m_.motors[side].y_mm + sg * r * std::cos(phi)},
            sg > 0 ? r * phi : r * (M_PI - phi)};
  }
  [[nodiscard]] double link_mm(Side side) const { return nominal_[side] / links_; }
  [[nodiscard]] double total_mm(Side side) const {
    return lengths_[side];
  }

  void lay_out(const Pose& guess) {
    x_.resize(2 + 4 * links_);
    const Vector2d bit(guess.position.x_mm, guess.position.y_mm);
    x_.head<2>() = bit;
    const double rho = std::get<Ring>(m_.attachment).radius_mm;
    for (const Side side : kSides) {
      const ChainState& c = guess.chains[side];
      nominal_[side] = c.free_length_mm;
      ring_pull_n_[side] = c.tension_at_sled_n;
      const CatenaryLoad load{c.horizontal_n, c.vertical_at_sled_n, c.free_length_mm};
      const double towards = side == Side::left ? -1.0 : 1.0;
      for (int node = 0; node < links_; ++node) {
        const CatenaryPoint p =
            catenary_point(load,
                           {m_.chain_weight_n_per_mm, m_.chain_compliance_per_n},
                           c.free_length_mm * node / links_);
        x_.segment<2>(index(side, node)) =
            bit + Vector2d(towards * (rho * c.horizontal_n / c.tension_at_sled_n + p.u_mm),
                           rho * c.vertical_at_sled_n / c.tension_at_sled_n + p.y_mm);
      }
    }
  }

  /// The last link: the part not on the sprocket.
  [[nodiscard]] Pull last_link(Side side, const Vector2d& node) const {
    const auto pull = [&](const Vector2d& from) {
      const Tangent t = tangent(side, from);
      return spring(from, t.point, last_mm(side, from), m_.chain_compliance_per_n);
    };
    // Its derivative by a difference: the tangent point and the rest length change too. Newton
    // needs it only approximately.
    Pull result = pull(node);
    for (int k = 0; k < 2; ++k) {
      Vector2d h = Vector2d::Zero();
      h[k] = 1e-4;
      result.stiffness.col(k) = -(pull(node + h).force - pull(node - h).force) / 2e-4;
    }
    return result;
  }
  [[nodiscard]] double last_mm(Side side, const Vector2d& node) const {
    return total_mm(side) - tangent(side, node).wrap_mm - (links_ - 1) * link_mm(side);
  }

  [[nodiscard]] Eigen::VectorXd forces() const {
    Eigen::VectorXd f = Eigen::VectorXd::Zero(x_.size());
    f[1] = -m_.sled_weight_n;
    each_link([&](Eigen::Index a, Eigen::Index b, const Pull& pull, double weight_n) {
      f.segment<2>(a) += pull.force;
      f[a + 1] -= 0.5 * weight_n;
      if (b < 0) return;
      f.segment<2>(b) -= pull.force;
      f[b + 1] -= 0.5 * weight_n;
    });
    return f;
  }
  [[nodiscard]] Eigen::SparseMatrix<double> jacobian() const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Eigen::Index row, Eigen::Index column, const Matrix2d& block) {
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) entries.emplace_back(row + i, column + j, block(i, j));
      }
    };
    each_link([&](Eigen::Index a, Eigen::Index b, const Pull& pull, double) {
      add(a, a, -pull.stiffness);
      if (b < 0) return;
      add(a, b, pull.stiffness);
      add(b, a, pull.stiffness);
      add(b, b, -pull.stiffness);
    });
    Eigen::SparseMatrix<double> j(x_.size(), x_.size());
    j.setFromTriplets(entries.begin(), entries.end());
    return j;
  }
  template <class Visit>
  void each_link(Visit visit) const {
    // The ring's link is a spring too, shorter by its stretch under the pose's pull.
    constexpr double kStiff = 1e-9;
    const double rho = std::get<Ring>(m_.attachment).radius_mm;
    for (const Side side : kSides) {
      visit(0,
            index(side, 0),
            spring(at(0), at(index(side, 0)), rho / (1.0 + kStiff * ring_pull_n_[side]), kStiff),
            0.0);
      for (int node = 0; node + 1 < links_; ++node) {
        const Eigen::Index a = index(side, node), b = index(side, node + 1);
        visit(a,
              b,
              spring(at(a), at(b), link_mm(side), m_.chain_compliance_per_n),
              m_.chain_weight_n_per_mm * link_mm(side));
      }
      const Eigen::Index a = index(side, links_ - 1);
      visit(a,
            Eigen::Index{-1},
            last_link(side, at(a)),
            m_.chain_weight_n_per_mm * last_mm(side, at(a)));
    }
  }

  EquilibriumParameters m_;
  ChainLengths lengths_;
  int links_;
  PerSide<double> nominal_;
  PerSide<double> ring_pull_n_;
  Eigen::VectorXd x_;
};

TEST(DiscreteChain, ComesToRestAtThePoseAsItsLinksGetShorter) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    Machine machine;
    machine.feed = feed;
    const EquilibriumParameters m = equilibrium_parameters(machine);
    const auto kinematics = make_kinematics(m);
    for (const BedPoint p :
         {BedPoint{0.0, 0.0}, {-1100.0, -550.0}, {700.0, 500.0}, {1200.0, -100.0}}) {
      SCOPED_TRACE(testing::Message() << (feed == Feed::over_top ? "over top" : "off bottom")
                                      << " (" << p.x_mm << ", " << p.y_mm << ")");
      const Pose pose = kinematics->inverse(p).value();
      Vector2d e[3];
      for (int k = 0; k < 3; ++k) {
        const BedPoint rest = LinkedChains(m, pose.lengths, 150 << k).rest(pose);
        e[k] = {rest.x_mm - p.x_mm, rest.y_mm - p.y_mm};
      }
      // With a real chain's 470 links the sled is within 7e-5 mm of the pose; 600 links are closer.
      EXPECT_LE(e[2].norm(), 7e-5);
      // Order of the error: h^2 from the bend at each pin, h from the stretch of the arc between
      // the last link's direction and the tangent's. With both eliminated h^3 remains, and
      // rounding: 1e-13 mm in springs of 3e-8 mm per newton.
      EXPECT_LE(((8.0 * e[2] - 6.0 * e[1] + e[0]) / 3.0).norm(), 2e-10);
      EXPECT_LT(e[1].norm(), 0.5 * e[0].norm());
      EXPECT_LT(e[2].norm(), 0.5 * e[1].norm());
    }
  }
}

}  // namespace
}  // namespace chaintrue::model

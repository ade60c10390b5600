// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the heavy elastic chain and of the pose with two of them, each checked by a formula that
// the solver does not use.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <vector>

#include "model/kinematics.hpp"
#include "tests/model/oracle/catenary_shape.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::model {
namespace {

constexpr std::uint64_t kLawSeed = 4711;

class Random : public testing_support::Random {
 public:
  using testing_support::Random::Random;
  double logarithmic(double from, double to) {
    return std::exp(uniform(std::log(from), std::log(to)));
  }
  BedPoint bed() { return {uniform(-1219.2, 1219.2), uniform(-609.6, 609.6)}; }
};

EquilibriumParameters classic(Feed feed = Feed::over_top) {
  Machine machine;
  machine.feed = feed;
  return equilibrium_parameters(machine);
}

// Emscripten's C library evaluates long doubles with the functions of doubles: no reference values are
// available there.
#ifdef __EMSCRIPTEN__
constexpr bool kHasLongFunctions = false;
#else
constexpr bool kHasLongFunctions = true;
#endif

/// Irvine's own form in extended precision; in double it would lose the digits that the stable form
/// keeps.
struct Extent {
  long double u, y;
};
Extent irvine(long double h, long double v, long double s, long double w, long double c) {
  const long double vb = v + w * s;
  return {h / w * (std::asinh(vb / h) - std::asinh(v / h)) + c * h * s,
          (std::hypot(h, vb) - std::hypot(h, v)) / w + c * (v * s + w * s * s / 2)};
}

TEST(Catenary, IsIrvinesInAFormWithoutCancellation) {
  if (!kHasLongFunctions) GTEST_SKIP() << "this library computes asinh of long doubles in double";
  Random random(kLawSeed);
  for (int n = 0; n < 2000; ++n) {
    const double h = random.logarithmic(0.3, 3000.0), s = random.uniform(100.0, 4000.0);
    const double v = random.uniform(-5.0, 200.0);
    const ChainMaterial chain{random.logarithmic(1e-5, 1e-2), random.logarithmic(1e-8, 1e-4)};
    SCOPED_TRACE(testing::Message()
                 << "seed " << kLawSeed << ": H " << h << " V " << v << " S " << s << " w "
                 << chain.weight_n_per_mm << " c " << chain.compliance_per_n);
    const CatenaryExtent e = catenary_extent({h, v, s}, chain);
    const Extent exact = irvine(h, v, s, chain.weight_n_per_mm, chain.compliance_per_n);
    // 64-bit mantissa divided by w: 1e-19 * T / w, at most 1e-19 * 3000 / 1e-5, and double's own
    // rounding of s.
    const double tolerance = 4e-16 * s + 2e-19 * (h + std::abs(v) + 40.0) / chain.weight_n_per_mm;
    EXPECT_NEAR(e.u_mm, static_cast<double>(exact.u), 4.0 * tolerance);
    EXPECT_NEAR(e.y_mm, static_cast<double>(exact.y), 4.0 * tolerance);
  }
}

TEST(Catenary, ArcAndChordOfTheInextensibleChain) {
  // sqrt(S^2 - y^2) = 2 a sinh(u / 2 a), a = H / w: the chord's relation of the common catenary.
  Random random(kLawSeed + 1);
  for (int n = 0; n < 1000; ++n) {
    const double h = random.logarithmic(1.0, 300.0), s = random.uniform(500.0, 3500.0);
    const double w = random.logarithmic(3e-4, 1e-2), a = h / w;
    const CatenaryExtent e = catenary_extent({h, random.uniform(-10.0, 150.0), s}, {w, 0.0});
    SCOPED_TRACE(testing::Message() << "seed " << kLawSeed + 1 << " draw " << n);
    // Relative rounding of a square root of a difference: s / u of an ulp.
    EXPECT_NEAR(std::sqrt((s - e.y_mm) * (s + e.y_mm)),
                2.0 * a * std::sinh(e.u_mm / (2.0 * a)),
                1e-14 * s * s / e.u_mm);
  }
}

TEST(Catenary, FlexibilityIsSymmetricPositiveDefiniteAndTheDerivative) {
  Random random(kLawSeed + 2);
  for (int n = 0; n < 500; ++n) {
    const double h = random.logarithmic(0.5, 500.0), s = random.uniform(100.0, 4000.0);
    const double v = random.uniform(-4.0, 150.0);
    const ChainMaterial chain{random.logarithmic(1e-4, 1e-2), random.logarithmic(1e-7, 1e-4)};
    SCOPED_TRACE(testing::Message() << "seed " << kLawSeed + 2 << " draw " << n);
    const CatenaryExtent e = catenary_extent({h, v, s}, chain);
    EXPECT_GT(e.u_by_h, 0.0);
    EXPECT_GT(e.y_by_v, 0.0);
    EXPECT_GT(e.u_by_h * e.y_by_v - e.u_by_v * e.u_by_v, 0.0);
    const auto at = [&](long double dh, long double dv) {
      return irvine(h + dh, v + dv, s, chain.weight_n_per_mm, chain.compliance_per_n);
    };
    const long double step = 1e-4L * h;
    const auto slope = [step](long double up, long double down) {
      return static_cast<double>((up - down) / (2 * step));
    };
    // h^2 of the difference, 1e-8 of the curvature, which is of the order of the entry itself.
    const double tolerance = 2e-7 * (e.u_by_h + e.y_by_v);
    EXPECT_NEAR(e.u_by_h, slope(at(step, 0).u, at(-step, 0).u), tolerance);
    EXPECT_NEAR(e.u_by_v, slope(at(0, step).u, at(0, -step).u), tolerance);
    EXPECT_NEAR(e.u_by_v, slope(at(step, 0).y, at(-step, 0).y), tolerance);
    EXPECT_NEAR(e.y_by_v, slope(at(0, step).y, at(0, -step).y), tolerance);
  }
}

TEST(Catenary, PointsAlongTheChainAreItsPartialChains) {
  const CatenaryLoad load{60.0, 40.0, 1800.0};
  const ChainMaterial chain{1.3e-3, 5.2e-6};
  const CatenaryExtent whole = catenary_extent(load, chain);
  const CatenaryPoint end = catenary_point(load, chain, load.length_mm);
  EXPECT_DOUBLE_EQ(end.u_mm, whole.u_mm);
  EXPECT_DOUBLE_EQ(end.y_mm, whole.y_mm);
  EXPECT_DOUBLE_EQ(end.tension_n, whole.tb_n);
  // The drawn curve's length by the chords of 20000 pieces: short by (length / pieces)^2 / (24
  // radius^2) of itself.
  constexpr int kPieces = 20000;
  double length = 0.0;
  CatenaryPoint before = catenary_point(load, chain, 0.0);
  EXPECT_EQ(before.u_mm, 0.0);
  for (int i = 1; i <= kPieces; ++i) {
    const CatenaryPoint now = catenary_point(load, chain, load.length_mm * i / kPieces);
    length += std::hypot(now.u_mm - before.u_mm, now.y_mm - before.y_mm);
    before = now;
  }
  EXPECT_NEAR(length, end.stretched_length_mm, 1e-9);
}

TEST(Pose, BalancesInIrvinesForm) {
  if (!kHasLongFunctions) GTEST_SKIP() << "this library computes asinh of long doubles in double";
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    const EquilibriumParameters m = classic(feed);
    const auto kinematics = make_kinematics(m);
    const double sg = feed == Feed::over_top ? 1.0 : -1.0,
                 rho = std::get<Ring>(m.attachment).radius_mm;
    Random random(kLawSeed + 3);
    for (int n = 0; n < 200; ++n) {
      const BedPoint p = random.bed();
      SCOPED_TRACE(testing::Message()
                   << "seed " << kLawSeed + 3 << " (" << p.x_mm << ", " << p.y_mm << ")");
      const Pose pose = kinematics->inverse(p).value();
      for (const Side side : kSides) {
        const ChainState& c = pose.chains[side];
        const Extent e = irvine(c.horizontal_n,
                                c.vertical_at_sled_n,
                                c.free_length_mm,
                                m.chain_weight_n_per_mm,
                                m.chain_compliance_per_n);
        const double along =
            side == Side::left ? p.x_mm - m.motors.left.x_mm : m.motors.right.x_mm - p.x_mm;
        const double up = m.motors[side].y_mm - p.y_mm;
        const double r = m.sprocket_radius_mm;
        // Rounding of H, V and S in the pose, magnified by the chain's flexibility: a few ulp of
        // 3000 mm.
        constexpr double kTolerance = 1e-11;
        EXPECT_NEAR(static_cast<double>(e.u) + rho * c.horizontal_n / c.tension_at_sled_n +
                        sg * r * std::sin(c.angle_rad),
                    along,
                    kTolerance);
        EXPECT_NEAR(static_cast<double>(e.y) + rho * c.vertical_at_sled_n / c.tension_at_sled_n -
                        sg * r * std::cos(c.angle_rad),
                    up,
                    kTolerance);
      }
      EXPECT_NEAR(pose.chains.left.vertical_at_sled_n + pose.chains.right.vertical_at_sled_n,
                  m.sled_weight_n,
                  1e-13);
      EXPECT_EQ(pose.chains.left.horizontal_n, pose.chains.right.horizontal_n);
    }
  }
}

// The work of letting out a millimetre of chain equals the tension there: the total energy (sled,
// chains, strain) as a function of the two lengths has the derivative
//   dU/dL = (w yP - Tb - c Tb^2/2)_L - sum_i (w yP - c Tb^2/2)_i sg r dphi_i/dL,  yP the tangent
//   point's height.
TEST(Pose, EnergyIdentity) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    const EquilibriumParameters m = classic(feed);
    const auto kinematics = make_kinematics(m);
    const double sg = feed == Feed::over_top ? 1.0 : -1.0,
                 rho = std::get<Ring>(m.attachment).radius_mm;
    const double r = m.sprocket_radius_mm, w = m.chain_weight_n_per_mm,
                 c = m.chain_compliance_per_n;
    struct Seen {
      double energy;
      PerSide<double> phi, work;
    };
    const auto see = [&](double left, double right) {
      const Pose pose = kinematics->forward({left, right}).value();
      Seen found{m.sled_weight_n * pose.position.y_mm, {}, {}};
      for (const Side side : kSides) {
        const ChainState& chain = pose.chains[side];
        const CatenaryLoad load{chain.horizontal_n, chain.vertical_at_sled_n, chain.free_length_mm};
        const double end =
            pose.position.y_mm + rho * chain.vertical_at_sled_n / chain.tension_at_sled_n;
        found.energy += w * chain.free_length_mm * end + catenary_weight_energy(load, {w, c}) +
                       catenary_strain_energy(load, {w, c});
        found.phi[side] = chain.angle_rad;
        const double tb = chain.tension_at_sprocket_n;
        found.work[side] =
            w * (m.motors[side].y_mm + sg * r * std::cos(chain.angle_rad)) - 0.5 * c * tb * tb;
      }
      return found;
    };
    Random random(kLawSeed + 4);
    for (int n = 0; n < 40; ++n) {
      const BedPoint p = random.bed();
      SCOPED_TRACE(testing::Message()
                   << "seed " << kLawSeed + 4 << " (" << p.x_mm << ", " << p.y_mm << ")");
      const Pose pose = kinematics->inverse(p).value();
      const double left = pose.lengths.left_mm, right = pose.lengths.right_mm;
      const auto derivative = [&](auto&& of) {
        const auto central = [&](double h) {
          return (of(see(left + h, right)) - of(see(left - h, right))) / (2.0 * h);
        };
        return (4.0 * central(2.0) - central(4.0)) / 3.0;
      };
      const Seen here = see(left, right);
      double expected = here.work.left - pose.chains.left.tension_at_sprocket_n;
      for (const Side side : kSides) {
        expected -=
            here.work[side] * sg * r * derivative([side](const Seen& s) { return s.phi[side]; });
      }
      // h^4 of the difference; energies of 1e5 N mm rounded to 1e-11 over 4 mm.
      EXPECT_NEAR(derivative([](const Seen& s) { return s.energy; }),
                  expected,
                  2e-8 * pose.chains.left.tension_at_sprocket_n);
    }
  }
}

TEST(Pose, WeightlessLimitIsTheStraightTangent) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    const auto wrap = make_kinematics(classic(feed), Model::wrap);
    for (const double share : {0.0, 1e-4, 1e-2}) {
      EquilibriumParameters light = classic(feed);
      light.chain_weight_n_per_mm *= share;
      light.chain_compliance_per_n = 0.0;
      const auto kinematics = make_kinematics(light);
      Random random(kLawSeed + 5);
      for (int n = 0; n < 60; ++n) {
        const BedPoint p = random.bed();
        SCOPED_TRACE(testing::Message()
                     << "seed " << kLawSeed + 5 << " (" << p.x_mm << ", " << p.y_mm << ")");
        const ChainLengths a = kinematics->inverse(p)->lengths, b = wrap->inverse(p)->lengths;
        // Sag is proportional to the square of the weight, 4.9 mm at most for the whole chain;
        // 5e-12 is rounding.
        const double most = 4.9 * share * share * 1.1 + 5e-12;
        EXPECT_NEAR(a.left_mm, b.left_mm, most);
        EXPECT_NEAR(a.right_mm, b.right_mm, most);
      }
    }
  }
}

TEST(Pose, SprocketWithoutRadiusIsThePoint) {
  EquilibriumParameters point = classic();
  point.sprocket_radius_mm = 0.0;
  EquilibriumParameters tiny = point;
  tiny.sprocket_radius_mm = 1e-7;
  Random random(kLawSeed + 6);
  for (int n = 0; n < 60; ++n) {
    const BedPoint p = random.bed();
    SCOPED_TRACE(testing::Message()
                 << "seed " << kLawSeed + 6 << " (" << p.x_mm << ", " << p.y_mm << ")");
    const ChainLengths straight = make_kinematics(classic(), Model::straight)->inverse(p)->lengths;
    const ChainLengths wrap = make_kinematics(point, Model::wrap)->inverse(p)->lengths;
    EXPECT_NEAR(straight.left_mm, wrap.left_mm, 1e-12);  // rounding of one length
    EXPECT_NEAR(straight.right_mm, wrap.right_mm, 1e-12);
    const ChainLengths a = make_kinematics(point)->inverse(p)->lengths;
    const ChainLengths b = make_kinematics(tiny)->inverse(p)->lengths;
    EXPECT_NEAR(a.left_mm, b.left_mm, 2e-7);  // at most pi/2 of wrap and one radius of offset
    EXPECT_NEAR(a.right_mm, b.right_mm, 2e-7);
  }
}

TEST(Pose, InextensibleChainsDependOnNeitherGravityNorTilt) {
  Machine machine;
  const auto upright = make_kinematics(equilibrium_parameters(machine), Model::inextensible);
  machine.frame.tilt_from_vertical_deg = 40.0;
  const auto leaning = make_kinematics(equilibrium_parameters(machine), Model::inextensible);
  Random random(kLawSeed + 7);
  for (int n = 0; n < 60; ++n) {
    const BedPoint p = random.bed();
    SCOPED_TRACE(testing::Message()
                 << "seed " << kLawSeed + 7 << " (" << p.x_mm << ", " << p.y_mm << ")");
    EXPECT_NEAR(upright->inverse(p)->lengths.left_mm,
                leaning->inverse(p)->lengths.left_mm,
                5e-12);  // rounding
  }
}

TEST(Pose, UprightFrameHasNoThirdDimension) {
  Machine machine;
  machine.frame.tilt_from_vertical_deg = 0.0;
  for (const Attachment& attachment : {Attachment{Ring{}}, Attachment{Brackets{}}}) {
    machine.attachment = attachment;
    const auto plane = make_kinematics(equilibrium_parameters(machine), Model::elastic);
    const auto space = make_kinematics(equilibrium_parameters(machine), Model::elastic_3d);
    Random random(kLawSeed + 8);
    for (int n = 0; n < 60; ++n) {
      const BedPoint p = random.bed();
      SCOPED_TRACE(testing::Message()
                   << "seed " << kLawSeed + 8 << " (" << p.x_mm << ", " << p.y_mm << ")");
      EXPECT_NEAR(plane->inverse(p)->lengths.left_mm,
                  space->inverse(p)->lengths.left_mm,
                  5e-12);  // rounding
      EXPECT_NEAR(plane->inverse(p)->lengths.right_mm, space->inverse(p)->lengths.right_mm, 5e-12);
    }
  }
}

TEST(Pose, HeavierChainsAreLongerAndSofterOnesShorter) {
  const auto kinematics = make_kinematics(classic());
  Random random(kLawSeed + 9);
  for (int n = 0; n < 200; ++n) {
    const BedPoint p = random.bed();
    SCOPED_TRACE(testing::Message()
                 << "seed " << kLawSeed + 9 << " (" << p.x_mm << ", " << p.y_mm << ")");
    const Pose pose = kinematics->inverse(p).value();
    const auto chains = kinematics->by_parameter(pose, Parameter::chain_compliance_per_n);
    for (const Side side : kSides) EXPECT_LT(chains[side].length_mm.d[0], 0.0);
  }
  const auto inextensible = make_kinematics(classic(), Model::inextensible);
  for (int n = 0; n < 200; ++n) {
    const BedPoint p = random.bed();
    const Pose pose = inextensible->inverse(p).value();
    const auto chains = inextensible->by_parameter(pose, Parameter::chain_weight_n_per_mm);
    for (const Side side : kSides) EXPECT_GT(chains[side].length_mm.d[0], 0.0);
  }
}

// Every point 30 mm or more from the verticals and the beam has a pose, for sleds down to 2 % of
// the mass, and forward is its inverse.
TEST(Pose, NoFailureInsideTheDomain) {
  int poses = 0, most_iterations = 0;
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    for (const double mass_share : {1.0, 0.1, 0.02}) {
      for (const bool elastic : {true, false}) {
        Machine machine;
        machine.feed = feed;
        machine.sled.mass_kg *= mass_share;
        const EquilibriumParameters m = equilibrium_parameters(machine);
        const auto kinematics = make_kinematics(m, elastic ? Model::elastic : Model::inextensible);
        const double edge = 1489.2 - m.sprocket_radius_mm - 30.0;
        // Off the bottom the beam line is the lower tangent of the sprockets.
        const double top = 1072.6 - 30.0 - (feed == Feed::off_bottom ? m.sprocket_radius_mm : 0.0);
        for (int ix = 0; ix <= 60; ++ix) {
          for (int iy = 0; iy <= 60; ++iy) {
            const BedPoint p{edge * (ix - 30) / 30.0,
                             top - (top + 4000.0) * (iy / 60.0) * (iy / 60.0)};
            const PoseResult pose = kinematics->inverse(p);
            if (!pose && pose.error() == PoseReason::link_does_not_fit)
              continue;  // the ring would reach past
            SCOPED_TRACE(testing::Message()
                         << "mass share " << mass_share << (elastic ? " elastic" : " stiff") << " ("
                         << p.x_mm << ", " << p.y_mm << ")");
            ASSERT_TRUE(pose) << pose.error().sentence();
            ++poses;
            most_iterations = std::max(most_iterations, pose->iterations);
            const PoseResult back = kinematics->forward(pose->lengths);
            ASSERT_TRUE(back) << back.error().sentence();
            // Amplified rounding of a length: by 1e4 near the verticals for a sled that weighs less
            // than its chains.
            const double tolerance = mass_share == 1.0 ? 1e-9 : 1e-8;
            ASSERT_LE(std::hypot(back->position.x_mm - p.x_mm, back->position.y_mm - p.y_mm),
                      tolerance);
          }
        }
      }
    }
  }
  EXPECT_GT(poses, 43000);
  EXPECT_LE(most_iterations, 8);
}

}  // namespace
}  // namespace chaintrue::model

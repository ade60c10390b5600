// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of the heavy elastic chain and of the pose with two of them, each checked by a formula that
// the solver does not use.
#include <gmock/gmock.h>

#include <cmath>

#include "model/kinematics.hpp"
#include "tests/model/oracle/catenary_shape.hpp"
#include "tests/support/over_the_bed.hpp"

namespace chaintrue::model {
namespace {

using testing_support::over_the_bed;

constexpr std::uint64_t kLawSeed = 4711;

class Random : public testing_support::Random {
 public:
  using testing_support::Random::Random;
  double logarithmic(double from, double to) {
    return std::exp(uniform(std::log(from), std::log(to)));
  }
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
    EXPECT_NEAR(std::sqrt((s - e.y_mm) * (s + e.y_mm)), 2.0 * a * std::sinh(e.u_mm / (2.0 * a)),
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
    over_the_bed(kLawSeed + 4, 40, [&](BedPoint p) {
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
      EXPECT_NEAR(derivative([](const Seen& s) { return s.energy; }), expected,
                  2e-8 * pose.chains.left.tension_at_sprocket_n);
    });
  }
}

using KinematicsPtr = std::unique_ptr<const Kinematics>;

/// Lengths that differ by no more than `most_mm`.
void expect_same_lengths(const KinematicsPtr& one, const KinematicsPtr& other, double most_mm) {
  over_the_bed(kLawSeed + 5, 60, [&](BedPoint p) {
    const ChainLengths a = one->inverse(p)->lengths, b = other->inverse(p)->lengths;
    EXPECT_NEAR(a.left_mm, b.left_mm, most_mm);
    EXPECT_NEAR(a.right_mm, b.right_mm, most_mm);
  });
}

constexpr double kRoundingMm = 5e-12;

TEST(Pose, WeightlessLimitIsTheStraightTangent) {
  for (const Feed feed : {Feed::over_top, Feed::off_bottom}) {
    for (const double share : {0.0, 1e-4, 1e-2}) {
      SCOPED_TRACE(share);
      EquilibriumParameters light = classic(feed);
      light.chain_weight_n_per_mm *= share;
      light.chain_compliance_per_n = 0.0;
      // Sag is proportional to the square of the weight, 4.9 mm at most for the whole chain.
      expect_same_lengths(make_kinematics(light), make_kinematics(classic(feed), Model::wrap),
                          4.9 * share * share * 1.1 + kRoundingMm);
    }
  }
}

TEST(Pose, SprocketWithoutRadiusIsThePoint) {
  EquilibriumParameters point = classic();
  point.sprocket_radius_mm = 0.0;
  EquilibriumParameters tiny = point;
  tiny.sprocket_radius_mm = 1e-7;
  // Rounding of one length.
  expect_same_lengths(make_kinematics(classic(), Model::straight),
                      make_kinematics(point, Model::wrap), 1e-12);
  // At most pi/2 of wrap and one radius of offset.
  expect_same_lengths(make_kinematics(point), make_kinematics(tiny), 2e-7);
}

TEST(Pose, InextensibleChainsDependOnNeitherGravityNorTilt) {
  Machine leaning;
  leaning.frame.tilt_from_vertical_deg = 40.0;
  expect_same_lengths(make_kinematics(classic(), Model::inextensible),
                      make_kinematics(equilibrium_parameters(leaning), Model::inextensible),
                      kRoundingMm);
}

TEST(Pose, UprightFrameHasNoThirdDimension) {
  Machine machine;
  machine.frame.tilt_from_vertical_deg = 0.0;
  for (const Attachment& attachment : {Attachment{Ring{}}, Attachment{Brackets{}}}) {
    machine.attachment = attachment;
    const EquilibriumParameters upright = equilibrium_parameters(machine);
    expect_same_lengths(make_kinematics(upright, Model::elastic),
                        make_kinematics(upright, Model::elastic_3d), kRoundingMm);
  }
}

TEST(Pose, HeavierChainsAreLongerAndSofterOnesShorter) {
  const auto kinematics = make_kinematics(classic());
  const auto inextensible = make_kinematics(classic(), Model::inextensible);
  over_the_bed(kLawSeed + 9, 200, [&](BedPoint p) {
    const auto by = [p](const Kinematics& own, Parameter parameter, Side side) {
      return own.by_parameter(own.inverse(p).value(), parameter)[side].length_mm.d[0];
    };
    for (const Side side : kSides) {
      EXPECT_LT(by(*kinematics, Parameter::chain_compliance_per_n, side), 0.0);
      EXPECT_GT(by(*inextensible, Parameter::chain_weight_n_per_mm, side), 0.0);
    }
  });
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

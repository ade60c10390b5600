// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The strength of a cause given a smooth field, compared with cases that need no field, and the
/// fitted field with the drawn one.
#include "planted/judge/smooth_field.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "generator/hidden/session.hpp"

namespace chaintrue::planted {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::NoiseLevel;
using generator::TrueMachine;
using generator::Where;

constexpr SmoothField kNone{100.0, 0.0, 0.0, 0.0, 1.0};

/// 28 marks of the classic machine, read without an error.
std::vector<ReadMark> exact_marks() {
  generator::Dice dice(1, "marks");
  generator::Layout layout = generator::layout_of(28);
  layout.repeats = 0;
  std::vector<generator::Visit> visits;
  for (const auto& planned : generator::plan_visits(layout, generator::Order::rows, dice)) {
    visits.push_back({planned.place, static_cast<int>(visits.size())});
  }
  TrueMachine machine;
  machine.wheel = generator::WheelShape::round;
  const auto at_rest = generator::rests(machine, visits);
  const auto lengths = generator::readings(machine, {}, visits, *at_rest);
  std::vector<ReadMark> marks;
  for (std::size_t i = 0; i < visits.size(); ++i) marks.push_back({visits[i].place, lengths[i]});
  return marks;
}

generator::Signature signature_of(const CalibratedSession& session, const Hidden& hidden) {
  const Hidden one[] = {hidden};
  return *session.yardstick.signature(one);
}

const Hidden kEccentric{Cause::sprocket_eccentricity, Where::left, 0.4, 1.0};

TEST(SmoothField, TreatsWhiteFieldsAsNoise) {
  // A field that changes within a millimetre is another error of each reading.
  constexpr double kFieldMm = 0.5;
  const NoiseLevel small{0.1, 0.3}, large{std::hypot(0.1, kFieldMm), 0.3};
  const CalibratedSession session = calibrate({}, exact_marks(), small);
  const CalibratedSession noisier = calibrate({}, exact_marks(), large);
  const double with_field = strength_given({1.0, kFieldMm, kFieldMm, 0.0, 1.0}, session,
                                           signature_of(session, kEccentric));
  const double with_noise = strength_given(kNone, noisier, signature_of(noisier, kEccentric));
  // The two sessions are calibrated separately, to a thousandth of a millimetre.
  EXPECT_NEAR(with_field, with_noise, 1e-4 * with_noise);
  EXPECT_LT(with_field, 0.7 * strength_given(kNone, session, signature_of(session, kEccentric)));
}

TEST(SmoothField, ExcludesSettingsAndSheet) {
  const CalibratedSession session = calibrate({}, exact_marks(), {});
  for (Eigen::Index k = 0; k < session.free.cols(); ++k) {
    const Eigen::VectorXd own = session.free.col(k);
    // Rounding of a projection, of a column of that length.
    EXPECT_LT(strength_given(kNone, session, own), 1e-6 * own.norm()) << k;
  }
}

TEST(Calibrate, FindsSettingsAndSheet) {
  TrueMachine stated;
  stated.axis[0].x += 2.0;
  std::vector<ReadMark> marks = exact_marks();
  for (ReadMark& m : marks) m.mark = {m.mark.x + 10.0, m.mark.y - 6.0};
  const CalibratedSession session = calibrate(stated, marks, {});
  const generator::Vec2 first = session.on_bed(marks.front().mark);
  // Settings stated 2 mm off pull the result by a part that 28 marks outweigh.
  EXPECT_NEAR(first.x, marks.front().mark.x - 10.0, 1.0);
  EXPECT_NEAR(first.y, marks.front().mark.y + 6.0, 1.0);
  EXPECT_LT(session.residual.norm(), 1.5);
}

}  // namespace
}  // namespace chaintrue::planted

// SPDX-License-Identifier: GPL-3.0-or-later
// The machine's own fit, used for comparison: exact spans give back their frame.
#include "sealed/judge/firmware_anchors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace chaintrue::sealed::firmware {
namespace {

constexpr double kAnchors[4][2] = {{-27.6, 2064.9}, {2924.3, 2066.5}, {0.0, 0.0}, {2953.2, 0.0}};

/// Five by four places over the middle of the frame.
std::vector<Spans> exact_spans() {
  std::vector<Spans> spans;
  for (const double x : {700.0, 1100.0, 1500.0, 1900.0, 2300.0}) {
    for (const double y : {500.0, 850.0, 1200.0, 1550.0}) {
      Spans& own = spans.emplace_back();
      for (std::size_t j = 0; j < 4; ++j)
        own[j] = std::hypot(x - kAnchors[j][0], y - kAnchors[j][1]);
    }
  }
  return spans;
}

TEST(FirmwareAnchors, ExactSpansGiveTheFrameBack) {
  const FirmwareAnchors found = firmware_anchors(exact_spans());
  ASSERT_TRUE(found.converged);
  // The tolerance of Levenberg-Marquardt: a millionth of the sum of squares.
  constexpr double kConvergedMm = 1e-3;
  for (std::size_t j = 0; j < 4; ++j) {
    EXPECT_NEAR(found.anchors[j][0], kAnchors[j][0], kConvergedMm);
    EXPECT_NEAR(found.anchors[j][1], kAnchors[j][1], kConvergedMm);
  }
  for (const double off : lower_off_mm(found, exact_spans())) EXPECT_NEAR(off, 0.0, kConvergedMm);
}

}  // namespace
}  // namespace chaintrue::sealed::firmware

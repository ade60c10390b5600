// SPDX-License-Identifier: GPL-3.0-or-later
// Why a machine cannot hold the tool is part of the message about the line.
#include <gmock/gmock.h>

#include "grid/map/compensation_map.hpp"
#include "model/reading_model.hpp"
#include "tests/gcode/stub_map.hpp"
#include "tools/gcode/reports.hpp"

namespace chaintrue::gcode {
namespace {

using model::PoseFailure;
using model::PoseReason;
using ::testing::HasSubstr;

/// A machine without any reachable position.
class NoPose final : public StubMap {
 public:
  explicit NoPose(PoseReason why)
      : StubMap({-1000.0, 1000.0, -500.0, 500.0}),
        failure_(grid::unreachable(model::mechanism_failure(why))) {}
  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint) const override {
    return tl::unexpected(failure_);
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths) const override {
    return tl::unexpected(failure_);
  }

 private:
  grid::MapFailure failure_;
};

TEST(FailureWords, TheMessageAboutALineNamesTheCause) {
  const NoPose map(PoseReason::slack);
  LineSource source = LineSource::from_text("G21 G90\nG1 X10 Y20 F500\n");
  Findings findings;
  ASSERT_TRUE(path_lengths(
      source, {}, map, 50.0, [](const PathLengths&) {}, findings));
  ASSERT_FALSE(findings.problems.empty());
  EXPECT_THAT(findings.problems.front().message(),
              HasSubstr(PoseFailure(PoseReason::slack).sentence()));
}

}  // namespace
}  // namespace chaintrue::gcode

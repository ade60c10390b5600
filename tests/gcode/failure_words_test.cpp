// SPDX-License-Identifier: GPL-3.0-or-later
// Why a machine cannot hold the tool is part of the message about the line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "grid/map/compensation_map.hpp"
#include "model/chains/chain_mechanism.hpp"
#include "tools/gcode/corrector.hpp"
#include "tools/gcode/path_lengths.hpp"

namespace chaintrue::gcode {
namespace {

using model::PoseFailure;
using model::PoseReason;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr PoseReason kPoseReasons[] = {PoseReason::outside_verticals,
                                       PoseReason::above_sprockets,
                                       PoseReason::link_does_not_fit,
                                       PoseReason::slack,
                                       PoseReason::too_short,
                                       PoseReason::not_converged};

/// A machine that can hold the tool nowhere.
class NoPose final : public grid::LengthMap {
 public:
  explicit NoPose(PoseReason why) : failure_(grid::unreachable(model::mechanism_failure(why))) {}
  [[nodiscard]] tl::expected<model::ChainLengths, grid::MapFailure> lengths(
      model::BedPoint) const override {
    return tl::unexpected(failure_);
  }
  [[nodiscard]] tl::expected<grid::LengthsAnswer, grid::MapFailure> query(
      model::BedPoint) const override {
    return tl::unexpected(failure_);
  }
  [[nodiscard]] grid::MapStatus status(model::BedPoint) const override {
    return grid::MapStatus::inside;
  }
  [[nodiscard]] tl::expected<model::BedPoint, grid::MapFailure> tool(
      model::ChainLengths) const override {
    return tl::unexpected(failure_);
  }
  [[nodiscard]] std::span<const std::string_view> length_names() const override { return {}; }
  [[nodiscard]] const interp::Rectangle& domain() const override { return domain_; }

 private:
  interp::Rectangle domain_{-1000.0, 1000.0, -500.0, 500.0};
  grid::MapFailure failure_;
};

/// A controller without any lengths.
class NoCommand final : public model::ControllerKinematics {
 public:
  explicit NoCommand(PoseReason why) : why_(why) {}
  [[nodiscard]] tl::expected<model::ChainLengths, PoseFailure> lengths(
      model::BedPoint) const override {
    return tl::unexpected(why_);
  }
  [[nodiscard]] tl::expected<model::BedPoint, PoseFailure> command(
      model::ChainLengths) const override {
    return tl::unexpected(why_);
  }

 private:
  PoseReason why_;
};

TEST(FailureWords, APosesOwnCauseEndsTheSentence) {
  for (const PoseReason why : kPoseReasons) {
    const std::string cause = PoseFailure(why).sentence();
    const grid::MapFailure nowhere = grid::unreachable(model::mechanism_failure(why));
    const CorrectionFailure pose = correction_failure(nowhere);
    EXPECT_EQ(pose.sentence(), "cannot be reached by the machine: " + cause);
    EXPECT_THAT(nowhere.sentence(), EndsWith(": " + cause));
    const NoCommand controller(why);
    const NoPose map(why);
    const Corrector corrector(map, controller, firmware(model::ControllerKind::ideal));
    EXPECT_EQ(corrector.command({0.0, 0.0}).error(), pose);
    EXPECT_EQ(corrector.tool({0.0, 0.0}).error().sentence(),
              "cannot be reached by the controller's own kinematics: " + cause);
  }
}

TEST(FailureWords, EveryReasonHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (const CorrectionReason reason : {CorrectionReason::outside_map,
                                        CorrectionReason::unreachable,
                                        CorrectionReason::not_converged,
                                        CorrectionReason::controller})
    words.insert(CorrectionFailure(reason).sentence());
  EXPECT_EQ(words.size(), 4u);
}

TEST(FailureWords, TheMessageAboutALineNamesTheCause) {
  const NoPose map(PoseReason::slack);
  LineSource source = LineSource::from_text("G21 G90\nG1 X10 Y20 F500\n");
  Findings findings;
  ASSERT_TRUE(path_lengths(
      source, {}, map, {}, 50.0, [](const PathLengths&) {}, findings));
  ASSERT_FALSE(findings.problems.empty());
  EXPECT_THAT(findings.problems.front().message(),
              HasSubstr(PoseFailure(PoseReason::slack).sentence()));
}

}  // namespace
}  // namespace chaintrue::gcode

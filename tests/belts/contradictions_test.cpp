// SPDX-License-Identifier: GPL-3.0-or-later
// What contradicts the places that were commanded, the anchors in force or a tape is named in a sentence,
// and no anchors are written that could be pasted.
#include <gmock/gmock.h>

#include "grid/belts/belt_checks.hpp"
#include "grid/files/belts_file.hpp"
#include "tests/belts/simulated_belts.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using grid::MeasuredBelts;
using model::Belt;
using testing::AllOf;
using testing::HasSubstr;
using testing_support::Outcome;

/// Places sent to by the anchors in force, which are 20 mm off.
MeasuredBelts sent(std::uint64_t seed, bool anchors_known) {
  grid::SimulatedBelts set = grid::simulate({.seed = seed, .columns = 6, .rows = 5});
  const model::FramePoint centre = model::centre_of(set.belts.machine);
  for (std::size_t k = 0; k < set.places.size(); ++k) {
    set.belts.points[k].commanded =
        model::BedPoint{set.places[k].x_mm - centre.x_mm, set.places[k].y_mm - centre.y_mm};
  }
  if (!anchors_known) {
    set.belts.machine = model::BeltMachine{};
    set.belts.machine.anchors_known = false;
  }
  return set.belts;
}

MeasuredBelts swapped(MeasuredBelts belts, const std::vector<grid::BeltPair>& pairs) {
  for (grid::BeltPoint& point : belts.points) {
    for (const auto& [a, b] : pairs) std::swap(point.lengths_mm[a], point.lengths_mm[b]);
  }
  return belts;
}

class Contradictions : public testing_support::CommandFixture {
 protected:
  /// Refused by fit and by diagnose with these words, and nothing is written.
  void expect_named(const MeasuredBelts& belts, const testing::Matcher<std::string>& words) const {
    write("belts.json", grid::files::write_belts(belts));
    for (const char* line :
         {"fit belts.json -o anchors.json", "diagnose belts.json -o anchors.json"}) {
      const Outcome answer = run(line);
      EXPECT_EQ(answer.code, 3) << line << "\n" << answer.err;
      EXPECT_THAT(answer.err, words) << line;
      EXPECT_FALSE(exists("anchors.json")) << line;
    }
  }
};

TEST_F(Contradictions, BeltsExchangedAgainstTheCommandsAreNamed) {
  for (const bool known : {false, true}) {
    SCOPED_TRACE(known ? "anchors in force" : "commands alone");
    const MeasuredBelts belts = sent(3, known);
    expect_named(swapped(belts, {{Belt::tl, Belt::tr}, {Belt::bl, Belt::br}}),
                 HasSubstr("tl and tr swapped and bl and br as well"));
    expect_named(swapped(belts, {{Belt::tl, Belt::bl}, {Belt::tr, Belt::br}}),
                 HasSubstr("tl and bl swapped and tr and br as well"));
    expect_named(swapped(belts, {{Belt::tl, Belt::bl}}), HasSubstr("tl and bl swapped"));
  }
}

TEST_F(Contradictions, AMirroredFrameIsNamed) {
  MeasuredBelts belts = sent(4, false);
  for (grid::BeltPoint& point : belts.points) point.commanded->x_mm = -point.commanded->x_mm;
  expect_named(belts, AllOf(HasSubstr("tl and tr swapped"), HasSubstr("mirror image")));
}

TEST_F(Contradictions, SettingsOfAnotherFrameAreNamed) {
  for (const bool commanded : {false, true}) {
    MeasuredBelts belts = sent(5, true);
    if (!commanded) {
      for (grid::BeltPoint& point : belts.points) point.commanded.reset();
    }
    belts.machine.anchors.tr.x_mm += 675.0;
    belts.machine.anchors.br.x_mm += 675.0;
    belts.machine.anchors.tl.y_mm -= 684.0;
    belts.machine.anchors.tr.y_mm -= 684.0;
    expect_named(belts, HasSubstr("settings of another frame"));
  }
  // Where the commands contradict as well, less is enough.
  MeasuredBelts belts = sent(6, true);
  belts.machine.anchors.tr.x_mm += 280.0;
  belts.machine.anchors.br.x_mm += 280.0;
  expect_named(
      belts,
      AllOf(HasSubstr("settings of another frame"), HasSubstr("where the machine was sent")));
  // A frame taped to a decimetre is no other frame.
  belts = sent(6, true);
  belts.machine.anchors.tr.x_mm += 100.0;
  write("belts.json", grid::files::write_belts(belts));
  EXPECT_EQ(run("fit belts.json -o fine.json --force").code, 0);
}

TEST_F(Contradictions, AWrongTapeIsNamed) {
  const grid::SimulatedBelts set = grid::simulate({.seed = 7});
  const auto& a = set.truth.anchors;
  const double diagonal_mm = std::hypot(a.tl.x_mm - a.br.x_mm, a.tl.y_mm);
  const auto taped = [&](double mm) {
    MeasuredBelts belts = set.belts;
    belts.distances.push_back({Belt::tl, Belt::br, mm, 1.0});
    return belts;
  };
  expect_named(taped(2.0 * diagonal_mm), HasSubstr("taped twice over"));
  expect_named(taped(0.5 * diagonal_mm), HasSubstr("only half of it taped"));
  expect_named(taped(diagonal_mm / 25.4), HasSubstr("inches"));
  expect_named(taped(diagonal_mm + 100.0), HasSubstr("held at its 100 mm mark"));
  // A scale that belts may have, and a tape that another agrees with, are none of it.
  for (const double factor : {1.004, 1.02}) {
    MeasuredBelts belts = taped(factor * diagonal_mm);
    if (factor > 1.01) belts.distances.push_back({Belt::bl, Belt::br, factor * a.br.x_mm, 1.0});
    write("belts.json", grid::files::write_belts(belts));
    EXPECT_EQ(run("fit belts.json -o fine.json --force").code, 0) << factor;
  }
  // Of two tapes the one that is wrong.
  MeasuredBelts two = taped(diagonal_mm + 100.0);
  two.distances.push_back({Belt::bl, Belt::br, a.br.x_mm, 1.0});
  expect_named(two, AllOf(HasSubstr("/distances/0/"), testing::Not(HasSubstr("/distances/1/"))));
}

}  // namespace
}  // namespace chaintrue

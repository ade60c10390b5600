// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One hidden machine of every kind: drawn by another implementation (tests/lab/generator), its file read like a user's,
/// diagnosed, and only then compared with the truth. Each set states its expected diagnosis; seeds
/// are fixed and part of a test's name. Rates over hundreds of such sets are the laboratory's
/// (tests/lab/sealed).
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/laws_trial.hpp"
#include "sealed/judge/map_errors.hpp"
#include "sealed/judge/plan.hpp"
#include "sealed/judge/plotter_sets.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::SizeIs;

/// A set of plan.hpp with its hidden cause, and facts of outcome.hpp that must be true.
struct Set {
  const char* kind;
  std::uint64_t seed;
  std::vector<std::string> hidden;
  std::vector<std::string> facts;
};

std::ostream& operator<<(std::ostream& stream, const Set& set) {
  return stream << set.kind << " " << set.seed;
}

std::string name_of(const testing::TestParamInfo<Set>& info) {
  std::string name = std::string(info.param.kind) + "_" + std::to_string(info.param.seed);
  for (const std::string& cause : info.param.hidden) name += "_" + cause.substr(0, cause.find(':'));
  return name;
}

class SealedSmoke : public testing::TestWithParam<Set> {};

TEST_P(SealedSmoke, DiagnosisFindsTheHiddenCause) {
  const Outcome outcome = run_set({GetParam().kind, GetParam().seed});
  EXPECT_EQ(outcome.hidden, GetParam().hidden) << line_of(outcome);
  EXPECT_THAT(outcome.facts, IsSupersetOf(GetParam().facts)) << line_of(outcome);
}

// 28 points each, strengths of 7 to 22.
const std::vector<std::string> kAlone = {"alone", "nothing_false", "bad_found", "no_pattern"};
INSTANTIATE_TEST_SUITE_P(
    Chains, SealedSmoke,
    testing::Values(Set{"single", 1000014, {"tape_scale:y"}, kAlone},
                    Set{"single", 1000018, {"axes_skew:-"}, kAlone},
                    Set{"single", 1000041, {"ring_radius:-"}, kAlone},
                    Set{"single", 1000008, {"chain_sag:-"}, kAlone},
                    Set{"single", 1000000, {"chain_stretch:-"}, kAlone},
                    Set{"single", 1000026, {"beam_flex:-"}, kAlone},
                    Set{"single", 1000010, {"side_pull:-"}, kAlone},
                    Set{"single", 1000034, {"chain_plane_offset:-"}, kAlone},
                    Set{"single", 1000040, {"sprocket_eccentricity:left"}, kAlone},
                    Set{"single", 1000050, {"angular_kink:right"}, kAlone},
                    Set{"single", 1000028, {"direction_hysteresis:both"}, kAlone},
                    Set{"single", 1000032, {"chain_pitch_error:left"}, kAlone},
                    Set{"single", 1000062, {"drift:left"}, kAlone},
                    Set{"single", 1000001, {"tooth_skip:right"}, kAlone},
                    Set{"single", 1000006, {"link_miscount:right"}, kAlone}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    SeveralOrNone, SealedSmoke,
    testing::Values(Set{"two",
                        1010005,
                        {"chain_pitch_error:left", "angular_kink:left"},
                        {"all", "nothing_false"}},
                    Set{"three",
                        1020002,
                        {"side_pull:-", "beam_flex:-", "axes_skew:-"},
                        {"all", "nothing_false"}},
                    Set{"nothing", 1100001, {}, {"no_name", "no_pattern", "no_more_bad"}},
                    Set{"heavy", 1110001, {}, {"no_name", "no_pattern", "no_more_bad"}},
                    Set{"wrong_noise", 1120002, {}, {"no_name", "no_pattern", "no_more_bad"}},
                    Set{"pattern", 1050002, {}, {"pattern", "refused", "no_name"}},
                    Set{"bad_points", 1080001, {}, {"only_bad_points", "bad_found", "no_more_bad"}},
                    Set{"bad_points_and_effect",
                        1090004,
                        {"side_pull:-"},
                        {"alone", "bad_found", "no_more_bad"}}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    BeltsAndHoles, SealedSmoke,
    testing::Values(Set{"belts_middle", 1160004, {"belt_stretch:-"}, {"alone", "right_belt"}},
                    Set{"belts_middle", 1160003, {"anchor_height:tr"}, {"alone", "right_belt"}},
                    Set{"belts_middle", 1160049, {"belt_scale:tl"}, {"alone", "right_belt"}},
                    Set{"belts_middle", 1160128, {"belt_zero:br"}, {"alone", "right_belt"}},
                    Set{"belts_middle", 1160033, {"drift:br"}, {"alone", "right_belt"}},
                    Set{"belts_bad", 1190003, {}, {"no_name", "bad_found"}},
                    Set{"holes", 1130084, {"chain_pitch_error:left"}, kAlone},
                    Set{"holes_nothing", 1140000, {}, {"no_name", "no_pattern"}}),
    name_of);

struct Drawing {
  PlotterKind kind;
  HiddenCause cause;
};

TEST(PlotterSmoke, DiagnosisNamesTheHiddenCauseAndNothingOnASoundPlotter) {
  for (const Drawing& drawing : {Drawing{PlotterKind::mural, {"pen_off_centre", ""}},
                                 Drawing{PlotterKind::body, {"gondola_width", ""}},
                                 Drawing{PlotterKind::light_pen, {"cord_weight", "both"}},
                                 Drawing{PlotterKind::mural, {}}}) {
    constexpr std::uint64_t kSeed = 1001;
    SCOPED_TRACE(testing::Message()
                 << name(drawing.kind) << " " << drawing.cause.effect << ", seed " << kSeed);
    const PlotterOutcome outcome =
        outcome_of(plotter_set(drawing.kind, drawing.cause, 12.0, 16.0, kSeed));
    EXPECT_EQ(outcome,
              drawing.cause.effect.empty() ? PlotterOutcome::nothing : PlotterOutcome::named);
  }
}

TEST(LawSmoke, ClaimsALawWithItsVariableAndNoField) {
  constexpr std::uint64_t kSeed = 4;
  const Outcome law = run_laws_trial("laws", kSeed);
  EXPECT_TRUE(law.has("claimed") && law.has("leads")) << line_of(law);
  // A size is a sigma off on average; beyond 3 are three in a thousand.
  EXPECT_TRUE(law.has("near")) << line_of(law);
  const Outcome field = run_laws_trial("gaussian", kSeed);
  EXPECT_TRUE(field.has("unclaimed")) << line_of(field);
}

grid::MeasuredGrid session_of(const generator::Recipe& recipe, std::uint64_t seed) {
  return grid::files::parse_grid(generator::draw_set(recipe, seed).grid_text, "sealed.json").grid;
}

// The sentence names the causes, each with its probability in the table, and a nearly certain entry of the table is one
// of them; with a pattern beside them, too.
TEST(SentenceSmoke, NamesWhatTheTableIsSureOf) {
  using generator::Mix;
  int sure = 0;
  for (const Mix kind : {Mix::single, Mix::two, Mix::alongside, Mix::two_alongside, Mix::near}) {
    constexpr std::uint64_t kSeed = 9800;
    SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << ", seed " << kSeed);
    const auto session = session_of({.kind = kind, .points = 28, .delta = 20.0}, kSeed);
    const auto found = grid::diagnosis::diagnose(session, verdict_alone()).value();
    const Trial trial(found);
    for (const auto& entry : found.hypotheses) {
      if (entry.causes.empty() || entry.probability < 0.99) continue;
      ++sure;
      EXPECT_TRUE(trial.is_named(id_of(entry.causes.front()))) << found.sentence;
    }
    for (const auto& cause : found.causes) {
      EXPECT_THAT(found.sentence, HasSubstr(std::string(cause.cause.effect->cause)));
      for (const auto& entry : found.hypotheses) {
        if (id_of(entry.effect, entry.side) == id_of(cause.cause))
          EXPECT_EQ(entry.probability, cause.probability) << found.sentence;
      }
    }
  }
  EXPECT_GE(sure, 3);
}

// The fit treats a skipped tooth as noise: it expected 0.7 mm when the tool was 4 mm off.
TEST(MapSmoke, OmittedNumbersAreReportedIfTheyContradictTheFit) {
  constexpr std::uint64_t kSeed = 1;
  generator::Recipe recipe{.points = 28};
  recipe.exactly = {{generator::Cause::tooth_skip, generator::Where::left, 1.0, 16.0}};
  const auto fit = grid::joint_fit(session_of(recipe, kSeed));
  ASSERT_TRUE(fit) << "seed " << kSeed;
  const auto& map = fit->map.contents();
  EXPECT_THAT(map.notes, Contains(HasSubstr("The larger number is reported")));
  // Noise of 0.2 mm in a chain and 0.3 mm in each coordinate is below 0.3 mm^2 at the tool.
  EXPECT_GT(map.accuracy.expected_tool.rms_mm,
            std::sqrt(std::pow(map.accuracy.blocked.tool.rms_mm, 2) - 0.3))
      << "seed " << kSeed;
}

// The list of `chaintrue start`, and a zero that moves during the session: a typical first evening.
TEST(EveningSmoke, AMovedZeroIsRemovedFromTheMap) {
  constexpr std::uint64_t kSeed = 1;
  generator::Recipe recipe = recipe_of_start();
  recipe.exactly = {{generator::Cause::zero_shift, generator::Where::left, 10.0, 17.0}};
  const generator::SealedSet set = generator::draw_set(recipe, kSeed);
  const grid::Measured measured(grid::files::parse_grid(set.grid_text, "evening.json").grid);
  const auto plain = grid::joint_fit(measured);
  const auto own = grid::diagnosis::fit_with_causes(measured);
  ASSERT_TRUE(plain && own) << "seed " << kSeed;
  ASSERT_THAT(own->built_on, SizeIs(1)) << own->not_weighed;
  EXPECT_EQ(own->built_on.front().cause.effect->id, "zero_shift");
  const auto before = map_errors(set, plain->map);
  const auto after = map_errors(set, own->fit.map);
  ASSERT_TRUE(before && after);
  // A map that ignores a shift of 10 mm in half of the readings keeps most of it.
  EXPECT_GT(before->true_rms_mm, 2.5) << "seed " << kSeed;
  // 32 readings of half a millimetre make a map of some 0.25 mm; twice that.
  EXPECT_LT(after->true_rms_mm, 0.5) << "seed " << kSeed;
}

}  // namespace
}  // namespace chaintrue::sealed

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Declared effects in a diagnosis: those of the catalogue that are written as files give the
/// verdicts and sizes of the built-in ones, and a cause that the catalogue does not have is named
/// once it is declared.
#include <gmock/gmock.h>

#include <cmath>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/files/diagnosis_file.hpp"
#include "grid/files/machine_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/contracts/declared_examples.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis::declared {
namespace {

using model::effects::catalogue_in_files;
using model::effects::declared_by;
using model::effects::Effect;
using testing::HasSubstr;
using testing_support::verdict_alone;

/// 28 marks and six repeats, 0.2 and 0.3 mm of noise, on a machine that declares these effects.
MeasuredGrid session_of(const std::vector<const Effect*>& declared,
                        const std::vector<model::AppliedEffect>& hidden, std::uint64_t seed,
                        double noise = 1.0) {
  model::Machine machine;
  machine.declared = declared;
  return synthetic::generate(machine, testing_support::usual_session(seed, hidden, noise))
      .value()
      .grid;
}

std::string name_in_catalogue(const CauseId& cause) {
  const auto* own = model::effects::declaration_of(*cause.effect);
  return std::string(own != nullptr ? own->instead_of : cause.effect->id);
}

class InPlaceOfTheCatalogue : public testing::TestWithParam<model::AppliedEffect> {};

TEST_P(InPlaceOfTheCatalogue, DeclaredEffectsGiveTheSameVerdictAndSizes) {
  MeasuredGrid grid = session_of({}, {GetParam()}, 41);
  const auto with_built_in = diagnose(grid, verdict_alone());
  grid.machine->declared = catalogue_in_files();
  const auto with_files = diagnose(grid, verdict_alone());
  ASSERT_TRUE(with_built_in);
  ASSERT_TRUE(with_files);
  EXPECT_EQ(with_files->verdict, with_built_in->verdict) << with_files->sentence;
  EXPECT_NE(with_files->verdict, Verdict::nothing_found)
      << "the test would compare nothing with nothing";
  ASSERT_EQ(with_files->causes.size(), with_built_in->causes.size());
  for (std::size_t k = 0; k < with_files->causes.size(); ++k) {
    const Cause& a = with_files->causes[k];
    const Cause& b = with_built_in->causes[k];
    EXPECT_EQ(name_in_catalogue(a.cause), name_in_catalogue(b.cause));
    EXPECT_EQ(a.cause.side, b.cause.side);
    // Sums in another order change sizes and probabilities by at most 1e-6.
    EXPECT_NEAR(a.probability, b.probability, 1e-6);
    ASSERT_EQ(a.parameters.size(), b.parameters.size());
    for (std::size_t i = 0; i < a.parameters.size(); ++i)
      EXPECT_NEAR(a.parameters[i].value, b.parameters[i].value,
                  1e-6 * std::max(1.0, std::abs(b.parameters[i].value)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, InPlaceOfTheCatalogue,
    testing::Values(model::AppliedEffect{"tape_scale", "x", {{"scale", 0.003}}},
                    model::AppliedEffect{
                        "angular_kink", "right", {{"slope_mm_per_rad", 9.0}, {"knee_rad", 0.7}}},
                    model::AppliedEffect{
                        "tooth_skip", "left", {{"links", 1.0}, {"first_visit", 12.0}}}),
    [](const auto& one) { return one.param.effect; });

struct Example {
  const char* file;
  model::AppliedEffect hidden;
};

class ExampleOfThePage : public testing::TestWithParam<Example> {};

TEST_P(ExampleOfThePage, IsNamedOnceItIsDeclared) {
  const Effect& own = declared_by(GetParam().file);
  const MeasuredGrid grid = session_of({&own}, {GetParam().hidden}, 7, 0.25);
  const auto found = diagnose(grid, verdict_alone());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->verdict, Verdict::named) << found->sentence;
  EXPECT_EQ(found->causes.front().cause.effect, &own);
  EXPECT_EQ(name(found->causes.front().cause.side), GetParam().hidden.side);
  EXPECT_THAT(found->sentence, HasSubstr(std::string(own.cause)));
  const double true_size =
      GetParam().hidden.parameters.at(std::string(own.parameters.front().name));
  const ParameterEstimate& size = found->causes.front().parameters.front();
  EXPECT_NEAR(size.value, true_size, 4.0 * size.sigma) << "4 sigma: 1 in 16000";
  // Kept in the diagnosis and in the extended machine.
  const Diagnosis back = files::parse_diagnosis(files::write_diagnosis(*found), "diagnosis.json");
  EXPECT_EQ(back.causes.front().cause.effect, &own);
  EXPECT_EQ(back.extended_machine.declared, std::vector<const Effect*>{&own});
}

INSTANTIATE_TEST_SUITE_P(
    All, ExampleOfThePage,
    testing::Values(
        Example{"second_harmonic.json",
                {"second_harmonic", "left", {{"amplitude_mm", 0.6}, {"phase_rad", 1.2}}}},
        Example{
            "creep_that_saturates.json",
            {"creep_that_saturates", "left", {{"rise_mm", 1.2}, {"settled_after_visits", 6.0}}}},
        Example{"chain_rubs.json",
                {"chain_rubs", "right", {{"give_mm_per_n", 0.06}, {"touches_rad", 0.6}}}}),
    [](const auto& one) { return one.param.hidden.effect; });

}  // namespace
}  // namespace chaintrue::grid::diagnosis::declared

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every effect, on every side, is unchanged after writing and reading a machine file.
#include <gtest/gtest.h>

#include "grid/files/machine_file.hpp"
#include "model/effects/catalogue.hpp"
#include "tests/contracts/declared_examples.hpp"

namespace chaintrue::model::effects {
namespace {

TEST(EffectFileContract, EveryEffectComesBackFromAMachineFile) {
  Machine declaring;
  declaring.declared = declared_examples();
  for (const Effect* effect : effects_of(declaring)) {
    for (const EffectSide side : effect->sides) {
      SCOPED_TRACE(std::string(effect->id) + " " + std::string(name(side)));
      std::vector<double> values = nominal_values(*effect);
      for (std::size_t i = 0; i < values.size(); ++i) {
        // A value without a short decimal form.
        if (!effect->parameters[i].integer) values[i] += effect->parameters[i].prior_sigma / 3.0;
      }
      Machine machine;
      if (effect->law != nullptr) machine.declared = {effect};
      machine.effects = {applied(*effect, side, values)};
      const std::string text = grid::files::write_machine(machine);
      const Machine back = grid::files::parse_machine(text, "machine.json");
      ASSERT_EQ(back.effects.size(), 1U);
      EXPECT_EQ(back.declared, machine.declared);
      EXPECT_EQ(back.effects[0].effect, machine.effects[0].effect);
      EXPECT_EQ(back.effects[0].side, machine.effects[0].side);
      EXPECT_EQ(back.effects[0].parameters, machine.effects[0].parameters);  // to the last bit
      EXPECT_EQ(grid::files::write_machine(back), text);
    }
  }
}

TEST(EffectFileContract, ProblemsAreReportedWithTheirPlaceInTheFile) {
  Machine machine;
  machine.effects = {{"drift", "x", {{"rate_mm_per_visit", 0.01}}}};
  try {
    static_cast<void>(
        grid::files::parse_machine(grid::files::write_machine(machine), "machine.json"));
    FAIL() << "accepted";
  } catch (const grid::files::InputError& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].message(),
              "machine.json: /effects/0/side: found x, expected \"left\", \"right\" or \"both\"");
  }
}

}  // namespace
}  // namespace chaintrue::model::effects

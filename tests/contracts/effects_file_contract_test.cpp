// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every effect, on every side, is unchanged after writing and reading a machine file.
#include <gtest/gtest.h>

#include <limits>

#include "grid/files/machine_file.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"
#include "tests/contracts/declared_examples.hpp"

namespace chaintrue::model::effects {
namespace {

TEST(EffectFileContract, EveryEffectRoundTrips) {
  Machine declaring;
  declaring.declared = declared_examples();
  for (const Effect* effect : listed_effects(declaring)) {
    for (const EffectSide side : effect->sides) {
      SCOPED_TRACE(std::string(effect->id) + " " + std::string(name(side)));
      std::vector<double> values = nominal_values(*effect);
      for (std::size_t i = 0; i < values.size(); ++i) {
        // A value without a short decimal form.
        if (!effect->parameters[i].integer) values[i] += effect->parameters[i].prior_sigma / 3.0;
      }
      Machine machine;
      if (effect->law != nullptr) machine.declared = {effect};
      if (effect->part == Part::brackets) machine.attachment = Brackets{};
      machine.effects = {applied(*effect, side, values)};
      const std::string text = grid::files::write_machine(machine);
      const Machine back = grid::files::parse_machine(text, "machine.json").machine;
      ASSERT_EQ(back.effects.size(), 1U);
      EXPECT_EQ(back.declared, machine.declared);
      EXPECT_EQ(back.effects[0].effect, machine.effects[0].effect);
      EXPECT_EQ(back.effects[0].side, machine.effects[0].side);
      EXPECT_EQ(back.effects[0].parameters, machine.effects[0].parameters);  // to the last bit
      EXPECT_EQ(grid::files::write_machine(back), text);
    }
  }
}

// Bad effects in files are in tests/cli/cases/machine_files.cases.
TEST(EffectsOfAMachine, ImpossibleOnesBreakAPrecondition) {
  Machine machine;
  machine.effects = {{"side_pull", "", {{"force_n", std::numeric_limits<double>::quiet_NaN()}}}};
  EXPECT_THROW(ReadingModel{machine}, std::invalid_argument);
  machine.effects = {{"chain_rust", "", {}}};
  EXPECT_THROW(ReadingModel{machine}, std::invalid_argument);
  EXPECT_THROW(MarkFrame{machine}, std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model::effects

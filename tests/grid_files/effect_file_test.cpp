// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_effect files are read as they were written; bad ones are in tests/cli/cases/effects.cases.
#include <gtest/gtest.h>

#include "grid/files/effect_file.hpp"

namespace chaintrue::grid::files::effect_files {
namespace {

using model::effects::Declaration;

const std::string kText = R"JSON({
  "file_type": "chaintrue_effect", "format_version": "1.0", "id": "wave",
  "acts_on": "chain", "sides": ["left", "right"],
  "parameters": [
    {"name": "amplitude_mm", "null": 0, "nominal": 0.2, "prior_sigma": 0.2, "lower": 0, "upper": 5},
    {"name": "phase_rad", "role": "place", "prior_sigma": 3.14, "lower": -6.3, "upper": 6.3}
  ],
  "adds_mm": "amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)",
  "cause": "the sprocket is not round", "remedy": "change the sprocket", "not_modelled": "its third harmonic"
})JSON";

TEST(EffectFile, IsReadWithItsAssumptions) {
  const Declaration own = parse_effect(kText, "wave.json");
  EXPECT_EQ(own.id, "wave");
  EXPECT_EQ(own.adds_mm, "amplitude_mm * sin(4 * pi * L0 / turn + phase_rad)");
  ASSERT_EQ(own.parameters.size(), 2U);
  EXPECT_EQ(own.parameters[1].nominal, 0.0);
  EXPECT_EQ(own.parameters[1].null, 0.0);
  EXPECT_EQ(own.typical, "amplitude_mm = 0.2");
}

TEST(EffectFile, RoundTrips) {
  const Declaration own = parse_effect(kText, "wave.json");
  const std::string text = write_effect(own);
  EXPECT_EQ(parse_effect(text, "again.json"), own);
  EXPECT_EQ(write_effect(parse_effect(text, "again.json")), text);
}

}  // namespace
}  // namespace chaintrue::grid::files::effect_files

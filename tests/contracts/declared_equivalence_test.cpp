// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The effects of the catalogue that act on paper, chain and reading, written as files, change a
/// session as the built-in ones do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"
#include "tests/contracts/declared_examples.hpp"
#include "tests/contracts/session_numbers.hpp"

namespace chaintrue::model::effects::equivalence {
namespace {

std::vector<double> found_in(const Machine& machine) { return found(machine, session()); }

const Effect* built_in_of(const Effect& own) {
  return find_effect(declaration_of(own)->instead_of);
}

/// Rounding of lengths of 3000 mm, a few times.
constexpr double kRoundingMm = 1e-11;

TEST(DeclaredEquivalence, CoversEveryFormulaicEffect) {
  std::size_t written = 0;
  for (const Effect* effect : catalogue()) written += effect->station != Station::machine ? 1 : 0;
  EXPECT_EQ(catalogue_in_files().size(), written);
}

TEST(DeclaredEquivalence, HasTheCataloguesNumbers) {
  for (const Effect* own : catalogue_in_files()) {
    const Effect& built_in = *built_in_of(*own);
    SCOPED_TRACE(std::string(built_in.id));
    EXPECT_EQ(own->station, built_in.station);
    EXPECT_EQ(own->needs, built_in.needs);
    EXPECT_EQ(own->at_one_visit, built_in.at_one_visit);
    EXPECT_EQ(own->remedy_kind, built_in.remedy_kind);
    EXPECT_TRUE(std::equal(own->sides.begin(), own->sides.end(), built_in.sides.begin(),
                           built_in.sides.end()));
    ASSERT_EQ(own->parameters.size(), built_in.parameters.size());
    for (std::size_t i = 0; i < own->parameters.size(); ++i) {
      const EffectParameter& a = own->parameters[i];
      const EffectParameter& b = built_in.parameters[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.role, b.role);
      EXPECT_EQ(a.nominal, b.nominal);
      EXPECT_EQ(a.lower, b.lower);
      EXPECT_EQ(a.upper, b.upper);
      EXPECT_EQ(a.prior_sigma, b.prior_sigma);
      EXPECT_EQ(a.integer, b.integer);
    }
  }
}

TEST(DeclaredEquivalence, EqualsTheBuiltInEffect) {
  for (const Effect* own : catalogue_in_files()) {
    const Effect& built_in = *built_in_of(*own);
    for (const EffectSide side : built_in.sides) {
      for (const double share : {0.0, 0.5, 1.0, 2.0}) {
        SCOPED_TRACE(testing::Message() << built_in.id << " " << name(side) << " times " << share);
        std::vector<double> values = nominal_values(built_in);
        values.front() *= built_in.parameters.front().integer ? std::ceil(share) : share;
        if (values.size() > 1) values.back() = built_in.parameters.back().integer ? 7.0 : 0.4;
        Machine with_file;
        with_file.declared = {own};
        with_file.effects = {applied(*own, side, values)};
        Machine with_built_in;
        with_built_in.effects = {applied(built_in, side, values)};
        EXPECT_LE(largest_difference(found_in(with_file), found_in(with_built_in)), kRoundingMm);
      }
    }
  }
}

TEST(DeclaredEquivalence, EqualsTheBuiltInEffectsTogether) {
  Machine with_files;
  Machine with_built_in;
  with_files.declared = catalogue_in_files();
  for (const Effect* own : with_files.declared) {
    const Effect& built_in = *built_in_of(*own);
    const std::vector<double> values = nominal_values(built_in);
    with_files.effects.push_back(applied(*own, built_in.sides.front(), values));
    with_built_in.effects.push_back(applied(built_in, built_in.sides.front(), values));
  }
  EXPECT_LE(largest_difference(found_in(with_files), found_in(with_built_in)), kRoundingMm);
}

TEST(DeclaredExamples, MatchThePage) {
  const std::string fixtures = CHAINTRUE_FIXTURES;
  const std::string page = grid::files::read_whole_file(fixtures + "/../docs/effects.md");
  for (const char* file :
       {"second_harmonic.json", "creep_that_saturates.json", "chain_rubs.json"}) {
    EXPECT_NE(page.find(declaration_of(declared_by(file))->adds_mm), std::string::npos) << file;
    EXPECT_NE(page.find(std::string("`") + file + "`"), std::string::npos) << file;
  }
}

}  // namespace
}  // namespace chaintrue::model::effects::equivalence

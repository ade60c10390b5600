// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "model/effects/catalogue.hpp"

namespace chaintrue::model::effects {
namespace {

// Written by `chaintrue effects --markdown > docs/effects.md`.
TEST(Document, IsTheCatalogueAsItStands) {
  std::ifstream in(std::string(CHAINTRUE_FIXTURES) + "/../docs/effects.md");
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  EXPECT_EQ(text, catalogue_document());
}

}  // namespace
}  // namespace chaintrue::model::effects

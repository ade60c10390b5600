// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "model/effects/catalogue.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::model::effects {
namespace {

// Written by `chaintrue effects --markdown > docs/effects.md`.
TEST(Document, IsTheCatalogueAsItStands) {
  EXPECT_EQ(testing_support::read_text(CHAINTRUE_FIXTURES "/../docs/effects.md"), catalogue_document());
}

}  // namespace
}  // namespace chaintrue::model::effects

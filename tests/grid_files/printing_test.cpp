// SPDX-License-Identifier: GPL-3.0-or-later
// The check of printed numbers, and that every library that prints uses it.
#include "grid/printing.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "grid/files/number_text.hpp"

namespace chaintrue {
namespace {

constexpr double kBad[] = {
    std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

TEST(Printing, RefusesNonFiniteNumbers) {
  for (const double bad : kBad) {
    std::string text;
    EXPECT_THROW((void)fmt::format("{}", bad), std::logic_error);
    EXPECT_THROW((void)fmt::format("{} {:.2f}", 1.0, bad), std::logic_error);
    EXPECT_THROW((void)fmt::format("{}", static_cast<float>(bad)), std::logic_error);
    EXPECT_THROW(fmt::format_to(std::back_inserter(text), "{:g}", bad), std::logic_error);
    EXPECT_THROW(fmt::print(stderr, "{}", bad), std::logic_error);
    const std::vector<double> list = {1.0, bad};
    EXPECT_THROW((void)fmt::format("{}", fmt::join(list, ",")), std::logic_error);
    EXPECT_EQ(text, "");
  }
}

TEST(Printing, KeepsTheFormatsOfTheStandard) {
  EXPECT_EQ(fmt::format("{:.2f} {} {}", 1.005, "nan", 7), "1.00 nan 7");
  const std::vector<double> list = {1.5, 2.5};
  EXPECT_EQ(fmt::format("{}", fmt::join(list, ",")), "1.5,2.5");
}

/// A range's text is printed inside the grid's library.
TEST(Printing, FormatsAllTextsOfTheProgram) {
  for (const double bad : kBad)
    EXPECT_THROW((void)(grid::files::Range{"mm", 0.0, bad}.expected()), std::logic_error);
}

}  // namespace
}  // namespace chaintrue

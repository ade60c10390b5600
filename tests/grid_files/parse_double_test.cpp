// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// parse_double equals std::from_chars, for every standard library.
#include "grid/files/parse_double.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

namespace chaintrue::grid::files {
namespace {

constexpr double kUntouched = 7.0;

struct Case {
  std::string_view text;
  double value;
  std::size_t length;
  std::errc error = {};
};

void expect(const Case& wanted, NumberForm form) {
  double value = kUntouched;
  const char* const first = wanted.text.data();
  const auto [end, error] = parse_double(first, first + wanted.text.size(), value, form);
  EXPECT_EQ(value, wanted.value) << wanted.text;
  EXPECT_EQ(static_cast<std::size_t>(end - first), wanted.length) << wanted.text;
  EXPECT_EQ(error, wanted.error) << wanted.text;
}

TEST(ParseDouble, ReadsAsMuchAsIsANumber) {
  for (const Case& wanted :
       {Case{"12.5", 12.5, 4}, Case{"-.5e1x", -5.0, 5}, Case{"5.", 5.0, 2}, Case{"1e+", 1.0, 1},
        Case{"0x10", 0.0, 1}, Case{"4.9e-324", 4.9e-324, 8}, Case{"0e999", 0.0, 5},
        Case{"-inf", -HUGE_VAL, 4}}) {
    expect(wanted, NumberForm::general);
  }
}

TEST(ParseDouble, FixedStopsBeforeAnExponent) {
  expect({"1e5", 1.0, 1}, NumberForm::fixed);
  expect({"-12.25", -12.25, 6}, NumberForm::fixed);
}

TEST(ParseDouble, OutOfRangeLeavesTheValue) {
  constexpr auto kOutOfRange = std::errc::result_out_of_range;
  for (const std::string_view text :
       {"1e999", "-1e999", "1e-999", "2e-324", "1.7976931348623159e308"})
    expect({text, kUntouched, text.size(), kOutOfRange}, NumberForm::general);
}

TEST(ParseDouble, RefusesNonNumbers) {
  for (const std::string_view text : {"", "-", ".", "+1", " 1", "x"})
    expect({text, kUntouched, 0, std::errc::invalid_argument}, NumberForm::general);
}

}  // namespace
}  // namespace chaintrue::grid::files

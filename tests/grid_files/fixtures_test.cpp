// SPDX-License-Identifier: GPL-3.0-or-later
// Every file of fixtures/bad is rejected with exactly the problems that it states, and every file
// of fixtures/good is read with exactly the warnings that it states, and written identically each
// time.
#include <gmock/gmock.h>

#include "tests/grid_files/fixture_files.hpp"

namespace chaintrue::grid::files {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAreArray;

std::vector<::testing::Matcher<std::string>> each_with(const std::vector<std::string>& parts) {
  std::vector<::testing::Matcher<std::string>> matchers;
  for (const std::string& part : parts) matchers.push_back(HasSubstr(part));
  return matchers;
}

class BadInput : public ::testing::TestWithParam<FixtureFile> {};

TEST_P(BadInput, IsRefusedWithExactlyItsProblems) {
  const auto expected = remarks_in(GetParam(), "expect: ");
  ASSERT_FALSE(expected.empty()) << "the file does not say what is expected";
  EXPECT_THAT(read_fixture(GetParam()).problems, UnorderedElementsAreArray(each_with(expected)));
}

INSTANTIATE_TEST_SUITE_P(Fixtures, BadInput, ::testing::ValuesIn(fixtures_in("bad")),
                         [](const auto& tested) { return test_name_of(tested.param); });

class GoodInput : public ::testing::TestWithParam<FixtureFile> {};

TEST_P(GoodInput, IsReadAndWrittenTheSameEachTime) {
  const Outcome first = read_fixture(GetParam());
  ASSERT_THAT(first.problems, IsEmpty());
  EXPECT_THAT(first.warnings,
              UnorderedElementsAreArray(each_with(remarks_in(GetParam(), "warn: "))));
  EXPECT_EQ(read_fixture(GetParam()).written, first.written);
  // The output is a chaintrue file for every input.
  std::string kind = "points";
  // A diagnosis contains a machine, and holes or a grid may.
  for (const char* known :
       {"diagnosis", "holes", "belts", "anchors", "grid", "machine", "plotter", "drawing"}) {
    if (kind == "points" &&
        first.written.find(std::string("chaintrue_") + known) != std::string::npos)
      kind = known;
  }
  const Outcome again = read_text(kind, first.written, GetParam().path.string());
  EXPECT_THAT(again.problems, IsEmpty());
  EXPECT_EQ(again.written, first.written);
}

INSTANTIATE_TEST_SUITE_P(Fixtures, GoodInput, ::testing::ValuesIn(fixtures_in("good")),
                         [](const auto& tested) { return test_name_of(tested.param); });

}  // namespace
}  // namespace chaintrue::grid::files

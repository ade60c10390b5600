// SPDX-License-Identifier: GPL-3.0-or-later
// The advice for findings that are made by hand.
#include <gmock/gmock.h>

#include "grid/diagnosis/findings.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing_support::session_of;

TEST(Words, APointIsMeasuredAgainUnlessThatPointIsAnOutlier) {
  const Analysis analysis = testing_support::analysis_of(session_of({}, 1));
  const auto what_to_do = [&](Observations kind) {
    Diagnosis d;
    d.points = point_pictures(analysis);
    d.distances.resize(6);
    d.stability = Stability{};
    Removal removal;
    removal.index = 5;
    removal.stands = false;
    d.stability->removals.push_back(removal);
    Outlier outlier;
    outlier.of = kind;
    outlier.index = 5;
    d.outliers.push_back(outlier);
    put_into_words(analysis, d);
    return d.what_to_do;
  };
  const auto again = Contains(HasSubstr("Measure point 6 again first"));
  EXPECT_THAT(what_to_do(Observations::points), Not(again));
  // The sixth distance, not a point.
  EXPECT_THAT(what_to_do(Observations::distances), again);
}

}  // namespace
}  // namespace chaintrue::grid::diagnosis

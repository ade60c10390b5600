// SPDX-License-Identifier: GPL-3.0-or-later
// A precondition broken by NaN or infinity is reported with that value: the check of printed
// numbers does not apply.
#include "grid/precondition.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "grid/containers.hpp"
#include "grid/files/json_text.hpp"
#include "grid/observation/single_readings.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "grid/random.hpp"
#include "grid/statistics.hpp"
#include "grid/synthetic/strength.hpp"
#include "tests/support/refusal.hpp"

namespace chaintrue::grid {
namespace {

using testing_support::refusal_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Precondition, ReportsItsValues) {
  EXPECT_STREQ(precondition("{} of {} mm, {:.1f}", 3, kNan, -kInfinity).what(),
               "3 of nan mm, -inf");
}

TEST(Precondition, RefusesExtremesOfAnEmptySet) {
  const std::vector<double> nothing;
  EXPECT_THAT(refusal_of([&] { (void)max_element(nothing); }), ::testing::HasSubstr("0 values"));
  EXPECT_THAT(refusal_of([&] { (void)min_element(nothing, std::greater<>()); }),
              ::testing::HasSubstr("0 values"));
  EXPECT_THAT(refusal_of([&] { (void)minmax_element(nothing); }), ::testing::HasSubstr("0 values"));
}

struct Site {
  const char* name;
  std::function<void(double)> call;
};

void PrintTo(const Site& site, std::ostream* out) { *out << site.name; }

class BrokenBy : public ::testing::TestWithParam<Site> {};

TEST_P(BrokenBy, ShowsNonFiniteValues) {
  EXPECT_THAT(refusal_of([] { GetParam().call(kNan); }), ::testing::HasSubstr("nan"));
}

INSTANTIATE_TEST_SUITE_P(
    Sites, BrokenBy,
    ::testing::Values(
        Site{"normal_quantile", [](double bad) { (void)normal_quantile(bad); }},
        Site{"portable_log", [](double bad) { (void)portable_log(bad); }},
        Site{"strength",
             [](double bad) {
               (void)synthetic::StrengthTable(model::Machine{}, {}, {.length_mm = bad});
             }},
        Site{"single_reading",
             [](double bad) {
               ExtraReading reading;
               reading.sigma = bad;
               (void)observation::SingleReadings({reading});
             }},
        Site{"plan_measurement",
             [](double bad) { (void)plan_measurement(model::Machine{}, {.margin_mm = bad}); }},
        Site{"plan_holes",
             [](double bad) { (void)plan_holes(model::Machine{}, {.tape_sigma_mm = bad}); }},
        Site{"json", [](double bad) { (void)files::print_json(files::Json(bad)); }}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace chaintrue::grid

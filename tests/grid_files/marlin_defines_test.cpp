// SPDX-License-Identifier: GPL-3.0-or-later
// A Configuration.h as Marlin ships it and owners change it: which definition is in force, and its
// value.
#include "grid/files/marlin_defines.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "grid/files/plotter_settings.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr const char* kName = "X_BED_SIZE";

/// The name's value as text; empty if it is reported or not defined.
std::optional<std::string> value_of(const std::string& text) {
  Problems problems("Configuration.h");
  const SettingTexts texts = marlin_texts(text, {kName}, problems);
  const auto own = texts.find(kName);
  if (own == texts.end()) return std::nullopt;
  EXPECT_FALSE(problems.any()) << text;
  return own->second.text;
}

struct Meaning {
  const char* text;
  std::optional<std::string> value;
};

TEST(MarlinDefines, MatchTheCompiler) {
  const Meaning meanings[] = {{"#define X_BED_SIZE 650 // mm", "650"},
                              {"# define X_BED_SIZE /* motor to motor */ 650.5f", "650.5"},
                              {"#define X_BED_SIZE \\\n  650", "650"},
                              {"/* #define X_BED_SIZE 1\n */\n#define X_BED_SIZE 650", "650"},
                              {"//#define X_BED_SIZE 1", std::nullopt},
                              {"#define A 20+30\n#define X_BED_SIZE A*2", "80"},
                              {"#define A 650.0\n#define X_BED_SIZE (-A/4)", "-162.5"},
                              {"#define X_BED_SIZE 4.0 - sqrt( sq(3) + sq(4.0) )", "-1"},
                              // Whole numbers are cut, wherever they stand.
                              {"#define X_BED_SIZE 575/2", std::nullopt},
                              {"#define X_BED_SIZE 0.5 + sq(575/2)", std::nullopt},
                              {"#define X_BED_SIZE 1/0", std::nullopt},
                              {"#define X_BED_SIZE X_BED_SIZE", std::nullopt},
                              {"#define A B B\n#define B A A\n#define X_BED_SIZE A", std::nullopt},
                              {"#define X_BED_SIZE", std::nullopt},
                              {"#define X_BED_SIZE 6 50", std::nullopt},
                              {"#define X_BED_SIZE 650,5", std::nullopt}};
  for (const Meaning& own : meanings) EXPECT_EQ(value_of(own.text), own.value) << own.text;
}

TEST(MarlinDefines, CountWhereTheirConditionHolds) {
  const auto in = [](const char* condition) {
    return fmt::format(
        "#define ON\n#define OFF false\n#if {}\n#define X_BED_SIZE 1\n#else\n#define X_BED_SIZE "
        "2\n#endif",
        condition);
  };
  const Meaning meanings[] = {{"ENABLED(ON)", "1"},
                              {"ENABLED(OFF)", "2"},
                              {"ENABLED(NOT_THERE)", "2"},
                              {"DISABLED(ON)", "2"},
                              {"ANY(OFF, ON)", "1"},
                              {"EITHER(OFF, NOT_THERE)", "2"},
                              {"ALL(ON, OFF)", "2"},
                              {"NONE(OFF, NOT_THERE)", "1"},
                              {"defined(OFF) && !defined NOT_THERE", "1"},
                              {"!(ENABLED(ON) || ENABLED(OFF))", "2"},
                              {"0", "2"},
                              // Other kinds of conditions are unknown.
                              {"ENABLED(OFF) && MB(RAMPS)", std::nullopt},
                              {"MOTHERBOARD == 3", std::nullopt},
                              {"((", std::nullopt}};
  for (const Meaning& own : meanings) EXPECT_EQ(value_of(in(own.text)), own.value) << own.text;
  EXPECT_EQ(value_of("#if ENABLED(A)\n#define X_BED_SIZE 1\n#elif 1\n#define X_BED_SIZE 2\n"
                     "#elif 1\n#define X_BED_SIZE 3\n#endif"),
            "2");
  EXPECT_EQ(value_of("#define X_BED_SIZE 1\n#ifndef X_BED_SIZE\n#define X_BED_SIZE 2\n#endif"),
            "1");
  EXPECT_EQ(value_of("#define X_BED_SIZE 1\n#undef X_BED_SIZE\n#define X_BED_SIZE 2"), "2");
  // An excerpt need not contain the names in its #if.
  EXPECT_EQ(value_of("#if ENABLED(POLARGRAPH)\n#define X_BED_SIZE 1\n#endif"), "1");
}

TEST(MarlinDefines, DescribeThePlotterOfAShippedConfiguration) {
  const std::string text = R"(
#define POLARGRAPH
#if ENABLED(POLARGRAPH)
  #define POLARGRAPH_MAX_BELT_LEN 1035.0 // (mm) Belt length at full extension. Override with M665 H.
  #define DEFAULT_SEGMENTS_PER_SECOND 5
#endif
//#define DELTA
#if ENABLED(DELTA)
  #define DEFAULT_SEGMENTS_PER_SECOND 200
#endif
#define DEFAULT_AXIS_STEPS_PER_UNIT { 80, 80, 400, 500 }
#define X_BED_SIZE 650
#define Y_BED_SIZE 1000
#define X_MIN_POS (-X_BED_SIZE/2)
#define Y_MIN_POS (-Y_BED_SIZE/2)
#define X_MAX_POS (X_BED_SIZE/2)
#define Y_MAX_POS (Y_BED_SIZE/2)
#define MANUAL_X_HOME_POS 0
#define MANUAL_Y_HOME_POS ( Y_MAX_POS - ( sqrt( sq(POLARGRAPH_MAX_BELT_LEN) - sq(X_BED_SIZE/2) ) ) )
)";
  const SetPlotter set = parse_plotter_settings(text, "Configuration.h").plotter.set;
  EXPECT_EQ(set.machine.pin_spacing_mm, 650.0);
  EXPECT_EQ(set.longest_belt_mm, 1035.0);
  EXPECT_EQ(set.segments_per_second, 5.0);
  ASSERT_TRUE(set.home);
  // Digits of the formula's value.
  EXPECT_NEAR(set.home->y_mm, -std::sqrt(1035.0 * 1035.0 - 325.0 * 325.0), 1e-9);
}

}  // namespace
}  // namespace chaintrue::grid::files

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Results must be the same if the functions of the C library round in the other direction: searches that
/// stop at a threshold, ties broken by rounding and differences that are pure rounding would differ here, and
/// differ between machines.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <regex>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

/// Rounding of 1e-16 may grow by the condition number of the computation, 1e5 for a calibration, and no
/// further.
constexpr double kRelative = 1e-9;
/// Absolute difference for numbers that are zero up to rounding: a millionth of a micrometre, of a
/// hundredth of a percent.
constexpr double kAbsolute = 1e-9;
/// Digits of a map's coefficients, the last of which may round in either direction.
constexpr std::size_t kWrittenDigits = 7;

/// Numbers and the texts between them in turn, without line breaks and hashes of digits.
std::vector<std::string> pieces_of(const std::string& text) {
  static const std::regex blanks("\\s+");
  static const std::regex hash("\"[0-9a-f]{64}\"");
  static const std::regex number("-?[0-9]+\\.?[0-9]*([eE][-+]?[0-9]+)?");
  const std::string plain = std::regex_replace(std::regex_replace(text, hash, "\"\""), blanks, "");
  std::vector<std::string> pieces;
  const std::sregex_token_iterator end;
  for (std::sregex_token_iterator at(plain.begin(), plain.end(), number, {-1, 0}); at != end;
       ++at) {
    pieces.push_back(*at);
  }
  return pieces;
}

std::size_t digits_of(const std::string& number) {
  static const std::regex frame("[eE].*|^-?[0.]*|\\.");
  return std::regex_replace(number, frame, "").size();
}

void expect_alike(const std::string& found, const std::string& wanted) {
  const std::vector<std::string> a = pieces_of(found);
  const std::vector<std::string> b = pieces_of(wanted);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    const bool is_number = i % 2 == 1;
    ASSERT_TRUE(is_number) << a[i] << " in place of " << b[i];
    const double is = std::stod(a[i]);
    const double was = std::stod(b[i]);
    // One step of the last written digit.
    const bool is_rounded = std::max(digits_of(a[i]), digits_of(b[i])) == kWrittenDigits;
    const double step = is_rounded ? std::pow(10.0, 1.0 - kWrittenDigits) : kRelative;
    EXPECT_LE(std::abs(is - was), std::max(step * std::abs(was), kAbsolute))
        << a[i] << " in place of " << b[i] << ", after "
        << b[i - 1].substr(b[i - 1].size() > 80 ? b[i - 1].size() - 80 : 0);
  }
}

struct Task {
  const char* name;
  const char* words;
  bool is_in_all_digits = false;  ///< the output shows the last bit
};
void PrintTo(const Task& task, std::ostream* out) { *out << task.words; }

class LastBit : public testing_support::CommandFixture, public testing::WithParamInterface<Task> {};

TEST_P(LastBit, DoesNotChangeTheVerdict) {
  const std::string words = std::string(GetParam().words) + " -o result.json";
  const auto plain = run_line("cp -r " CHAINTRUE_FIXTURES "/* . && " CHAINTRUE_COMMAND " " + words);
  ASSERT_EQ(plain.code, 0) << plain.err;
  const std::string wanted = testing_support::content_of(folder_ / "result.json");
  bool differs = false;
  for (const int rounding : {1, 2, 3}) {
    SCOPED_TRACE(testing::Message() << "CHAINTRUE_ROUNDING=" << rounding);
    const auto other = run_line("CHAINTRUE_ROUNDING=" + std::to_string(rounding) +
                                " LD_PRELOAD=" CHAINTRUE_OTHER_ROUNDING " " CHAINTRUE_COMMAND " " +
                                words + " --force");
    ASSERT_EQ(other.code, 0) << other.err;
    EXPECT_EQ(other.out, plain.out);
    EXPECT_EQ(other.err, plain.err);
    const std::string found = testing_support::content_of(folder_ / "result.json");
    expect_alike(found, wanted);
    differs = differs || found != wanted;
  }
  EXPECT_TRUE(differs || !GetParam().is_in_all_digits) << "nothing was put before the library";
}

INSTANTIATE_TEST_SUITE_P(
    Commands, LastBit,
    testing::Values(Task{"Map", "fit grids/seven_by_four.json"},
                    Task{"MapAndHoles",
                         "fit grids/seven_by_four.json --with holes/nine_holes.json"},
                    Task{"DirectSurface", "fit grids/seed_001.csv --surface direct"},
                    Task{"Belts", "fit belts/thirty_one_places.json"},
                    Task{"Diagnosis", "diagnose grids/seven_by_four.json", true},
                    Task{"DiagnosisOfHoles", "diagnose holes/nine_holes.json", true},
                    Task{"PlannedHoles", "plan --machine machines/classic.json --holes 9"}),
    [](const auto& task) { return task.param.name; });

}  // namespace
}  // namespace chaintrue

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Runs the tests of a program, which has several folders of them:
///
///   grid_tests --folder=belts --part=1/2      those of tests/belts, the first half of its source files
///   grid_tests --gtest_filter='BeltsFit.*'
///
/// Parts consist of whole files, so that shared preparations are made once.
#include <gmock/gmock.h>
#ifdef __EMSCRIPTEN__
#include <sys/stat.h>
#endif

#include <cstdio>
#include <map>
#include <string>
#include <string_view>

namespace {

struct Choice {
  std::string folder;
  unsigned part = 1;
  unsigned parts = 1;
};

/// False: an argument that is neither gtest's nor one of these two.
bool read_choice(int argc, char** argv, Choice& choice) {
  constexpr std::string_view kFolder = "--folder=";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    char end = 0;
    if (argument.substr(0, kFolder.size()) == kFolder) {
      choice.folder = argument.substr(kFolder.size());
    } else if (std::sscanf(argv[i], "--part=%u/%u%c", &choice.part, &choice.parts, &end) != 2 ||
               choice.part < 1 || choice.part > choice.parts) {
      return false;
    }
  }
  return true;
}

bool is_in(const testing::TestInfo& test, const std::string& folder) {
  return std::string_view(test.file()).find("/tests/" + folder + "/") != std::string_view::npos;
}

/// Adds the suites that are not chosen to gtest's filter. Returns the number of those that are; 0 also where a suite
/// belongs to two folders, since it can be neither chosen nor left out.
int leave_out_others(const Choice& choice) {
  std::map<std::string, unsigned> part_of;  // by source file, in order of the first suite
  std::string others;
  int chosen = 0;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    bool is_chosen = is_in(*suite.GetTestInfo(0), choice.folder);
    for (int k = 1; k < suite.total_test_count(); ++k) {
      if (is_in(*suite.GetTestInfo(k), choice.folder) == is_chosen) continue;
      std::fprintf(stderr, "tests of %s are in two folders\n", suite.name());
      return 0;
    }
    if (is_chosen) {
      const auto next = static_cast<unsigned>(part_of.size()) % choice.parts + 1;
      is_chosen = part_of.emplace(suite.GetTestInfo(0)->file(), next).first->second == choice.part;
    }
    chosen += is_chosen ? 1 : 0;
    if (!is_chosen) others += ":" + std::string(suite.name()) + ".*";
  }
  const std::string filter = GTEST_FLAG_GET(filter);
  const bool has_negative = filter.find('-') != std::string::npos;
  if (!others.empty())
    GTEST_FLAG_SET(filter, filter + (has_negative ? others : "-" + others.substr(1)));
  return chosen;
}

}  // namespace

int main(int argc, char** argv) {
#ifdef __EMSCRIPTEN__
  ::umask(022);  // as in a shell; node lacks it
#endif
  testing::InitGoogleMock(&argc, argv);
  Choice choice;
  if (!read_choice(argc, argv, choice)) {
    std::fprintf(stderr, "usage: %s [--folder=NAME [--part=K/N]] [--gtest_...]\n", argv[0]);
    return 2;
  }
  if (!choice.folder.empty() && leave_out_others(choice) == 0) {
    std::fprintf(stderr, "no test of tests/%s in this part\n", choice.folder.c_str());
    return 2;
  }
  return RUN_ALL_TESTS();
}

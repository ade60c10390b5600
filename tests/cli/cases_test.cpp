// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the cases of tests/cli/cases: a suite a file, a test a case (case_file.hpp).
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "tests/cli/case_file.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue::testing_support {
namespace {

namespace fs = std::filesystem;

/// A temporary folder, and the steps and checks of a case in it.
class Workplace {
 public:
  explicit Workplace(const CaseFile& file) : file_(file) {}

  void run(const Case& all) {
    for (std::size_t i = 0; i < all.steps.size() && !is_over(); ++i) {
      const Step& step = all.steps[i];
      const testing::ScopedTrace trace(file_.path.c_str(), step.line, step.verb + " " + step.rest);
      const bool says_exit = i + 1 < all.steps.size() && all.steps[i + 1].verb == "exit";
      run(step);
      if (step.verb == "$" && !says_exit) expect_exit("0");
    }
  }

 private:
  static bool is_over() { return testing::Test::IsSkipped() || testing::Test::HasFailure(); }

  void run(const Step& step) {
    std::istringstream words(step.rest);
    std::string path;
    const auto all_paths = [&](bool exist) {
      while (words >> path) EXPECT_EQ(fs::exists(folder_ / path), exist) << path;
    };
    if (step.verb == "from") return begin_where(step.rest);
    if (step.verb == "file") return write(step);
    if (step.verb == "$") return run_line(step.rest);
    if (step.verb == "exit") return expect_exit(step.rest);
    if (step.verb == "exists") return all_paths(true);
    if (step.verb == "absent") return all_paths(false);
    if (step.verb == "says") return expect_line(step.rest, "");
    if (step.verb == "problem") {
      const std::size_t blank = std::min(step.rest.find(' '), step.rest.size());
      const std::string begin = step.rest.substr(std::min(blank + 1, step.rest.size()));
      return expect_line(begin, " (" + step.rest.substr(0, blank) + ")");
    }
    words >> path;
    const std::string text = content_of(folder_ / path);
    const std::string rest = step.rest.substr(std::min(step.rest.size(), path.size() + 1));
    if (step.verb == "same") {
      EXPECT_TRUE(text == content_of(folder_ / rest)) << "they differ";
      EXPECT_NE(text, "");
    } else if (step.verb == "has" || step.verb == "lacks") {
      EXPECT_EQ(text.find(rest) != std::string::npos, step.verb == "has") << text.substr(0, 4000);
    } else if (step.verb == "lines") {
      EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), std::stol(rest)) << text;
    } else {
      expect_number(step.verb, text, rest);
    }
  }

  /// A given runs once per process; each case gets a copy of its result.
  void begin_where(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Workplace>> done;
    auto& place = done[file_.path.string() + " " + name];
    if (!place) {
      place = std::make_unique<Workplace>(file_);
      place->run(file_.givens.at(name));
    }
    fs::copy(place->folder_, folder_,
             fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  }

  void write(const Step& step) const {
    fs::create_directories((folder_ / step.rest).parent_path());
    std::ofstream(folder_ / step.rest) << step.text;
  }

  void run_line(const std::string& line) {
    if (line.find("$D") != std::string::npos && !fs::exists(CHAINTRUE_SHARED_DATA))
      GTEST_SKIP() << "shared data, not part of a checkout, is not at " CHAINTRUE_SHARED_DATA;
    if (line.find("$MPIRUN") != std::string::npos && !fs::exists(CHAINTRUE_MPIRUN))
      GTEST_SKIP() << "MPI was not found (Debian: libopenmpi-dev, openmpi-bin)";
    const std::string shell = "cd " + folder_.string() +
                              " && export CHAINTRUE_PROBLEM_NAMES=1 F=" CHAINTRUE_FIXTURES
                              " D=" CHAINTRUE_SHARED_DATA " MPIRUN=" CHAINTRUE_MPIRUN
                              " PATH=$(dirname " CHAINTRUE_COMMAND "):$PATH && { " +
                              line + "\n} >.next.out 2>.next.err";
    const int status = std::system(shell.c_str());
    // The line may read the last one's output.
    for (const char* stream : {"out", "err"})
      fs::rename(folder_ / (std::string(".next.") + stream), folder_ / (std::string(".") + stream));
    code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  void expect_exit(const std::string& codes) const {
    std::istringstream words(codes);
    bool is_one = false;
    for (int code = 0; words >> code;) is_one = is_one || code == code_;
    EXPECT_TRUE(is_one) << "exit code " << code_ << ", expected " << codes << "\n"
                        << content_of(folder_ / ".err");
  }

  void expect_line(const std::string& begin, const std::string& end) const {
    std::istringstream lines(content_of(folder_ / ".err"));
    bool is_there = false;
    for (std::string line; std::getline(lines, line);)
      is_there = is_there || (line.starts_with(begin) && line.ends_with(end));
    EXPECT_TRUE(is_there) << lines.str();
  }

  /// `rest`: a key, and the value with what may follow.
  static void expect_number(const std::string& verb, const std::string& text, std::string rest) {
    rest = rest.substr(0, rest.find(" # "));
    const std::size_t end = rest.front() == '"' ? rest.find('"', 1) + 1 : rest.find(' ');
    const std::string key = rest.substr(0, end);
    const std::string wanted = rest.substr(end + 1);
    if (verb == "is" && key.front() == '/') {
      const auto json = nlohmann::json::parse(text, nullptr, false);
      const nlohmann::json::json_pointer pointer(key);
      ASSERT_TRUE(json.contains(pointer)) << text.substr(0, 4000);
      EXPECT_EQ(json.at(pointer), nlohmann::json::parse(wanted));
      return;
    }
    const std::optional<double> found = number_at(text, key);
    ASSERT_TRUE(found) << text.substr(0, 4000);
    const double value = std::stod(wanted);
    const double tolerance = verb == "near" ? std::stod(wanted.substr(wanted.find("+-") + 2)) : 0.0;
    const bool holds = verb == "above"   ? *found > value
                       : verb == "below" ? *found < value
                                         : std::abs(*found - value) <= tolerance;
    EXPECT_TRUE(holds) << "found " << *found << ", expected " << verb << " " << wanted;
  }

  static std::optional<double> number_at(const std::string& text, const std::string& key) {
    if (key.front() == '/') {
      const auto json = nlohmann::json::parse(text, nullptr, false);
      const nlohmann::json::json_pointer pointer(key);
      if (!json.contains(pointer) || !json.at(pointer).is_number()) return std::nullopt;
      return json.at(pointer).get<double>();
    }
    const std::string words = key.substr(1, key.size() - 2);
    const std::size_t at = text.find(words);
    if (at == std::string::npos) return std::nullopt;
    const std::size_t begin = text.find_first_not_of(' ', at + words.size());
    double value = 0.0;
    if (begin == std::string::npos ||
        std::from_chars(text.data() + begin, text.data() + text.size(), value).ec != std::errc())
      return std::nullopt;
    return value;
  }

  const CaseFile& file_;
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
  int code_ = -1;
};

class CaseTest : public testing::Test {
 public:
  CaseTest(const CaseFile& file, const Case& one) : file_(file), one_(one) {}
  void TestBody() override { Workplace(file_).run(one_); }

 private:
  const CaseFile& file_;
  const Case& one_;
};

bool register_all() {
  static std::vector<std::unique_ptr<CaseFile>> files;
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(CHAINTRUE_CASES)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    const CaseFile& file = *files.emplace_back(std::make_unique<CaseFile>(read_cases(path)));
    for (const Case& one : file.cases) {
      testing::RegisterTest(path.stem().c_str(), one.name.c_str(), nullptr, nullptr, path.c_str(),
                            one.line, [&file, &one] { return new CaseTest(file, one); });
    }
  }
  return true;
}

[[maybe_unused]] const bool kRegistered = register_all();

}  // namespace
}  // namespace chaintrue::testing_support

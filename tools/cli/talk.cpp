// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/talk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cstddef>
#include <cstdlib>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/options.hpp"
#include "grid/map/check.hpp"
#include "grid/map/fit.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/report/typeset.hpp"

namespace chaintrue::cli {

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::string between(std::string_view begin, std::string_view text) {
  return shows_colours() ? fmt::format("{}{}\x1b[0m", begin, text) : std::string(text);
}

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._/-+,=:@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  return fmt::format("'{}'", report::replaced(word, {{"'", "'\\''"}}));
}

/// Quoted for a shell.
std::string called_as = "chaintrue";

}  // namespace

void set_called_as(std::string_view name) {
  const std::size_t slash = name.rfind('/');
  const bool is_path = slash != std::string_view::npos;
  // The page runs the same program under a name of its engine's.
  if (is_path && name.substr(slash + 1) == "chaintrue") called_as = quoted(std::string(name));
}

bool shows_colours() {
  static const bool shows = ::isatty(::fileno(stderr)) == 1 && environment("NO_COLOR").empty() &&
                            environment("TERM") != "dumb";
  return shows;
}

std::string in_bold(std::string_view text) { return between("\x1b[1m", text); }
std::string in_red(std::string_view text) { return between("\x1b[31m", text); }

void say_lines(std::string_view lines) { fmt::print(stderr, "{}", lines); }

void add_option_words(Words& words, std::string option, std::string value) {
  if (!value.empty()) words.insert(words.end(), {std::move(option), std::move(value)});
}

void add_option_words(Words& words, const std::string& option, const Words& values) {
  for (const std::string& value : values) add_option_words(words, option, value);
}

void say_next(const Words& words) {
  if (contains(words, "-")) return;
  std::string line = called_as;
  for (const std::string& word : words) line += " " + quoted(word);
  std::fflush(stdout);
  say("{}", in_bold("Next: " + line));
}

QuietTalk::QuietTalk(bool is_quiet) {
  if (!is_quiet) return;
  std::FILE* kept = std::tmpfile();
  if (kept == nullptr) return;
  kept_ = ::dup(::fileno(kept));
  std::fclose(kept);
  std::fflush(stderr);
  heard_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::dup2(kept_, STDERR_FILENO);
}

void QuietTalk::end(bool is_to_be_reported) {
  if (heard_ < 0) return;
  std::fflush(stderr);
  ::dup2(heard_, STDERR_FILENO);
  ::close(heard_);
  heard_ = -1;
  if (is_to_be_reported && ::lseek(kept_, 0, SEEK_SET) == 0) {
    char buffer[4096];
    for (ssize_t count = 0; (count = ::read(kept_, buffer, sizeof buffer)) > 0;)
      std::fwrite(buffer, 1, as_size(count), stderr);
  }
  ::close(kept_);
}

QuietTalk::~QuietTalk() { end(true); }

void write_whole_lines() {
  struct stat out {};
  struct stat err {};
  if (::fstat(STDOUT_FILENO, &out) != 0 || ::fstat(STDERR_FILENO, &err) != 0) return;
  if (out.st_dev == err.st_dev && out.st_ino == err.st_ino)
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
}

std::string with_name(std::string message, std::string_view name) {
  if (std::getenv("CHAINTRUE_PROBLEM_NAMES") == nullptr) return message;
  return fmt::format("{} ({})", message, name);
}

void print_warnings(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) {
    const bool has_name = warning.kind != ProblemKind::unexpected;
    say("{}", has_name ? with_name(warning.message(), warning.name()) : warning.message());
  }
}

Words sentences_of(const std::vector<Warning>& warnings) {
  return mapped(warnings, &Warning::sentence);
}

namespace {

/// `kLast` is the enumerator of the last name, which ensures that every enumerator has a name.
template <auto kLast, std::size_t n>
std::string_view name_in(decltype(kLast) reason, const std::string_view (&names)[n]) {
  static_assert(n == as_size(kLast) + 1);
  return names[as_size(reason)];
}

}  // namespace

std::string_view name_of(grid::BeltsFitReason reason) {
  return name_in<grid::BeltsFitReason::tape_contradicts>(
      reason, {"too_few_points", "not_determined", "no_frame", "hole_without_anchors",
               "too_many_distances", "tape_contradicts"});
}

std::string_view name_of(grid::CheckReason reason) {
  return name_in<grid::CheckReason::nowhere>(
      reason,
      {"too_many_readings", "no_machine", "no_lengths", "unreachable", "no_noise", "nowhere"});
}

std::string_view name_of(grid::FitReason reason) {
  return name_in<grid::FitReason::not_converged>(
      reason, {"no_machine", "not_a_grid", "no_lengths", "point_unreachable", "rank_deficient",
               "impossible_readings", "not_converged"});
}

std::string_view name_of(grid::PlanReason reason) {
  return name_in<grid::PlanReason::no_map>(
      reason, {"no_machine", "unreachable", "too_few_places", "no_map"});
}

std::string_view name_of(diagnosis::DiagnosisReason reason) {
  return name_in<diagnosis::DiagnosisReason::contradictory_settings>(
      reason, {"no_machine", "no_lengths", "too_few_points", "no_noise", "point_unreachable",
               "contradictory_settings"});
}

}  // namespace chaintrue::cli

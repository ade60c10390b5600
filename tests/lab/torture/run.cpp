// SPDX-License-Identifier: GPL-3.0-or-later
#include "torture/run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <thread>

namespace chaintrue::torture {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Exit code of a sanitizer; different from the command's own codes.
constexpr const char* kSanitizerExit = "exitcode=99";
constexpr int kLastOwnCode = 4;

[[noreturn]] void become(const fs::path& program,
                         const fs::path& folder,
                         const std::vector<std::string>& arguments) {
  const std::string streams = folder.string();
  const int in = ::open("/dev/null", O_RDONLY);
  const int out = ::open((streams + ".out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err = ::open((streams + ".err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::dup2(err, STDERR_FILENO);
  ::setenv("ASAN_OPTIONS", (std::string("detect_leaks=0:") + kSanitizerExit).c_str(), 1);
  ::setenv("UBSAN_OPTIONS",
           (std::string("halt_on_error=1:print_stacktrace=1:") + kSanitizerExit).c_str(),
           1);
  if (::chdir(folder.c_str()) != 0) ::_exit(126);
  std::vector<char*> list = {const_cast<char*>("chaintrue")};
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  ::execv(program.c_str(), list.data());
  ::_exit(127);
}

}  // namespace

Command::Command(fs::path program, fs::path folder, double limit_s)
    : program_(fs::absolute(program)), folder_(std::move(folder)), limit_s_(limit_s) {}

Ended Command::run(const std::vector<std::string>& arguments, std::optional<Stop> stop) const {
  const Clock::time_point start = Clock::now();
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process could be started");
  if (child == 0) become(program_, folder_, arguments);
  Ended ended;
  if (stop) {
    std::this_thread::sleep_for(stop->after);
    ::kill(child, stop->signal_number);
  }
  int status = 0;
  for (;;) {
    if (::waitpid(child, &status, WNOHANG) == child) break;
    ended.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!ended.is_endless && ended.seconds > limit_s_) {
      ended.is_endless = true;
      ::kill(child, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  ended.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (WIFEXITED(status)) ended.code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) ended.signal_number = WTERMSIG(status);
  ended.out = content_of(folder_.string() + ".out");
  ended.err = content_of(folder_.string() + ".err");
  return ended;
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string no_number_in(const std::string& text) {
  // A page contains its scripts, which include such words; its numbers are those of files.
  if (text.starts_with("<!DOCTYPE")) return {};
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           static_cast<unsigned char>(c) >= 0x80U;
  };
  for (const std::string_view word : {"nan", "inf"}) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const bool begins = at == 0 || !is_letter(text[at - 1]);
      const bool ends = at + word.size() >= text.size() || !is_letter(text[at + word.size()]);
      if (begins && ends) return text.substr(at < 40 ? 0 : at - 40, 80);
    }
  }
  return {};
}

std::string wrong_with(const Ended& ended) {
  if (ended.is_endless) return "no end within the time limit";
  if (ended.signal_number != 0) return fmt::format("signal {}", ended.signal_number);
  if (ended.err.find("internal error") != std::string::npos) return "an internal error";
  if (ended.code > kLastOwnCode) return fmt::format("exit code {}", ended.code);
  if (ended.code >= 2 && ended.err.empty()) return "refused without a word";
  if (const std::string found = no_number_in(ended.out); !found.empty())
    return "a number that is none: " + found;
  return {};
}

}  // namespace chaintrue::torture

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command as a process of its own: how it ended, what it said, and what must hold of that
/// whatever it was given.
#pragma once

#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace chaintrue::torture {

struct Ended {
  int code = -1;          ///< of a process that ended by itself
  int signal_number = 0;  ///< of one that did not
  bool is_endless = false;
  double seconds = 0.0;
  std::string out;
  std::string err;
};

struct Stop {
  int signal_number = SIGKILL;
  std::chrono::microseconds after{0};
};

class Command {
 public:
  /// `program` is run in `folder`; its streams go to files beside that.
  Command(std::filesystem::path program, std::filesystem::path folder, double limit_s);
  [[nodiscard]] Ended run(const std::vector<std::string>& arguments,
                          std::optional<Stop> stop = {}) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path program_;
  std::filesystem::path folder_;
  double limit_s_;
};

/// Empty, or what is wrong with such an end: a signal, no end, an internal error, an exit code that
/// is none, silence, or a number that is none.
[[nodiscard]] std::string wrong_with(const Ended& ended);
/// The first nan or inf that stands in a text as a word; empty where there is none.
[[nodiscard]] std::string no_number_in(const std::string& text);
[[nodiscard]] std::string content_of(const std::filesystem::path& path);

}  // namespace chaintrue::torture

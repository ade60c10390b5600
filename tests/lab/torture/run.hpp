// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command as a separate process: how it ended, its output, and what must be true of both for
/// every input.
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
  /// `program` runs in `folder`; its streams go to files next to the folder.
  Command(std::filesystem::path program, std::filesystem::path folder, double limit_s);
  [[nodiscard]] Ended run(const std::vector<std::string>& arguments,
                          std::optional<Stop> stop = {}) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path program_;
  std::filesystem::path folder_;
  double limit_s_;
};

/// Empty, or the fault of such an end: a signal, a timeout, an internal error, an undocumented exit
/// code, no output, or a number that is not finite.
[[nodiscard]] std::string wrong_with(const Ended& ended);
/// The first nan or inf that is a word in a text; empty if there is none.
[[nodiscard]] std::string no_number_in(const std::string& text);
[[nodiscard]] std::string content_of(const std::filesystem::path& path);

}  // namespace chaintrue::torture

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/process.hpp"

#include <sys/wait.h>

#include <cstdlib>

#include "tests/support/files.hpp"

namespace chaintrue::testing_support {

std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

Outcome run_line(const std::filesystem::path& folder, const std::string& shell) {
  const std::filesystem::path command = CHAINTRUE_COMMAND;
  const std::string line = "cd " + quoted(folder) + " && PATH=" + quoted(command.parent_path()) +
                           ":$PATH && { " + shell + "\n} >out.txt 2>err.txt";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder / "out.txt"),
          read_text(folder / "err.txt")};
}

}  // namespace chaintrue::testing_support

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/linuxcnc.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "grid/files/whole_file.hpp"
#include "tests/support/files.hpp"

namespace chaintrue::witness {
namespace {

using grid::files::read_whole_file;
using grid::files::write_whole_file;
using testing_support::TemporaryFolder;

std::string root() {
  if (const char* stated = std::getenv("RS274_ROOT"); stated != nullptr) return stated;
  const std::filesystem::path unpacked = CHAINTRUE_RS274_UNPACKED;
  return std::filesystem::exists(unpacked / "usr/bin/rs274") ? unpacked.string() : "";
}

int run(const std::string& programs, const std::string& truth) {
  const std::string command = fmt::format("RS274_ROOT='{}' python3 '{}' < '{}' > '{}' 2> '{}.log'",
                                          root(), CHAINTRUE_LINUXCNC_MOVES, programs, truth, truth);
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string look() {
  const TemporaryFolder scratch;
  write_whole_file(scratch / "in", "=== there 0\n\n");
  if (run(scratch / "in", scratch / "out") == 0 &&
      read_whole_file(scratch / "out").find("ACCEPTED") != std::string::npos) {
    return {};
  }
  return "LinuxCNC's interpreter is not here: run tests/gcode_witness/unpack_interpreter, which "
         "unpacks Debian's linuxcnc-uspace into build/rs274, or set RS274_ROOT";
}

}  // namespace

const std::string& linuxcnc_missing() {
  static const std::string missing = look();
  return missing;
}

std::vector<Record> ask_linuxcnc(const std::vector<Record>& programs) {
  if (programs.empty()) return {};
  const TemporaryFolder scratch;
  write_whole_file(scratch / "in", write_records(programs));
  const int code = run(scratch / "in", scratch / "out");
  if (code != 0) {
    throw std::runtime_error(fmt::format("linuxcnc_moves.py ended with {}: {}", code,
                                         read_whole_file(scratch / "out.log")));
  }
  auto answers = read_records(read_whole_file(scratch / "out"));
  if (answers.size() != programs.size())
    throw std::runtime_error("linuxcnc_moves.py did not answer every program");
  return answers;
}

}  // namespace chaintrue::witness

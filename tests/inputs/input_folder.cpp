// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/inputs/input_folder.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace chaintrue::inputs {

namespace fs = std::filesystem;
using testing_support::read_text;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

Rows rows_of(const std::string& table) {
  Rows rows;
  std::ifstream file(CHAINTRUE_FIXTURES "/../tests/" + table);
  if (!file) throw std::runtime_error("no table " + table);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream cells(line);
    for (rows.emplace_back(); std::getline(cells, line, '\t');) rows.back().push_back(line);
  }
  return rows;
}

InputFolder::InputFolder() {
  add_made_files("inputs/made_files.tsv");
  for (const auto& row : rows_of("inputs/copied_files.tsv"))
    fs::copy_file(fs::path(CHAINTRUE_FIXTURES) / row[1], folder_ / row[0]);
  fs::copy(CHAINTRUE_FIXTURES "/../tests/inputs/files", folder_);
}

void InputFolder::make_missing_files(const std::string& lines) const {
  for (std::size_t at = lines.find('@'); at != std::string::npos; at = lines.find('@', at + 1)) {
    const std::size_t end = std::min(lines.find_first_of(" :;", at), lines.size());
    const auto own = lines_.find(lines.substr(at + 1, end - at - 1));
    if (own == lines_.end()) continue;
    const std::string line = own->second;
    lines_.erase(own);  // before it runs: it names its own output
    const Ran ran = run(line);
    if (ran.code != 0) throw std::runtime_error("cannot make a file: " + line + "\n" + ran.err);
  }
}

std::string InputFolder::text_of(const std::string& file) const {
  make_missing_files("@" + file);
  return read_text(folder_ / file);
}

void InputFolder::write(const std::string& file, const std::string& text) const {
  std::ofstream(folder_ / file, std::ios::binary) << text;
}

void InputFolder::add_made_files(const std::string& table) {
  for (const auto& row : rows_of(table)) lines_[row[0].substr(row[0].rfind('@') + 1)] = row[0];
}

Ran InputFolder::run(const std::string& lines) const {
  make_missing_files(lines);
  const fs::path folder = folder_ / "run";
  fs::create_directory(folder);
  // A map unfit for cutting gives exit code 1 but is written and can be queried.
  const std::string then = "; s=$?; [ $s -le 1 ] || exit $s; " CHAINTRUE_COMMAND " ";
  const std::string commands = replaced(replaced(lines, "; ", then), "@", folder_.string() + "/");
  const std::string shell = "cd " + folder.string() + " && { " CHAINTRUE_COMMAND " " + commands +
                            " ; } >../run.out 2>../run.err";
  const int status = std::system(shell.c_str());
  Ran ran;
  ran.code = WEXITSTATUS(status);
  ran.out = read_text(folder_ / "run.out");
  ran.err = read_text(folder_ / "run.err");
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      ran.files[fs::relative(entry.path(), folder).string()] = read_text(entry.path());
  }
  fs::remove_all(folder);
  return ran;
}

}  // namespace chaintrue::inputs

// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/gcode_witness/support/corpus.hpp"

#include <stdexcept>

#include "grid/files/whole_file.hpp"
#include "tests/gcode_witness/support/records.hpp"

namespace chaintrue::witness {

std::string corpus_folder(const std::string& fixtures) { return fixtures + "/gcode/corpus/"; }

std::vector<StoredProgram> stored_programs(const std::string& fixtures, const std::string& theme) {
  const std::string stem = corpus_folder(fixtures) + theme;
  const auto programs = read_records(grid::files::read_whole_file(stem + ".records"));
  const auto answers = read_records(grid::files::read_whole_file(stem + ".canon"));
  std::vector<StoredProgram> result;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (i >= answers.size() || answers[i].name != programs[i].name)
      throw std::runtime_error(theme + ".canon has no answer to " + programs[i].name);
    result.push_back(
        {programs[i].name, programs[i].text, answers[i].text, read_truth(answers[i].text)});
  }
  return result;
}

}  // namespace chaintrue::witness

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Targets of the campaign, from the table of how each verb is called (tests/inputs): every reader of
/// a file, and every verb in a valid call. In arguments `IN` stands for the file under attack, `OUT`
/// for the output.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace chaintrue::torture {

/// Files beside those of the table, and the fixtures that they are copies of.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& copied_files();

/// A verb that reads `IN`. The weight is how often it is drawn: slow ones rarely.
struct Reading {
  std::string seed_file;
  int weight;
  std::vector<std::string> arguments;
};
[[nodiscard]] const std::vector<Reading>& readings();

/// Those of files with a hash of their content.
[[nodiscard]] std::vector<Reading> readings_of_hashed_files();

/// Calls that succeed, to which unusual options are added; every verb has one.
[[nodiscard]] const std::vector<std::vector<std::string>>& calls();

/// "gcode check" of a command line.
[[nodiscard]] std::string verb_of(const std::vector<std::string>& arguments);

}  // namespace chaintrue::torture

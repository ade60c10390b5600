// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Targets of the campaign: the files of its folder, every reader of one, every verb in a valid
/// call, and values of options. In arguments `IN` stands for the file under attack, `OUT` for the
/// output, `NUMBER` for a number.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace chaintrue::torture {

/// A file of the folder and the fixture that it is a copy of.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& copied_files();
/// Commands that make further files of the folder, in their order.
[[nodiscard]] const std::vector<std::vector<std::string>>& makers();

/// A verb that reads `IN`. The weight is how often it is drawn: slow ones rarely.
struct Reading {
  std::string seed_file;
  int weight;
  std::vector<std::string> arguments;
};
[[nodiscard]] const std::vector<Reading>& readings();

/// Files with a hash of their content, and their readers.
struct Sealed {
  std::string file;
  std::vector<std::vector<std::string>> uses;
};
[[nodiscard]] const std::vector<Sealed>& sealed_files();

/// Calls that succeed, to which unusual options are added; every verb has one.
[[nodiscard]] const std::vector<std::vector<std::string>>& invocations();

/// "gcode check" of a command line.
[[nodiscard]] std::string verb_of(const std::vector<std::string>& arguments);
/// Verbs of two words begin with one of these.
[[nodiscard]] bool has_subverbs(std::string_view verb);

/// Some valid values of a text option; empty if nothing is listed: then any file is valid.
[[nodiscard]] const std::vector<std::string>& good_texts(const std::string& option);
/// The option names an output file or folder.
[[nodiscard]] bool is_output(std::string_view option);

}  // namespace chaintrue::torture

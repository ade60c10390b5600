// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Files of cases: command lines as pasted by a user, and the expected results. One line each:
///
///   given NAME             steps that cases of this file begin with; they run once
///   case NAME
///   from NAME              begins where that `given` ended
///   file PATH              holds the lines that follow and begin with "| "
///   $ LINE                 a shell line in the case's folder; $F are the fixtures; a case that uses
///                          $D, the shared data, or $MPIRUN is skipped if it is missing
///   exit CODE [CODE...]    of the last line; 0 by default
///   exists PATH...         absent PATH...        same PATH PATH
///   has PATH TEXT          lacks PATH TEXT       lines PATH COUNT
///   says BEGIN             a line of .err begins like this: a file, a place in it, the value found
///   problem NAME BEGIN     such a line of a problem with this name (grid/problem_kinds.def)
///   is PATH KEY VALUE      near PATH KEY VALUE +- TOLERANCE
///   above PATH KEY VALUE   below PATH KEY VALUE
///
/// The last line's streams are the files .out and .err. A KEY is a JSON pointer, with a JSON VALUE; or
/// "words" in quotes, with the number after them. A line that begins with # is a comment, as is what
/// follows " # " in a line about a number.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace chaintrue::testing_support {

struct Step {
  int line = 0;
  std::string verb;  ///< the first word
  std::string rest;
  std::string text;  ///< of a file
};

struct Case {
  std::string name;
  int line = 0;
  std::vector<Step> steps;
};

struct CaseFile {
  std::filesystem::path path;
  std::map<std::string, Case> givens;
  std::vector<Case> cases;
};

/// \throws std::runtime_error with an unknown line.
CaseFile read_cases(const std::filesystem::path& path);

}  // namespace chaintrue::testing_support

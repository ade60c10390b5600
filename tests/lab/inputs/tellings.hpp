// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Every option at a value that changes the answer, and the files needed.
#pragma once

#include <string>
#include <vector>

#include "tests/inputs/input_folder.hpp"
#include "tests/inputs/invocations.hpp"

namespace chaintrue::inputs {

/// How an option's effect shows.
enum class Shows {
  in_numbers,  ///< of the answer
  in_form,     ///< other bytes, the numbers may be the same
  as_file,     ///< a file more
  in_words,    ///< standard error, or the exit code
};

/// The option at a value that tells, with what it needs: a row of tellings.tsv. `where` is an
/// invocation's name, or empty for all.
struct Telling {
  std::string verb, option, words;
  Shows shows;
  std::string where;
  /// Where the invocation's own files leave the option nothing to do: a program (@...) in place of simple.nc
  /// and of what was made of it, or a whole line.
  std::string instead;
};
/// The one for this invocation if there is one; null if the option has none.
const Telling* telling_of(const std::string& verb, const std::string& option,
                          const std::string& use);

/// Commands that extract the numbers from this call's output, if the file repeats the input.
std::string then_of(const Invocation& call);
/// Adds the files that are named by the table.
void add_telling_files(InputFolder& folder);

}  // namespace chaintrue::inputs

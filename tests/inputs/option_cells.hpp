// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The cells of options: every verb on every kind of input that it takes, and every option at a value
/// that tells.
#pragma once

#include <string>
#include <vector>

#include "tools/cli/option_rules.hpp"

namespace chaintrue::inputs {

/// A verb on one kind of input. `then` reads the numbers out of what was written, where the file
/// itself repeats the input.
struct Use {
  const char* name;
  const char* verb;
  cli::Facts facts;
  const char* line;
  const char* then = "";
};
[[nodiscard]] const std::vector<Use>& uses();

/// How it shows that an option acts.
enum class Shows {
  in_numbers,  ///< of the answer
  in_form,     ///< other bytes, the numbers may be the same
  as_file,     ///< a file more
  in_words,    ///< what is said on standard error, or the exit code
};

/// The option at a value that tells, with what it needs. `where` is a use's name, or empty for all.
struct Telling {
  const char* verb;
  const char* option;
  const char* words;
  Shows shows = Shows::in_numbers;
  const char* where = "";
  /// Where the use's own files leave the option nothing to do: a program (@...) in place of simple.nc
  /// and of what was made of it, or a whole line.
  const char* instead = "";
};
/// The one for this use where there is one; null where the option has none at all.
[[nodiscard]] const Telling* telling_of(const std::string& verb,
                                        const std::string& option,
                                        const std::string& use);

}  // namespace chaintrue::inputs

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the verbs of a command line declared, and all its problems, reported at once and before any
/// file is read: numbers out of range and unknown words, a verb's own checks, places of files (places.hpp). Checks that
/// depend on a file's content are the verb's.
///
/// \code
///   add_option_check(verb, c, check_words);  // void check_words(const Command&, OptionProblems&)
/// \endcode
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/origin.hpp"
#include "grid/files/problems.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Collects all problems of a command's values and throws them together.
class OptionProblems {
 public:
  void add(std::string_view option, std::string value, std::string expected, ProblemKind kind);
  /// `value` is finite and within [least, most].
  void require(std::string_view option, double value, double least, double most);
  /// Adds the problems of an InputError thrown by `check`.
  void take_from(const std::function<void()>& check);
  void throw_if_any() const;

 private:
  std::vector<files::InputProblem> problems_;
};

struct DeclaredCheck {
  Verb verb;
  std::function<void(OptionProblems&)> check;
};

/// An option that names files; the names are known after parsing.
struct Place {
  Verb verb;
  std::string names;  ///< "-o,--output"
  std::function<Words()> paths;
  std::vector<files::Origin> kinds;  ///< of an output; none for an input
};

/// Those of all verbs of the current command line.
struct Declared {
  std::vector<OptionRule> rules;
  std::vector<DeclaredCheck> checks;
  std::vector<Place> places;
  files::Problems misread{"command line"};  ///< numbers and words that were given
};
Declared& declared();

/// `check` runs if the verb was chosen. Out-of-range numbers have their defaults then.
void add_option_check(Verb verb, std::function<void(OptionProblems&)> check);
template <class Command>
void add_option_check(Verb verb, const Command& command,
                      void (*check)(const Command&, OptionProblems&)) {
  add_option_check(verb, [&command, check](OptionProblems& problems) { check(command, problems); });
}

/// For the verb that was chosen, before its work. \throws InputError with all that is wrong.
void check_command_line();

}  // namespace chaintrue::cli

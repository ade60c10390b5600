// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All problems of a command line, reported at once and before any file is read: numbers out of
/// range (numbers.hpp), a verb's own checks (here), places of files (places.hpp). Checks that
/// depend on a file's content are the verb's.
///
/// \code
///   add_option_check(verb, [options](OptionProblems& problems) {
///     (void)parse_model(options->model, problems);
///   });
/// \endcode
#pragma once

#include <functional>

#include "tools/cli/arguments.hpp"
#include "tools/cli/effect_argument.hpp"

namespace chaintrue::cli {

/// `check` runs if the verb was chosen. Out-of-range numbers have their defaults then.
void add_option_check(Verb verb, std::function<void(OptionProblems&)> check);

/// Forgets what the verbs of an earlier command line in this process declared.
void begin_command_line();

/// For the verb that was chosen, before its work. \throws InputError with all that is wrong.
void check_command_line();

}  // namespace chaintrue::cli

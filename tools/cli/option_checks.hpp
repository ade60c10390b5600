// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// All that is wrong with a command line, reported at once and before any file is read: numbers out of
/// their range (numbers.hpp), what a verb says of its own options here, places of files
/// (places.hpp). What depends on what a file says the verb finds by itself, later.
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

/// `check` is asked where the verb was chosen. It finds numbers out of their range at their
/// defaults.
void add_option_check(Verb verb, std::function<void(OptionProblems&)> check);

/// Forgets what the verbs of an earlier command line in this process declared.
void begin_command_line();

/// For the verb that was chosen, before its work. \throws files::InputError with all that is wrong.
void check_command_line();

}  // namespace chaintrue::cli

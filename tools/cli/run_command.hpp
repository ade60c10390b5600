// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One run of the command: its words are parsed and the verb does its work. chaintrue's main() and the
/// Python module both run verbs here.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace chaintrue::cli {

/// Calls a verb's work and gives its exit code; what the work throws (InputError, Failed) is
/// the guard's to report.
using Guard = std::function<int(const std::function<int()>& work)>;

/// \param typed the words behind the command's name
/// \returns the exit code. Not for two threads at once: what a command line declares is kept for the
/// whole process until the next run.
int run_command(const std::vector<std::string>& typed, const Guard& guard);

}  // namespace chaintrue::cli

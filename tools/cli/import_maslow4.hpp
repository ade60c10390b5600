// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue import maslow4: the log of a router on four belts becomes a chaintrue_belts file.
#pragma once

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

void add_import_maslow4(Verb import, Run& run);

}  // namespace chaintrue::cli

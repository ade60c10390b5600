// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue import plotter.
#pragma once

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

void add_import_plotter(Verb import, Run& run);

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export linuxcnc.
#pragma once

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

void add_export_linuxcnc(Verb export_verb, Run& run);

}  // namespace chaintrue::cli

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `chaintrue export fluidnc` and `chaintrue export grblhal`: the settings of controllers that take
/// chains for straight lines.
#pragma once

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

void add_export_straight(Verb export_verb, Run& run);

}  // namespace chaintrue::cli

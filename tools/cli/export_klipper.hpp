// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `chaintrue export klipper`.
#pragma once

#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

void add_export_klipper(Verb export_verb, Run& run);

}  // namespace chaintrue::cli

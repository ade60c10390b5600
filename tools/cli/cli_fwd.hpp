// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Names of CLI11's that headers need. Its own header costs each file that includes it eight seconds
/// of compiling; only those that add options do.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI

// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How a connection ended, in sentences that say what to do.
#pragma once

#include <string>

#include "tools/live/watch.hpp"

namespace chaintrue::live {

enum class Outcome {
  time_is_over,
  drive_ended,  ///< a move was refused, or none is left
  closed,       ///< by the machine
  lost,
  silent,  ///< no word, though it was asked
  no_name,
  no_connection,
  no_answer,  ///< to the attempt to connect
  no_websocket,
};
/// Nothing of a machine was found.
[[nodiscard]] bool is_unreached(Outcome outcome);
/// `system`: in the system's words, where it has some.
[[nodiscard]] std::string words_of(Outcome outcome,
                                   const WatchOptions& options,
                                   const std::string& system);

}  // namespace chaintrue::live

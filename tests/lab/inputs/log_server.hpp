// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine at 127.0.0.1 for the cells of `chaintrue maslow4`: each connection gets a log and is closed.
#pragma once

namespace chaintrue::inputs {

/// The port of one that is started at the first call and serves as long as the process runs.
[[nodiscard]] int log_server_port();
/// The port of one that takes connections and never says a word.
[[nodiscard]] int mute_server_port();

}  // namespace chaintrue::inputs

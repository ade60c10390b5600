// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// From a program that shows a fault to a small one that still does.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace chaintrue::witness {

/// For each program whether it shows the fault. Many at a time: asking LinuxCNC costs per batch.
using Faulty = std::function<std::vector<bool>(const std::vector<std::string>&)>;

/// Leaves out lines, then words, as long as the fault stays.
[[nodiscard]] std::string shrink(const std::string& program, const Faulty& faulty);

}  // namespace chaintrue::witness

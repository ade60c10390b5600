// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Reduces a program with a fault to a small one with the same fault.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace chaintrue::witness {

/// For each program whether it has the fault. In batches: each call of LinuxCNC is expensive.
using Faulty = std::function<std::vector<bool>(const std::vector<std::string>&)>;

/// Removes lines, then words, as long as the fault remains.
[[nodiscard]] std::string shrink(const std::string& program, const Faulty& faulty);

}  // namespace chaintrue::witness

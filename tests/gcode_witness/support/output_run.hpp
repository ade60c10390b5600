// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The output of compensate, read by our interpreter, by a reader as strict as grbl's, and by
/// LinuxCNC's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chaintrue::witness {

struct OutputRun {
  std::size_t outputs = 0;
  std::size_t different = 0;
  /// Seed and difference, of the first few.
  std::vector<std::string> failures;
};

/// For random programs with words of random values (S, F, T, and P, Q, E, H of G4, G43, G64, M50-M53,
/// M61-M68) between their moves, every output
///   is read by the strict reader, line by line, with the same moves as our interpreter finds;
///   holds the words of the program, in order, with equal values;
///   and, where LinuxCNC is asked, is the same sequence of canonical calls to it as to ours.
OutputRun compare_output(const std::string& fixtures, std::uint64_t first_seed, std::uint64_t count,
                         bool ask, std::size_t most_reported);

}  // namespace chaintrue::witness

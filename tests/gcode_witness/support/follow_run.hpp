// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random programs, compensated, checked by verify and by the independent follower.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chaintrue::witness {

struct FollowRun {
  std::size_t programs = 0;
  std::size_t compensated =
      0;  ///< the others are rejected, for instance because they leave the bed
  std::size_t judged_moved =
      0;  ///< outputs that were moved by 1.5 tolerances, and outputs that lost a line
  std::size_t failed = 0;
  /// For the first few: seed, controller, tolerance, the fault, and the program.
  std::vector<std::string> failures;
};

struct FollowOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t count = 60;
  std::size_t most_reported = 5;
  /// 0 of 1, or a share of the seeds for one of several processes.
  std::uint64_t share = 0;
  std::uint64_t shares = 1;
};

/// For every program that compensate accepts, at a random tolerance from 0.005 to 1 mm, for each
/// controller in turn, on the measured machine or on a random one:
///   the tool follows the path within the tolerance (follower), and verify holds;
///   the output with one command moved across the path by 1.5 tolerances fails both;
///   the output without one of its moves is judged equally by both, except in a band about the tolerance.
FollowRun follow(const std::string& fixtures, const FollowOptions& options);

}  // namespace chaintrue::witness

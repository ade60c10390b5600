// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The processes of one command under mpirun or a cluster's scheduler. Without MPI, or outside
/// mpirun, there is one.
#pragma once

#include <cstdint>

namespace chaintrue::cli {

/// Joins the others when constructed, leaves when destroyed. One per program.
class Processes {
 public:
  Processes();
  ~Processes();
  Processes(const Processes&) = delete;
  Processes& operator=(const Processes&) = delete;

  [[nodiscard]] std::uint64_t rank() const { return rank_; }
  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// A barrier; returns true for all if `ok` is true for all.
  [[nodiscard]] bool all(bool ok) const;

 private:
  std::uint64_t rank_ = 0;
  std::uint64_t count_ = 1;
  bool joined_ = false;
};

}  // namespace chaintrue::cli

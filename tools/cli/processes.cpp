// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/processes.hpp"

#ifdef CHAINTRUE_HAS_MPI
#include <mpi.h>

#include <cstdlib>
#endif

namespace chaintrue::cli {

#ifdef CHAINTRUE_HAS_MPI

namespace {

// What mpirun (Open MPI), MPICH's hydra and Slurm's own launcher leave in the environment. Started
// by hand, the program does not start MPI, which would cost more than a small sweep.
bool is_launched_together() {
  for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    if (std::getenv(variable) != nullptr) return true;
  }
  return false;
}

}  // namespace

Processes::Processes() {
  if (!is_launched_together()) return;
  MPI_Init(nullptr, nullptr);
  int rank = 0;
  int count = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  rank_ = static_cast<std::uint64_t>(rank);
  count_ = static_cast<std::uint64_t>(count);
  joined_ = true;
}

Processes::~Processes() {
  if (joined_) MPI_Finalize();
}

bool Processes::all(bool ok) const {
  if (!joined_) return ok;
  const int mine = ok ? 1 : 0;
  int everybodys = 0;
  MPI_Allreduce(&mine, &everybodys, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return everybodys == 1;
}

#else

Processes::Processes() = default;
Processes::~Processes() = default;
bool Processes::all(bool ok) const { return ok; }

#endif

}  // namespace chaintrue::cli

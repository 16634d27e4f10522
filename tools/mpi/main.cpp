// SPDX-License-Identifier: Apache-2.0

// The tetwright-mpi program: `prepare` of a segmented volume, whose bricks the ranks of MPI make together.
#include <mpi.h>

#include <cstdio>

#include "tools/app/run_program.h"
#include "tools/mpi/mpi_team.h"

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  if (provided < MPI_THREAD_SERIALIZED) {
    std::fputs("tetwright: this MPI does not let a second thread send messages (MPI_THREAD_SERIALIZED)\n",
               stderr);
    MPI_Abort(MPI_COMM_WORLD, 5);
  }
  tetwright::MpiTeam team;
  // Help and versions are printed once.
  if (!team.is_leader()) (void)std::freopen("/dev/null", "w", stdout);
  const int status = tetwright::run_program(argc, argv, &team);
  // Helpers that failed wait here for the leader, which prints their error.
  constexpr int worst_of_results = 1;
  if (team.is_leader() && status > worst_of_results) {
    std::fflush(stdout);
    MPI_Abort(MPI_COMM_WORLD, status);
  }
  team.part();
  MPI_Finalize();
  return status;
}

// SPDX-License-Identifier: Apache-2.0
#include "tools/mpi/end_all_ranks.h"

#include <mpi.h>
#include <unistd.h>

#include <cerrno>

#include "tetwright/files.h"
#include "tools/app/exit_status.h"
#include "tools/app/printed_report.h"

namespace tetwright {

void end_all_ranks(const std::string& temporary, const std::string& path, const std::string& why) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // Several ranks may fail at once: the one that removes the file says so.
  if (temporary.empty() || unlink(temporary.c_str()) == 0 || errno != ENOENT)
    print_line("cannot write " + path + ": " + why + " (rank " + std::to_string(rank) + ")");
  (void)abandon_output_files();
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitStatus::output_failed));
  _exit(static_cast<int>(ExitStatus::output_failed));
}

}  // namespace tetwright

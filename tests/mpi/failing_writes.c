// SPDX-License-Identifier: Apache-2.0
// A library for LD_PRELOAD: a disk that becomes full, in one rank and one folder.
//   FAIL_RANK    rank of OpenMPI
//   FAIL_FOLDER  end of the folder's path
//   FAIL_WRITE   number, from 1, of the first call that writes into files of the folder and fails; 0: all succeed
//   FAIL_SYNC    1: files of the folder cannot be synced to the disk
//   FAIL_COUNTED file to which the number of calls is written
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static int calls = 0;

static long number(const char* variable) {
  const char* const value = getenv(variable);
  return value ? atol(value) : 0;
}

static int in_folder(int file) {
  const char *const rank = getenv("OMPI_COMM_WORLD_RANK"), *const folder = getenv("FAIL_FOLDER");
  if (!rank || !folder || atol(rank) != number("FAIL_RANK")) return 0;
  char link[64] = "/proc/self/fd/", path[4096] = "", digits[16];
  int count = 0, at = (int)strlen(link);
  do digits[count++] = (char)('0' + file % 10);
  while ((file /= 10) > 0);
  while (count > 0) link[at++] = digits[--count];
  link[at] = '\0';
  const ssize_t length = readlink(link, path, sizeof path - 1);
  char* const name = length > 0 ? strrchr(path, '/') : NULL;
  if (!name) return 0;
  const size_t before = (size_t)(name - path), wanted = strlen(folder);
  return before >= wanted && strncmp(name - wanted, folder, wanted) == 0;
}

static int fails(int file) {
  if (!in_folder(file)) return 0;
  const int call = __atomic_add_fetch(&calls, 1, __ATOMIC_SEQ_CST);
  if (number("FAIL_WRITE") == 0 || call < number("FAIL_WRITE")) return 0;
  errno = ENOSPC;
  return 1;
}

#define WRITER(name, parameters, ...)                                              \
  ssize_t name parameters {                                                        \
    ssize_t(*const next) parameters = (ssize_t(*) parameters)dlsym(RTLD_NEXT, #name); \
    return fails(file) ? -1 : next(__VA_ARGS__);                                   \
  }
WRITER(write, (int file, const void* bytes, size_t count), file, bytes, count)
WRITER(pwrite, (int file, const void* bytes, size_t count, off_t at), file, bytes, count, at)
WRITER(pwrite64, (int file, const void* bytes, size_t count, off64_t at), file, bytes, count, at)
WRITER(writev, (int file, const struct iovec* pieces, int count), file, pieces, count)
WRITER(pwritev, (int file, const struct iovec* pieces, int count, off_t at), file, pieces, count, at)
WRITER(pwritev64, (int file, const struct iovec* pieces, int count, off64_t at), file, pieces, count, at)

int fsync(int file) {
  int (*const next)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  if (number("FAIL_SYNC") == 0 || !in_folder(file)) return next(file);
  errno = EIO;
  return -1;
}

__attribute__((destructor)) static void tell(void) {
  const char* const name = getenv("FAIL_COUNTED");
  FILE* const to = name && calls > 0 ? fopen(name, "w") : NULL;
  if (!to) return;
  fprintf(to, "%d\n", calls);
  fclose(to);
}

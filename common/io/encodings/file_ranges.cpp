// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/file_ranges.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "tetwright/error.h"

namespace tetwright {

namespace {

int open_to_read(const std::string& path) {
  int file = -1;
  do file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // opening a pipe must not wait
  while (file < 0 && errno == EINTR);
  return file;
}

}  // namespace

void ByteRanges::check_range(std::uint64_t offset, std::size_t n) const {
  if (offset > size() || n > size() - offset)
    throw InputError(name() + ": " + std::to_string(n) + " bytes at byte " + std::to_string(offset) +
                     " are needed, but the file has " + std::to_string(size()) + "; it is truncated");
}

ByteBuffer ByteRanges::bytes(std::uint64_t offset, std::size_t n) const {
  check_range(offset, n);
  ByteBuffer out(n);
  read(offset, out.data.get(), n);
  return out;
}

ByteBuffer ByteRanges::head(std::size_t n) const {
  return bytes(0, static_cast<std::size_t>(std::min<std::uint64_t>(n, size())));
}

FileRanges::FileRanges(const std::string& path) : FileRanges(path, open_to_read(path)) {}

FileRanges::FileRanges(std::string path, int file) : path_(std::move(path)), file_(file) {
  if (file_ < 0) throw InputError("cannot read " + path_ + ": " + std::strerror(errno));
  struct stat status;
  const char* problem = nullptr;
  if (fstat(file_, &status) != 0)
    problem = std::strerror(errno);
  else if (S_ISDIR(status.st_mode))
    problem = "it is a folder";
  else if (!S_ISREG(status.st_mode))
    problem = "it is not a regular file";
  if (problem) {
    close(file_);
    throw InputError("cannot read " + path_ + ": " + problem);
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileRanges::~FileRanges() { close(file_); }

std::unique_ptr<ByteRanges> FileRanges::if_there(const std::string& path) {
  const int file = open_to_read(path);
  if (file < 0 && (errno == ENOENT || errno == ENOTDIR)) return nullptr;
  return std::unique_ptr<ByteRanges>(new FileRanges(path, file));
}

void FileRanges::read(std::uint64_t offset, char* to, std::size_t n) const {
  check_range(offset, n);
  while (n > 0) {
    const ssize_t got = pread(file_, to, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw InputError("cannot read " + path_ + ": " + std::strerror(errno));
    if (got == 0)
      throw InputError(path_ + ": the file ends at byte " + std::to_string(offset) +
                       "; it was truncated while it was read");
    to += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

}  // namespace tetwright

#include "common/formats/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "common/error.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw OutputError("cannot write " + path + ": " + what + (error ? ": " : "") +
                    (error ? std::strerror(error) : ""));
}

/// The file that a chain of links leads to; it need not exist.
std::string link_target(const std::string& path) {
  fs::path target = path;
  std::error_code error;
  // As many links as the system itself follows.
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(target, error)); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) fail(path, "the link can't be followed", error.value());
    target = target.parent_path() / next;  // an absolute `next` replaces it all
  }
  if (fs::is_symlink(fs::symlink_status(target, error))) fail(path, "too many links", ELOOP);
  return target.string();
}

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// While any lives, going over the file size limit is an error of write() instead of the end of the process.
class FileSizeSignalIgnored {
 public:
  FileSizeSignalIgnored() {
    const std::lock_guard lock(mutex_);
    if (users_++ == 0) {
      struct sigaction ignore = {};
      ignore.sa_handler = SIG_IGN;
      sigaction(SIGXFSZ, &ignore, &before_);
    }
  }
  ~FileSizeSignalIgnored() {
    const std::lock_guard lock(mutex_);
    if (--users_ == 0) sigaction(SIGXFSZ, &before_, nullptr);
  }
  FileSizeSignalIgnored(const FileSizeSignalIgnored&) = delete;
  FileSizeSignalIgnored& operator=(const FileSizeSignalIgnored&) = delete;

 private:
  static inline std::mutex mutex_;
  static inline int users_ = 0;
  static inline struct sigaction before_ = {};
};

/// A file that is removed again unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& folder) {
    static std::atomic<unsigned> number{0};
    // Other processes may be at work in the same folder; a crashed one may have had our number.
    for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt) {
      path_ = folder + "/.tetwright-" + std::to_string(getpid()) + "-" + std::to_string(number++) + ".tmp";
      file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file_ < 0 && errno != EEXIST) break;
    }
  }
  ~TemporaryFile() {
    const bool opened = file_ >= 0 || closed_;
    if (file_ >= 0) ::close(file_);
    if (opened && !kept_) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int file() const { return file_; }
  const std::string& path() const { return path_; }
  int close() {
    const int result = ::close(file_);
    file_ = -1;
    closed_ = true;
    return result;
  }
  void keep() { kept_ = true; }

 private:
  std::string path_;
  int file_ = -1;
  bool closed_ = false;
  bool kept_ = false;
};

/// Some systems refuse more than 2 GiB at once.
constexpr std::size_t piece_size = std::size_t{1} << 30;

}  // namespace

void check_output_file(const std::string& path) {
  const std::string target = link_target(path);
  struct stat status;
  if (stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, "it is a folder", 0);
    if (!S_ISREG(status.st_mode)) fail(path, "it is not a regular file", 0);
    if (access(target.c_str(), W_OK) != 0) fail(path, "the file there is protected", errno);
  } else if (errno != ENOENT) {
    fail(path, "can't be looked at", errno);
  }
  const std::string folder = folder_of(target);
  if (stat(folder.c_str(), &status) != 0) fail(path, "folder " + folder, errno);
  if (!S_ISDIR(status.st_mode)) fail(path, folder + " is not a folder", 0);
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(path, "folder " + folder + " is not writable", errno);
}

void write_file_atomically(const std::string& path, std::string_view bytes) {
  write_file_atomically(path, [&](const ByteSink& sink) { sink(bytes); });
}

void write_file_atomically(const std::string& path, const std::function<void(const ByteSink&)>& content) {
  check_output_file(path);
  const std::string target = link_target(path);
  const FileSizeSignalIgnored ignored;
  TemporaryFile temporary(folder_of(target));
  if (temporary.file() < 0) fail(path, "no file can be made in its folder", errno);
  struct stat status;
  if (stat(target.c_str(), &status) == 0 && fchmod(temporary.file(), status.st_mode & 07777) != 0)
    fail(path, "permissions", errno);
  content([&](std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(temporary.file(), bytes.data(), std::min(bytes.size(), piece_size));
      if (written < 0) {
        if (errno == EINTR) continue;
        fail(path, "writing failed", errno);
      }
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  });
  if (fsync(temporary.file()) != 0) fail(path, "syncing to the disk failed", errno);
  if (temporary.close() != 0) fail(path, "closing failed", errno);
  if (std::rename(temporary.path().c_str(), target.c_str()) != 0) fail(path, "renaming failed", errno);
  temporary.keep();
  // The new name reaches the disk with the folder; where that can't be synced the file is there all the same.
  const int folder = open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    (void)fsync(folder);
    close(folder);
  }
}

std::string read_whole_file(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 && errno == EINTR) throw Interrupted();
  if (file < 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
  struct Closer {
    int file;
    ~Closer() { close(file); }
  } const closer{file};
  struct stat status;
  if (fstat(file, &status) != 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw InputError("cannot read " + path + ": it is a folder");
  // A device need not have an end.
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    throw InputError("cannot read " + path + ": it is neither a regular file nor a pipe");
  std::string bytes;
  std::size_t used = 0;
  // One more than the size, so that the end is met without growing; a pipe's size is 0.
  bytes.resize(static_cast<std::size_t>(status.st_size) + 1);
  for (;;) {
    if (used == bytes.size()) bytes.resize(bytes.size() * 2 + 4096);
    const ssize_t n = read(file, bytes.data() + used, std::min(bytes.size() - used, piece_size));
    if (n < 0 && errno == EINTR)
      throw Interrupted();  // the only signals with a handler are those that cancel
    if (n < 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace tetwright

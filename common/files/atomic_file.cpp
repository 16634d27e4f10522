// SPDX-License-Identifier: Apache-2.0
#include "tetwright/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <utility>

#include "tetwright/error.h"
#include "tetwright/progress.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view standard_stream = "-";

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw OutputError("cannot write " + path + ": " + what + (error ? ": " : "") +
                    (error ? std::strerror(error) : ""));
}

/// Follows a chain of links to its target, which need not exist.
std::string link_target(const std::string& path) {
  fs::path target = path;
  std::error_code error;
  // 40 is the system's own limit on links.
  for (int i = 0; i < 40 && fs::is_symlink(fs::symlink_status(target, error)); ++i) {
    const fs::path next = fs::read_symlink(target, error);
    if (error) fail(path, "the link cannot be followed", error.value());
    target = target.parent_path() / next;  // an absolute `next` replaces the whole path
  }
  if (fs::is_symlink(fs::symlink_status(target, error))) fail(path, "too many links", ELOOP);
  return target.string();
}

std::string folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Makes write() fail at the file size limit during its lifetime, instead of ending the process.
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

/// Names of the temporary files, readable by a signal handler.
struct TemporaryName {
  std::atomic<bool> taken{false};
  /// Set once `path` is complete.
  std::atomic<bool> valid{false};
  std::array<char, 4001> path;
};
std::array<TemporaryName, 1024> temporary_names;

// Protocol between threads that create or rename files and abandon_output_files(). All accesses are
// sequentially consistent: either a thread sees `abandoned` and stops, or abandon_output_files() sees it in
// `changing` and waits for it.
std::atomic<bool> abandoned{false};
std::atomic<int> changing{0};
std::atomic<bool> any_committed{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void sleep_a_moment() noexcept {
  const timespec moment{0, 1'000'000};
  nanosleep(&moment, nullptr);
}

/// Marks the thread as creating or renaming files; abandon_output_files() waits until it is done. Signals
/// whose handlers may call abandon_output_files() are blocked in this thread, since the handler would wait
/// for itself.
class FolderChange {
 public:
  FolderChange() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGHUP, SIGINT, SIGTERM}) sigaddset(&ending, signal);
    pthread_sigmask(SIG_BLOCK, &ending, &before_);
    ++changing;
    if (!abandoned) return;
    // The process is about to end.
    --changing;
    for (;;) sleep_a_moment();
  }
  ~FolderChange() {
    --changing;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  FolderChange(const FolderChange&) = delete;
  FolderChange& operator=(const FolderChange&) = delete;

 private:
  sigset_t before_;
};

constexpr const char* temporary_ending = ".tmp";

std::string temporary_beginning(int process) { return ".tetwright-" + std::to_string(process) + "-"; }

/// A temporary file, removed in the destructor unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& folder) {
    static std::atomic<unsigned> number{0};
    // Other processes may write into this folder, and a crashed one may have had the same process number.
    for (int attempt = 0; attempt < 100 && file_ < 0; ++attempt) {
      path_ = folder + "/" + temporary_beginning(getpid()) + std::to_string(number++) + temporary_ending;
      const FolderChange change;
      file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file_ >= 0) {
        exists_ = true;
        register_name();
      } else if (errno != EEXIST) {
        break;
      }
    }
  }
  ~TemporaryFile() {
    if (file_ >= 0) ::close(file_);
    if (!exists_) return;
    unlink(path_.c_str());
    forget_name();
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  int file() const { return file_; }
  const std::string& path() const { return path_; }
  int close() {
    const int result = ::close(file_);
    file_ = -1;
    return result;
  }
  /// Returns false and sets errno on failure.
  bool rename_to(const std::string& target) {
    if (std::rename(path_.c_str(), target.c_str()) != 0) return false;
    exists_ = false;
    forget_name();
    return true;
  }

 private:
  void register_name() {
    for (TemporaryName& name : temporary_names) {
      if (path_.size() >= name.path.size() || name.taken.exchange(true)) continue;
      std::copy_n(path_.c_str(), path_.size() + 1, name.path.begin());
      name.valid = true;
      name_ = &name;
      return;
    }
  }
  void forget_name() {
    if (!name_) return;
    name_->valid = false;
    name_->taken = false;
    name_ = nullptr;
  }

  std::string path_;
  int file_ = -1;
  bool exists_ = false;
  TemporaryName* name_ = nullptr;
};

/// Bytes written between two checks for cancellation. Some systems reject more than 2 GiB in one call.
constexpr std::size_t piece_size = std::size_t{1} << 26;

/// Writes the content of an open file, and syncs it to disk.
/// \param path for messages
/// \param progress null: it cannot be cancelled
void write_content(int file, const std::string& path, const Progress* progress,
                   const std::function<void(const ByteSink&)>& content) {
  const FileSizeSignalIgnored ignored;
  content([&](std::string_view bytes) {
    while (!bytes.empty()) {
      if (progress) progress->throw_if_stopped();
      const ssize_t written = ::write(file, bytes.data(), std::min(bytes.size(), piece_size));
      if (written < 0) {
        if (errno == EINTR) continue;
        fail(path, "writing failed", errno);
      }
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  });
  if (fsync(file) != 0) fail(path, "syncing to the disk failed", errno);
}

/// Writes to standard output. The reader of a pipe receives the bytes at once, so they cannot be withdrawn.
void write_to_stdout(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), std::min(bytes.size(), piece_size));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("to standard output", "writing failed", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// Syncs new names in a folder to disk. A failure is ignored: the files exist all the same.
void sync_folder(const std::string& path) {
  const int folder = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  (void)fsync(folder);
  close(folder);
}

/// Reads all bytes up to the end of a file.
/// \param size expected number of bytes
std::string read_all(int file, const std::string& path, std::size_t size) {
  std::string bytes;
  std::size_t used = 0;
  // One byte more than the size, so that the end is detected without growing the buffer; a pipe's size is 0.
  bytes.resize(size + 1);
  for (;;) {
    if (used == bytes.size()) bytes.resize(bytes.size() * 2 + 4096);
    const ssize_t n = read(file, bytes.data() + used, std::min(bytes.size() - used, piece_size));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
    if (n == 0) break;
    used += static_cast<std::size_t>(n);
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

std::string real_path(const std::string& path) {
  std::error_code error;
  fs::path target = fs::absolute(path, error);
  try {
    target = link_target(target.string());  // also if the target does not exist, unlike weakly_canonical()
  } catch (const OutputError&) {
    return target.string();  // links form a cycle
  }
  const fs::path whole = fs::weakly_canonical(target, error);
  return (error ? target.lexically_normal() : whole).string();
}

void check_output_file(const std::string& path) {
  if (path == standard_stream) return;
  const std::string target = link_target(path);
  struct stat status;
  if (stat(target.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(path, "it is a folder", 0);
    if (!S_ISREG(status.st_mode)) fail(path, "it is not a regular file", 0);
    if (access(target.c_str(), W_OK) != 0) fail(path, "the existing file is write-protected", errno);
  } else if (errno != ENOENT) {
    fail(path, "cannot be examined", errno);
  }
  const std::string folder = folder_of(target);
  if (stat(folder.c_str(), &status) != 0) fail(path, "folder " + folder, errno);
  if (!S_ISDIR(status.st_mode)) fail(path, folder + " is not a folder", 0);
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(path, "folder " + folder + " is not writable", errno);
}

struct OutputFiles::Pending {
  explicit Pending(const std::string& named)
      : path(named), target(link_target(named)), temporary(folder_of(target)) {}

  std::string path;    ///< as the caller names it
  std::string target;  ///< with links followed
  TemporaryFile temporary;
};

OutputFiles::OutputFiles(const Progress* progress) : progress_(progress) {}
OutputFiles::~OutputFiles() = default;

void OutputFiles::write(const std::string& path, std::string_view bytes) {
  write(path, [&](const ByteSink& sink) { sink(bytes); });
}

void OutputFiles::write(const std::string& path, const std::function<void(const ByteSink&)>& content) {
  if (path == standard_stream) {
    content([&](std::string_view bytes) {
      if (progress_) progress_->throw_if_stopped();
      to_stdout_ += bytes;
    });
    return;
  }
  auto pending = make_pending(path);
  TemporaryFile& temporary = pending->temporary;
  write_content(temporary.file(), path, progress_, content);
  if (temporary.close() != 0) fail(path, "closing failed", errno);
  pending_.push_back(std::move(pending));
}

std::string OutputFiles::reserve(const std::string& path) {
  TETWRIGHT_CHECK(path != standard_stream);
  auto pending = make_pending(path);
  if (pending->temporary.close() != 0) fail(path, "closing failed", errno);
  pending_.push_back(std::move(pending));
  return fs::absolute(pending_.back()->temporary.path()).string();
}

std::unique_ptr<OutputFiles::Pending> OutputFiles::make_pending(const std::string& path) const {
  check_output_file(path);
  if (progress_) progress_->throw_if_stopped();
  auto pending = std::make_unique<Pending>(path);
  const int file = pending->temporary.file();
  if (file < 0) fail(path, "cannot create a file in its folder", errno);
  struct stat status;
  if (stat(pending->target.c_str(), &status) == 0 && fchmod(file, status.st_mode & 07777) != 0)
    fail(path, "permissions", errno);
  return pending;
}

void write_reserved_file(const std::string& temporary, const std::string& path,
                         const std::function<void(const ByteSink&)>& content, const Progress* progress) {
  // Not created here: if the folder is another one, nobody would find the file.
  const int file = open(temporary.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
  if (file < 0)
    fail(path, "its temporary file " + temporary + " is not seen; all processes must see the folder", errno);
  try {
    write_content(file, path, progress, content);
  } catch (...) {
    ::close(file);
    throw;
  }
  if (::close(file) != 0) fail(path, "closing failed", errno);
}

void OutputFiles::commit() {
  if (progress_) progress_->throw_if_stopped();
  write_to_stdout(std::exchange(to_stdout_, {}));
  {
    const FolderChange change;
    for (const std::unique_ptr<Pending>& pending : pending_) {
      if (!pending->temporary.rename_to(pending->target)) fail(pending->path, "renaming failed", errno);
      any_committed = true;
    }
  }
  for (const std::unique_ptr<Pending>& pending : pending_) sync_folder(folder_of(pending->target));
  pending_.clear();
}

void sync_folder_of(const std::string& path) { sync_folder(folder_of(path)); }

void write_file_atomically(const std::string& path, std::string_view bytes) {
  OutputFiles files;
  files.write(path, bytes);
  files.commit();
}

void write_file_atomically(const std::string& path, const std::function<void(const ByteSink&)>& content) {
  OutputFiles files;
  files.write(path, content);
  files.commit();
}

std::string read_standard_input() { return read_all(STDIN_FILENO, "standard input", 0); }

void remove_temporary_files(const std::string& path, int process) noexcept try {
  const std::string beginning = temporary_beginning(process);
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(real_path(path)), error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(beginning) && name.ends_with(temporary_ending)) fs::remove(entry.path(), error);
  }
} catch (...) {
  // Failure is harmless: the files only take space.
}

bool abandon_output_files() noexcept {
  abandoned = true;
  while (changing > 0) sleep_a_moment();
  for (const TemporaryName& name : temporary_names)
    if (name.valid) unlink(name.path.data());
  return any_committed;
}

std::string read_whole_file(const std::string& path) {
  int file = -1;
  // Opening a pipe waits for its writer; a signal that the host handles must not end the wait.
  do file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  while (file < 0 && errno == EINTR);
  if (file < 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
  struct Closer {
    int file;
    ~Closer() { close(file); }
  } const closer{file};
  struct stat status;
  if (fstat(file, &status) != 0) throw InputError("cannot read " + path + ": " + std::strerror(errno));
  if (S_ISDIR(status.st_mode)) throw InputError("cannot read " + path + ": it is a folder");
  // A device may have no end.
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode))
    throw InputError("cannot read " + path + ": it is neither a regular file nor a pipe");
  return read_all(file, path, static_cast<std::size_t>(status.st_size));
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/isolated_call.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// A call that has not returned by then hangs: the largest slices take about a second.
constexpr unsigned max_call_seconds = 120;

/// The first byte of the shared memory says that the call returned true. The buffer begins behind it,
/// aligned.
constexpr std::size_t head_bytes = 64;

/// Memory that the child shares with its parent.
class SharedBytes {
 public:
  explicit SharedBytes(std::size_t n)
      : size_(n + head_bytes),
        data_(mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    if (data_ == MAP_FAILED)
      throw OutputError("there is no memory for " + std::to_string(n) + " bytes of pixels");
  }
  ~SharedBytes() { munmap(data_, size_); }
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  volatile char& done() const { return *static_cast<volatile char*>(data_); }
  std::span<char> buffer() const { return {static_cast<char*>(data_) + head_bytes, size_ - head_bytes}; }

 private:
  std::size_t size_;
  void* data_;
};

/// A file in memory that receives what the child prints.
class PrintedText {
 public:
  PrintedText() : file_(memfd_create("messages", MFD_CLOEXEC)) {}
  ~PrintedText() {
    if (file_ >= 0) close(file_);
  }
  PrintedText(const PrintedText&) = delete;
  PrintedText& operator=(const PrintedText&) = delete;

  int file() const { return file_; }
  std::string first_line() const {
    std::array<char, 200> text;
    const ssize_t n = file_ >= 0 ? pread(file_, text.data(), text.size(), 0) : 0;
    const std::string_view all(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
    return std::string(all.substr(0, all.find('\n')));
  }

 private:
  int file_;
};

[[noreturn]] void run_child(const SharedBytes& shared, const PrintedText& printed,
                            const std::function<bool(std::span<char>)>& call) {
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM, SIGTERM, SIGINT})
    std::signal(signal, SIG_DFL);
  sigset_t alarm_only;
  sigemptyset(&alarm_only);
  sigaddset(&alarm_only, SIGALRM);
  sigprocmask(SIG_UNBLOCK, &alarm_only, nullptr);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  alarm(max_call_seconds);
  if (printed.file() >= 0) {
    dup2(printed.file(), STDERR_FILENO);
    dup2(printed.file(), STDOUT_FILENO);
  }
  try {
    shared.done() = call(shared.buffer()) ? 1 : 0;
  } catch (...) {
    shared.done() = 0;
  }
  _exit(0);
}

}  // namespace

IsolatedResult call_isolated(std::size_t bytes, const std::function<bool(std::span<char>)>& call) {
  const SharedBytes shared(bytes);
  const PrintedText printed;
  const pid_t child = fork();
  if (child < 0)
    throw OutputError(std::string("cannot start a process that decodes pixels: ") + std::strerror(errno));
  if (child == 0) run_child(shared, printed, call);
  int status = 0;
  // A host that waits for all its children leaves none to wait for; the shared memory says how it went.
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  IsolatedResult result{shared.done() == 1, {}, printed.first_line()};
  if (result.done) {
    result.bytes = ByteBuffer(bytes);
    std::memcpy(result.bytes.data.get(), shared.buffer().data(), bytes);
  }
  return result;
}

}  // namespace tetwright

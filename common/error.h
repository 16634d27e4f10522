#pragma once

#include <stdexcept>
#include <string>

namespace tetwright {

/// Exit statuses of the program; every error knows its own.
enum class ExitStatus : int {
  done = 0,
  short_of_request = 1,  ///< written, but not all that was asked for was reached
  usage = 2,
  bad_input = 3,
  nothing_to_mesh = 4,
  output_failed = 5,  ///< could not be written, or memory ran out
  interrupted = 130
};

/// Base of all errors a user can cause. `what()` is one line that names the file, the place and the value,
/// and says what to do.
class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& message) : std::runtime_error(message), status_(status) {}
  ExitStatus status() const noexcept { return status_; }

 private:
  ExitStatus status_;
};

/// The call is wrong: unknown extension, impossible option value.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitStatus::usage, message) {}
};

/// An input can't be read or makes no sense.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitStatus::bad_input, message) {}
  /// "file: line N: message" or, with line 0, "file: message".
  InputError(const std::string& file, std::size_t line, const std::string& message)
      : Error(ExitStatus::bad_input,
              file + (line ? ": line " + std::to_string(line) : std::string()) + ": " + message) {}
};

/// The input is valid but leaves nothing to mesh.
class NothingToMeshError : public Error {
 public:
  explicit NothingToMeshError(const std::string& message) : Error(ExitStatus::nothing_to_mesh, message) {}
};

/// The result could not be written, or memory ran out.
class OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(ExitStatus::output_failed, message) {}
};

/// The user cancelled; nothing was written.
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitStatus::interrupted, "interrupted, nothing was written") {}
};

namespace detail {
/// Ends the program with a message: a broken invariant is our own bug, and going on would hand out a wrong
/// mesh.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
}  // namespace detail

}  // namespace tetwright

/// Our own invariants, in every build.
#define TETWRIGHT_CHECK(condition) \
  ((condition) ? void(0) : ::tetwright::detail::check_failed(#condition, __FILE__, __LINE__))

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace tetwright {

/// Base of all errors that a user can cause. `what()` is one line that names the file, the place and the
/// value, and says what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The call is wrong: unknown extension, impossible option value.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// An input cannot be read or makes no sense.
class InputError : public Error {
 public:
  using Error::Error;
  /// "file: line N: message" or, with line 0, "file: message".
  InputError(const std::string& file, std::size_t line, const std::string& message)
      : Error(file + (line ? ": line " + std::to_string(line) : std::string()) + ": " + message) {}
};

/// The input is valid but leaves nothing to mesh.
class NothingToMeshError : public Error {
 public:
  using Error::Error;
};

/// The result could not be written, or memory ran out.
class OutputError : public Error {
 public:
  using Error::Error;
};

/// The user cancelled; nothing was written.
class Interrupted : public Error {
 public:
  Interrupted() : Error("interrupted, nothing was written") {}
};

/// The deadline of the work passed (Progress::set_deadline()).
class OutOfTime : public Error {
 public:
  OutOfTime() : Error("out of time") {}
  using Error::Error;
};

/// An invariant of this library is broken: a bug of ours, not of the caller. The objects that took part must
/// not be used any more; the host program goes on.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace detail {
/// Throws InternalError, which names the condition and the place in the source.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
}  // namespace detail

}  // namespace tetwright

/// Checks an invariant of ours, in every build: going on would hand out a wrong mesh.
#define TETWRIGHT_CHECK(condition) \
  ((condition) ? void(0) : ::tetwright::detail::check_failed(#condition, __FILE__, __LINE__))

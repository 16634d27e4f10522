// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace tetwright {

/// Base of all errors that a user can cause. `what()` is one line: the file, the location in it, the value
/// and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An invalid call: unknown extension, impossible option value.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// An input cannot be read or is invalid.
class InputError : public Error {
 public:
  using Error::Error;
  /// Composes "file: line N: message", or "file: message" if `line` is 0.
  InputError(const std::string& file, std::size_t line, const std::string& message)
      : Error(file + (line ? ": line " + std::to_string(line) : std::string()) + ": " + message) {}
};

/// The input is valid but contains nothing to mesh.
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

/// A broken invariant of this library: a bug in the library, not in the caller. The objects involved must not
/// be used any more; the host program can continue.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace detail {
/// \throws InternalError naming the condition and its source location; never returns
[[noreturn]] void check_failed(const char* condition, const char* file, int line);
}  // namespace detail

}  // namespace tetwright

/// Checks an invariant of this library in every build: continuing would return a wrong mesh.
#define TETWRIGHT_CHECK(condition) \
  ((condition) ? void(0) : ::tetwright::detail::check_failed(#condition, __FILE__, __LINE__))

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

class Progress;

/// Checks that a file can be written at `path`; changes nothing. Call it before any work.
/// \param path "-" (standard output) always passes
/// \throws OutputError unless the folder exists and is writable, and anything already at `path` is a writable
///   regular file or a link to one or to nothing
void check_output_file(const std::string& path);

/// Absolute path of the target of `path`, links followed: equal for all names of a file, whether or not it
/// exists. Hard links are not recognised.
std::string real_path(const std::string& path);

/// Receives the bytes of a file piece by piece.
using ByteSink = std::function<void(std::string_view)>;

/// Files that appear together or not at all, each of them whole.
///
/// write() puts a file beside its target, under a temporary name, and syncs it to disk; commit() renames all
/// of them over their targets. Until then the targets are untouched, and whatever ends the work (an
/// exception, a full disk, cancellation, abandon_output_files()) leaves nothing behind. Only a rename that
/// fails, or a machine that stops during commit(), can leave some files in place without the others, each of
/// them whole. SIGKILL leaves the temporary files (".tetwright-*.tmp").
///
/// "-" is standard output: its bytes are kept in memory and written by commit() before the first rename.
///
/// A link stays, and its target is replaced; the permissions of an existing file are kept. SIGXFSZ is ignored
/// during write(), for the whole process. Different objects may be used concurrently.
class OutputFiles {
 public:
  /// \param progress if it is cancelled, write() throws Interrupted before the next piece of at most 64 MB,
  ///   and commit() before its first rename; null: no cancellation
  explicit OutputFiles(const Progress* progress = nullptr);
  /// Removes what was not committed.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Writes one temporary file.
  /// \param content passes the bytes to its argument; its exceptions are rethrown, and the file is removed
  /// \throws OutputError if the file cannot be written
  void write(const std::string& path, const std::function<void(const ByteSink&)>& content);
  void write(const std::string& path, std::string_view bytes);

  /// Renames all files over their targets. Further files may be written afterwards.
  /// \throws OutputError if a file cannot be renamed
  void commit();

 private:
  struct Pending;
  const Progress* progress_;
  std::vector<std::unique_ptr<Pending>> pending_;
  std::string to_stdout_;
};

/// Writes one file whole or not at all, as OutputFiles does.
void write_file_atomically(const std::string& path, std::string_view bytes);
void write_file_atomically(const std::string& path, const std::function<void(const ByteSink&)>& content);

/// Removes the temporary files beside `path` of a process that ended without its own clean-up.
void remove_temporary_files(const std::string& path, int process) noexcept;

/// Removes the files that were written but not committed, for handlers of signals and of std::terminate that
/// end the process. Afterwards no other thread creates or renames a file, so that the process must end.
/// Async-signal-safe.
///
/// The handler's signal should be blocked while a file is created or renamed; SIGHUP, SIGINT and SIGTERM are,
/// in the thread that does so. Files beyond the 256th at a time, or with names beyond 4,000 bytes, are
/// unknown to this function.
/// \return whether the process has ever committed a file
bool abandon_output_files() noexcept;

/// Syncs the name of a new file to disk, as far as its folder allows.
void sync_folder_of(const std::string& path);

/// Reads a file or pipe to its end.
/// \throws InputError if it cannot be read or is neither
std::string read_whole_file(const std::string& path);

/// Reads standard input to its end.
/// \throws InputError
std::string read_standard_input();

}  // namespace tetwright

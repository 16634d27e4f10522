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

/// Receives the bytes of a file, piece by piece.
using ByteSink = std::function<void(std::string_view)>;

/// Files that appear together or not at all, each of them complete.
///
/// write() writes a file next to its target under a temporary name and syncs it to disk; commit() renames all
/// of them over their targets. Until then the targets are unchanged, and any abort (an exception, a full
/// disk, cancellation, abandon_output_files()) leaves no temporary file behind. Only a failed rename, or a
/// machine that stops during commit(), can leave some files replaced and others not, each of them complete.
/// SIGKILL leaves the temporary files (".tetwright-*.tmp").
///
/// "-" is standard output: its bytes are kept in memory and written by commit() before the first rename.
///
/// If a target is a link, the link stays and the file that it points to is replaced; an existing file's
/// permissions are kept. SIGXFSZ is ignored during write(), for the whole process. Different objects may be
/// used concurrently.
class OutputFiles {
 public:
  /// \param progress if it is cancelled, write() throws Interrupted before the next piece of at most 64 MB,
  ///   and commit() before its first rename; null: no cancellation
  explicit OutputFiles(const Progress* progress = nullptr);
  /// Removes the files that were not committed.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// Writes one temporary file.
  /// \param content passes the bytes to its argument; its exceptions are rethrown, and the file is removed
  /// \throws OutputError if the file cannot be written
  void write(const std::string& path, const std::function<void(const ByteSink&)>& content);
  void write(const std::string& path, std::string_view bytes);

  /// Makes the empty temporary file of a target for write_reserved_file(), in this process or another one, to
  /// be called before commit().
  /// \return absolute path of the temporary file
  /// \throws OutputError if it cannot be made
  std::string reserve(const std::string& path);

  /// Renames all files over their targets. Further files may be written afterwards.
  /// \throws OutputError if a file cannot be renamed
  void commit();

  const Progress* progress() const { return progress_; }

 private:
  struct Pending;
  std::unique_ptr<Pending> make_pending(const std::string& path) const;

  const Progress* progress_;
  std::vector<std::unique_ptr<Pending>> pending_;
  std::string to_stdout_;
};

/// Writes one file completely or not at all, as OutputFiles does.
void write_file_atomically(const std::string& path, std::string_view bytes);
void write_file_atomically(const std::string& path, const std::function<void(const ByteSink&)>& content);

/// Writes the content of a file that OutputFiles::reserve() made, and syncs it to disk. Any process that sees
/// its folder may do so, and different files may be written concurrently.
/// \param path the target, for messages
/// \throws OutputError if the file cannot be written, or is not there
/// \param progress as for OutputFiles
void write_reserved_file(const std::string& temporary, const std::string& path,
                         const std::function<void(const ByteSink&)>& content,
                         const Progress* progress = nullptr);

/// Removes temporary files next to `path` that belong to a process which ended without cleaning up.
void remove_temporary_files(const std::string& path, int process) noexcept;

/// Removes the files that were written but not committed, for handlers of signals and of std::terminate that
/// end the process. After the call no other thread can create or rename a file, so the process must end.
/// Async-signal-safe.
///
/// The handler's signal must be blocked while a file is created or renamed; SIGHUP, SIGINT and SIGTERM are
/// blocked in the thread that does so. Files beyond the 1,024th at a time, or with names longer than 4,000
/// bytes, are unknown to this function.
/// \return whether the process has ever committed a file
bool abandon_output_files() noexcept;

/// Syncs the name of a new file to disk, as far as its folder allows.
void sync_folder_of(const std::string& path);

/// Reads a file or pipe to its end.
/// \throws InputError if it cannot be read, or is neither a file nor a pipe
std::string read_whole_file(const std::string& path);

/// Reads standard input to its end.
/// \throws InputError if it cannot be read
std::string read_standard_input();

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

class Progress;

/// Throws OutputError unless a file can be written at `path` ("-" always can): its folder exists and is
/// writable, and what is already at `path` is a writable regular file, or a link to one or to nothing.
/// Changes nothing. To be called before any work.
void check_output_file(const std::string& path);

/// The absolute path of what `path` leads to, links followed: equal for all ways to name a file, whether or
/// not it exists. Not for hard links.
std::string real_path(const std::string& path);

/// Takes the bytes of a file piece by piece.
using ByteSink = std::function<void(std::string_view)>;

/// Files that appear together or not at all, each of them whole.
///
/// write() puts a file beside its target, under another name, and syncs it to the disk; commit() renames all
/// of them over their targets. Until then the targets are untouched, and whatever ends the work (an
/// exception, a full disk, cancelling, abandon_output_files()) leaves nothing behind. Only a rename that
/// fails, or a machine that stops during commit(), can leave some of the files in place without the others,
/// each of them whole; SIGKILL leaves the files under their other names (".tetwright-*.tmp").
///
/// "-" is standard output: its bytes are kept in memory and written by commit() before the first rename.
///
/// A link stays, and its target is replaced; the permissions of an existing file are kept. SIGXFSZ is ignored
/// during write(), for the whole process. Different objects may be used concurrently.
class OutputFiles {
 public:
  /// Once `progress` is cancelled, write() throws Interrupted before the next piece of at most 64 MB, and
  /// commit() before its first rename. Null: nothing is cancelled.
  explicit OutputFiles(const Progress* progress = nullptr);
  /// Removes what was not committed.
  ~OutputFiles();
  OutputFiles(const OutputFiles&) = delete;
  OutputFiles& operator=(const OutputFiles&) = delete;

  /// `content` hands the bytes over. What it throws is thrown on, and the file is removed. Throws OutputError
  /// if the file can't be written.
  void write(const std::string& path, const std::function<void(const ByteSink&)>& content);
  void write(const std::string& path, std::string_view bytes);

  /// Throws OutputError if a file can't be renamed. Further files may be written afterwards.
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

/// Removes what a process that has ended without its own clean-up has left beside the file `path`.
void remove_temporary_files(const std::string& path, int process) noexcept;

/// For handlers of signals and of std::terminate that end the process: removes the files that were written
/// but not committed. From then on no other thread creates or renames one, so that the process must end.
/// Returns whether any file was committed in the life of the process. Async-signal-safe.
///
/// The handler's signal should be blocked while a file is created or renamed; this is so for SIGHUP, SIGINT
/// and SIGTERM, in the thread that does it. Files beyond the 256th at a time, or with names beyond 4,000
/// bytes, are not known to this function.
bool abandon_output_files() noexcept;

/// Brings the name of a new file to the disk, as far as its folder allows that.
void sync_folder_of(const std::string& path);

/// All bytes of a file or pipe. Throws InputError if it can't be read or is neither.
std::string read_whole_file(const std::string& path);

/// All bytes of standard input. Throws InputError.
std::string read_standard_input();

}  // namespace tetwright

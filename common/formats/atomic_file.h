#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace tetwright {

/// Throws OutputError unless a file can be written at `path`: its folder exists and is writable, and what is
/// there already is a writable regular file or a link to one or to nothing. Changes nothing. To be called
/// before any work.
void check_output_file(const std::string& path);

/// Writes a file whole or not at all: beside the target, synced to the disk, then renamed over it. A link
/// stays and its target is replaced; the permissions of an existing file are kept. On any failure (disk full,
/// file size limit) nothing is left behind, an existing file is untouched and OutputError is thrown. SIGXFSZ
/// is ignored meanwhile, for the whole process. Different files may be written concurrently.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Takes the bytes of a file piece by piece.
using ByteSink = std::function<void(std::string_view)>;
/// The same for a file that need not be in memory as a whole: `content` hands its bytes over. What that
/// throws is thrown on, and nothing is left behind then.
void write_file_atomically(const std::string& path, const std::function<void(const ByteSink&)>& content);

/// All bytes of a file. Throws InputError if it can't be read or is a folder.
std::string read_whole_file(const std::string& path);

}  // namespace tetwright

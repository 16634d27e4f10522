// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/zip_archive.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Numbers as text are compressed by a factor of 3 to 20; a file meant to exhaust memory by a thousand.
constexpr std::uint64_t max_packing = 200, unsuspected_size = 1 << 26;

std::string text_of(zip_error_t& error) {
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

void ZipArchive::Discard::operator()(zip* archive) const { zip_discard(archive); }

ZipArchive::ZipArchive(std::string_view bytes, std::string name) : name_(std::move(name)) {
  if (bytes.empty()) throw InputError(name_, 0, "the file is empty");  // libzip accepts it as an archive
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source) archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
  if (archive_) {
    zip_error_fini(&error);
    return;
  }
  if (source) zip_source_free(source);
  throw InputError(name_, 0, "not a ZIP archive: " + text_of(error) + "; the file is damaged or truncated");
}

bool ZipArchive::has(const std::string& path) const {
  return zip_name_locate(archive_.get(), path.c_str(), ZIP_FL_NOCASE) >= 0;
}

std::string ZipArchive::read(const std::string& path) const {
  const auto fail = [&](const std::string& why) {
    throw InputError(name_, 0, in_quotes(path) + " in it: " + why + "; the file is damaged, save it again");
  };
  const std::unique_ptr<zip_file_t, CloseFile> file(zip_fopen(archive_.get(), path.c_str(), ZIP_FL_NOCASE));
  if (!file) fail(zip_strerror(archive_.get()));
  zip_stat_t stat;
  if (zip_stat(archive_.get(), path.c_str(), ZIP_FL_NOCASE, &stat) != 0 || !(stat.valid & ZIP_STAT_COMP_SIZE))
    fail("its size is unknown");
  const std::uint64_t max_size = std::max<std::uint64_t>(unsuspected_size, max_packing * stat.comp_size);
  std::string content;
  std::array<char, 1 << 16> chunk;
  for (;;) {
    const zip_int64_t n = zip_fread(file.get(), chunk.data(), chunk.size());
    if (n < 0) fail(zip_file_strerror(file.get()));
    if (n == 0) return content;
    content.append(chunk.data(), static_cast<std::size_t>(n));
    if (content.size() > max_size)
      fail("it is compressed by a factor of more than " + std::to_string(max_packing));
  }
}

}  // namespace tetwright

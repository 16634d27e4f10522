// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/zip_writer.h"

#include <zip.h>

#include <memory>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// 1 January 1980, the first date that an archive can hold. Unlike a time in seconds it does not depend on
/// the machine's time zone.
constexpr zip_uint16_t first_dos_date = (1 << 5) | 1, first_dos_time = 0;

struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
struct DiscardZip {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

[[noreturn]] void fail_zip(const std::string& name, const char* why) {
  throw OutputError(name + ": cannot make the ZIP archive: " + why + "; free some memory");
}

void add_entry(zip_t* archive, const ZipEntry& entry, const std::string& name) {
  zip_source_t* const source = zip_source_buffer(archive, entry.bytes.data(), entry.bytes.size(), 0);
  if (!source) fail_zip(name, zip_strerror(archive));
  const zip_int64_t index = zip_file_add(archive, entry.path.c_str(), source, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(source);
    fail_zip(name, zip_strerror(archive));
  }
  const auto at = static_cast<zip_uint64_t>(index);
  if (zip_set_file_compression(archive, at, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive, at, first_dos_time, first_dos_date, 0) != 0)
    fail_zip(name, zip_strerror(archive));
}

}  // namespace

std::string zip_bytes(std::span<const ZipEntry> files, const std::string& name) {
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, FreeSource> target(zip_source_buffer_create(nullptr, 0, 0, &error));
  if (!target) fail_zip(name, "out of memory");
  zip_source_keep(target.get());  // the archive takes one reference
  std::unique_ptr<zip_t, DiscardZip> archive(zip_open_from_source(target.get(), ZIP_TRUNCATE, &error));
  if (!archive) {
    zip_source_free(target.get());
    fail_zip(name, "out of memory");
  }
  for (const ZipEntry& entry : files) add_entry(archive.get(), entry, name);
  if (zip_close(archive.get()) != 0) fail_zip(name, zip_strerror(archive.get()));
  (void)archive.release();  // NOLINT(bugprone-unused-return-value): zip_close() has freed it
  zip_stat_t stat;
  if (zip_source_stat(target.get(), &stat) != 0 || zip_source_open(target.get()) != 0)
    fail_zip(name, "it cannot be read back");
  std::string bytes(stat.size, '\0');
  const zip_int64_t read = zip_source_read(target.get(), bytes.data(), bytes.size());
  zip_source_close(target.get());
  if (read < 0 || static_cast<std::size_t>(read) != bytes.size()) fail_zip(name, "it cannot be read back");
  return bytes;
}

}  // namespace tetwright

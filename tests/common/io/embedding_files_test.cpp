// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>

#include "common/io/encodings/zip_archive.h"
#include "tests/common/temporary_folder.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright::embedding_files_test {
namespace {

const Embedding two_points{
    {7, 0}, {{1, 2, 3, 4}, {5, 6, 7, 4294967294}}, {{{0.1, 0.2, 0.3, 0.4}, {1, 0, 0, 0}}}, {0, 2.5e-300}};

/// Items of an array of NumPy; expects its type and shape.
template <class Number>
std::vector<Number> items(const ZipArchive& archive, const std::string& name, const std::string& header) {
  const std::string bytes = archive.read(name);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length =
      static_cast<unsigned char>(bytes[8]) + 256u * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0u);
  const std::string text = bytes.substr(10, length);
  EXPECT_EQ(text.substr(0, text.find_last_not_of(" \n") + 1), header);
  EXPECT_EQ(text.back(), '\n');
  std::vector<Number> numbers((bytes.size() - 10 - length) / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data() + 10 + length, numbers.size() * sizeof(Number));
  return numbers;
}

TEST(EmbeddingFiles, NpzHasTheArraysOfNumpy) {
  const TemporaryFolder folder;
  write_embedding(two_points, folder / "w.npz");
  const std::string bytes = contents(folder / "w.npz");
  const ZipArchive archive(bytes, "w.npz");
  EXPECT_EQ(
      items<std::int64_t>(archive, "tets.npy", "{'descr': '<i8', 'fortran_order': False, 'shape': (2,), }"),
      (std::vector<std::int64_t>{7, 0}));
  EXPECT_EQ(items<std::int64_t>(archive, "nodes.npy",
                                "{'descr': '<i8', 'fortran_order': False, 'shape': (2, 4), }"),
            (std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 4294967294}));
  EXPECT_EQ(
      items<double>(archive, "weights.npy", "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 4), }"),
      (std::vector<double>{0.1, 0.2, 0.3, 0.4, 1, 0, 0, 0}));
  EXPECT_EQ(
      items<double>(archive, "distances.npy", "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"),
      (std::vector<double>{0, 2.5e-300}));
}

TEST(EmbeddingFiles, NpzHasTheSameBytesInAllTimeZones) {
  const TemporaryFolder folder;
  std::vector<std::string> all;
  for (const char* zone : {"UTC", "XYZ-11", "ABC+9"}) {
    setenv("TZ", zone, 1);
    tzset();
    write_embedding(two_points, folder / "w.npz");
    all.push_back(contents(folder / "w.npz"));
  }
  unsetenv("TZ");
  tzset();
  EXPECT_EQ(all[0], all[1]);
  EXPECT_EQ(all[0], all[2]);
  // The date of the first entry is that of an archive without dates: 1 January 1980, 0 h.
  EXPECT_EQ(all[0].substr(10, 4), std::string("\x00\x00\x21\x00", 4));
}

TEST(EmbeddingFiles, JsonHasTheSameKeysAndNumbers) {
  const TemporaryFolder folder;
  write_embedding(two_points, folder / "w.JSON");
  const nlohmann::json j = nlohmann::json::parse(contents(folder / "w.JSON"));
  EXPECT_EQ(j.size(), 4u);
  EXPECT_EQ(j.at("tets").get<std::vector<Index>>(), two_points.tets);
  EXPECT_EQ(j.at("nodes").get<std::vector<Tet>>(), two_points.nodes);
  EXPECT_EQ((j.at("weights").get<std::vector<std::array<double, 4>>>()), two_points.weights);
  EXPECT_EQ(j.at("distances").get<std::vector<double>>(), two_points.distances);
}

TEST(EmbeddingFiles, OtherExtensionsAreRefused) {
  const TemporaryFolder folder;
  for (const char* file : {"w.txt", "w", "w.npy"}) {
    EXPECT_THROW(check_embedding_path(folder / file), UsageError) << file;
    EXPECT_THROW(write_embedding(two_points, folder / file), UsageError) << file;
  }
  EXPECT_THROW(check_embedding_path(folder / "w.npz", "zip"), UsageError);
  EXPECT_THROW(check_embedding_path(folder / "none/w.npz"), OutputError);
  check_embedding_path(folder / "w.txt", "npz");
  check_embedding_path("-", ".json");
  EXPECT_EQ(folder.entries(), 0u);
}

}  // namespace
}  // namespace tetwright::embedding_files_test

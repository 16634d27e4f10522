// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/chunked_source.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/common/io/volume_boxes.h"

namespace tetwright::chunked_source_test {
namespace {

/// Allocations of this thread up to the one that fails, or 0.
thread_local int allocations_to_failure = 0;

}  // namespace
}  // namespace tetwright::chunked_source_test

// Not inlined, since GCC would then take a pair of operators for mismatched functions.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  int& left = tetwright::chunked_source_test::allocations_to_failure;
  if (left > 0 && --left == 0) throw std::bad_alloc();
  if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(bytes > 0 ? bytes : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*bytes*/) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept {
  std::free(memory);
}

namespace tetwright::chunked_source_test {
namespace {

TEST(ChunkCache, KeepsTheChunksThatWereUsedLast) {
  ChunkCache cache(1000);
  int loads = 0;
  const auto get = [&](std::uint64_t key) {
    return cache.get(key, [&] {
      ++loads;
      return ByteBuffer(400);
    });
  };
  (void)get(1);
  (void)get(2);
  (void)get(1);
  EXPECT_EQ(loads, 2);
  (void)get(3);  // 2 goes
  (void)get(1);
  EXPECT_EQ(loads, 3);
  (void)get(2);
  EXPECT_EQ(loads, 4);
}

TEST(ChunkCache, ChunksLargerThanTheCacheAreNotKept) {
  ChunkCache cache(100);
  int loads = 0;
  for (int i = 0; i < 3; ++i) {
    const auto chunk = cache.get(1, [&] {
      ++loads;
      return ByteBuffer(400);
    });
    EXPECT_EQ(chunk->size, 400u);
  }
  EXPECT_EQ(loads, 3);
}

TEST(ChunkCache, NothingIsKeptOfALoadThatFails) {
  ChunkCache cache(1000);
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(
        error_of<InputError>([&] { (void)cache.get(1, []() -> ByteBuffer { throw InputError("bad"); }); }),
        "bad");
  EXPECT_EQ(cache.get(1, [] { return ByteBuffer(7); })->size, 7u);
}

TEST(ChunkCache, ChunksThatCannotBeKeptAreLoadedAgain) {
  int failures = 0;
  for (int n = 1; n <= 4; ++n) {
    ChunkCache cache(1000);
    const auto fails_after_loading = [&] {
      ByteBuffer buffer(7);
      allocations_to_failure = n;
      return buffer;
    };
    try {
      (void)cache.get(1, fails_after_loading);
    } catch (const std::bad_alloc&) {
      ++failures;
    }
    allocations_to_failure = 0;
    EXPECT_EQ(cache.get(1, [] { return ByteBuffer(7); })->size, 7u);
  }
  EXPECT_GE(failures, 2);  // the chunk itself, and its key among those that were used
}

TEST(ChunkCache, SeveralThreadsLoadAChunkOnce) {
  ChunkCache cache(1 << 20);
  std::atomic<int> loads = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (std::uint64_t key = 0; key < 200; ++key) {
        const auto chunk = cache.get(key, [&] {
          ++loads;
          return ByteBuffer(static_cast<std::size_t>(key));
        });
        EXPECT_EQ(chunk->size, key);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(loads, 200);
}

TEST(ChunkedSource, ChunkSizesThatOverflowAreRefused) {
  const auto bytes = [](std::vector<std::int64_t> size, std::size_t each) {
    return checked_chunk_bytes(size, each, "f");
  };
  EXPECT_EQ(bytes({3, 4, 5}, 8), 480);
  EXPECT_EQ(bytes({2147483647, 1, 1}, 1), 2147483647);
  for (const auto& size : std::vector<std::vector<std::int64_t>>{
           {2147483647, 2, 1}, {65536, 32768, 1}, {INT64_MAX, INT64_MAX, INT64_MAX}})
    EXPECT_NE(error_of<InputError>([&] { (void)bytes(size, 1); }).find("smaller chunks"), std::string::npos);
  for (const std::int64_t n : {std::int64_t{0}, std::int64_t{-1}, INT64_MIN})
    EXPECT_NE(error_of<InputError>([&] {
                (void)bytes({4, n, 4}, 1);
              }).find("chunks have the size"),
              std::string::npos);
}

}  // namespace
}  // namespace tetwright::chunked_source_test

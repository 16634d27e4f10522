// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Deterministic reservations: one word for each vertex, with the number of the last winner that claimed it
/// (Blelloch, Fineman, Gibbons & Shun 2012, "Internally deterministic parallel algorithms can be fast").
/// Winners are numbered consecutively over all batches, so old words need not be cleared.
class Reservations {
 public:
  /// Frees all vertices.
  ///
  /// \param first number of the first winner, for tests.
  /// \pre No task runs.
  void reset(std::size_t vertices, std::uint32_t first = 1) {
    words_.assign(vertices, 0);
    first_ = next_ = first;
  }
  void reserve(std::size_t vertices) { words_.reserve(vertices); }
  /// Adds free vertices.
  void grow(std::size_t vertices) { words_.resize(vertices, 0); }
  /// Frees all vertices.
  ///
  /// \param items max number of winners of the batch.
  void begin_batch(std::size_t items);

  /// Whether no winner of this batch has claimed a vertex of the read set.
  bool free(std::span<const Index> read_set) const {
#ifndef TETWRIGHT_IGNORE_RESERVATIONS  // only for the test that checks that other tests detect this
    for (Index v : read_set)
      if (words_[v] >= first_) return false;
#else
    (void)read_set;
#endif
    return true;
  }
  /// Claims a write set for the next winner. It may include vertices claimed by earlier winners: none of
  /// these is in the read set, so their commits do not change the data that was read.
  void claim(std::span<const Index> write_set) {
    for (Index v : write_set) words_[v] = next_;
    ++next_;
  }

 private:
  std::vector<std::uint32_t> words_;
  std::uint32_t first_ = 1;  ///< the number of the batch's first winner
  std::uint32_t next_ = 1;
};

/// Asserts, in builds without NDEBUG, the rule that makes results independent of threads: a thread that
/// decides writes nothing, and one that commits writes only its write set. A violation throws InternalError
/// immediately. Does nothing in release builds.
class WriteRule {
 public:
#ifndef NDEBUG
  /// During its lifetime, this thread must not write.
  class Deciding {
   public:
    Deciding();
    ~Deciding();
    Deciding(const Deciding&) = delete;
    Deciding& operator=(const Deciding&) = delete;
  };
  /// During its lifetime, this thread may write only these vertices.
  class Committing {
   public:
    explicit Committing(std::span<const Index> write_set);
    ~Committing();
    Committing(const Committing&) = delete;
    Committing& operator=(const Committing&) = delete;
  };
  static void check(Index vertex);
  /// Checks a write to data that no vertex guards.
  static void check();
#else
  struct Deciding {
    Deciding() {}
    ~Deciding() {}
  };
  struct Committing {
    explicit Committing(std::span<const Index>) {}
    ~Committing() {}
  };
  static void check(Index) {}
  static void check() {}
#endif
};

}  // namespace tetwright

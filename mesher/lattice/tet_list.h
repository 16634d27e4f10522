// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tetwright/resources.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A list of tets, stored in pieces of equal size. The lattice is the largest array; pieces allow it to be
/// freed gradually while it is copied or converted.
class TetList {
 public:
  static constexpr std::size_t piece_size = 1 << 15;

  TetList() = default;
  /// Concatenates the parts, freeing each as soon as it is copied.
  explicit TetList(std::vector<std::vector<Tet>> parts) {
    for (std::vector<Tet>& part : parts) {
      append(part);
      std::vector<Tet>().swap(part);
    }
  }

  std::size_t size() const { return size_; }
  const Tet& operator[](std::size_t i) const { return pieces_[i / piece_size][i % piece_size]; }

  std::size_t piece_count() const { return pieces_.size(); }
  /// The tets from piece * piece_size on.
  std::span<const Tet> piece(std::size_t piece) const { return pieces_[piece]; }
  /// Frees a piece, whose tets must not be read afterwards. Different pieces may be freed concurrently.
  void give_back(std::size_t piece) { std::vector<Tet>().swap(pieces_[piece]); }

  /// Keeps the tets for which `keep(tet)` is true, in order. `keep` is called concurrently.
  template <class Keep>
  void keep_if(Keep&& keep) {
    parallel_for(0, pieces_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        std::erase_if(pieces_[p], [&](const Tet& t) { return !keep(t); });
    });
    *this = TetList(std::move(pieces_));
  }

  /// keep_if() for the list and for a flag of each of its tets.
  template <class Keep>
  void keep_if(Keep&& keep, std::vector<std::uint8_t>& flags) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i)
      if (keep((*this)[i])) flags[kept++] = flags[i];
    flags.resize(kept);
    keep_if(keep);
  }

  /// A copy of all tets.
  std::vector<Tet> all() const {
    std::vector<Tet> tets;
    for (const std::vector<Tet>& piece : pieces_) tets.insert(tets.end(), piece.begin(), piece.end());
    return tets;
  }

 private:
  void append(std::span<const Tet> tets) {
    while (!tets.empty()) {
      if (size_ == pieces_.size() * piece_size) pieces_.emplace_back().reserve(piece_size);
      const std::size_t n = std::min(tets.size(), pieces_.size() * piece_size - size_);
      pieces_.back().insert(pieces_.back().end(), tets.begin(),
                            tets.begin() + static_cast<std::ptrdiff_t>(n));
      tets = tets.subspan(n);
      size_ += n;
    }
  }

  std::vector<std::vector<Tet>> pieces_;
  std::size_t size_ = 0;
};

}  // namespace tetwright

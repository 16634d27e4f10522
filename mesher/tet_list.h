#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "common/parallel.h"
#include "common/types.h"

namespace tetwright {

/// A list of tets in pieces of equal size: the lattice is the largest thing there is, and in pieces it need
/// not be there twice while it is made, or while something else is made of it.
class TetList {
 public:
  static constexpr std::size_t piece_size = 1 << 15;

  TetList() = default;
  /// The parts strung together; each is given back as soon as it is copied.
  explicit TetList(std::vector<std::vector<Tet>> parts) {
    for (std::vector<Tet>& part : parts) {
      append(part);
      std::vector<Tet>().swap(part);
    }
  }

  std::size_t size() const { return size_; }
  const Tet& operator[](std::size_t i) const { return pieces_[i / piece_size][i % piece_size]; }

  std::size_t piece_count() const { return pieces_.size(); }
  /// The tets piece * piece_size and following.
  std::span<const Tet> piece(std::size_t piece) const { return pieces_[piece]; }
  /// Gives the memory of a piece back; its tets are not to be read any more. Different pieces concurrently.
  void give_back(std::size_t piece) { std::vector<Tet>().swap(pieces_[piece]); }

  /// Leaves the tets for which `keep(tet)` is true, in their order; it is called concurrently.
  template <class Keep>
  void keep_if(Keep&& keep) {
    parallel_for(0, pieces_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        std::erase_if(pieces_[p], [&](const Tet& t) { return !keep(t); });
    });
    *this = TetList(std::move(pieces_));
  }

  /// A copy of all of them.
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

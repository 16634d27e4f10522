// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "mesher/lattice/tet_list.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The incident tets of points near interfaces. Each row of tet numbers is stored as differences in a
/// variable-length code: 7 bits per byte, low bits first, about 1.5 bytes per number.
class StarMap {
 public:
  /// The numbers of the tets around a point, ascending.
  class Tets {
   public:
    class Iterator {
     public:
      using iterator_category = std::forward_iterator_tag;
      using value_type = Index;
      using difference_type = std::ptrdiff_t;
      using pointer = const Index*;
      using reference = Index;

      Iterator() = default;
      /// \pre at least one more byte is readable after the row
      explicit Iterator(const std::uint8_t* at) : at_(at), next_(at) { read(); }
      static Iterator end(const std::uint8_t* at) {
        Iterator end;
        end.at_ = at;
        return end;
      }
      Index operator*() const { return value_; }
      Iterator& operator++() {
        at_ = next_;
        read();
        return *this;
      }
      Iterator operator++(int) {
        const Iterator before = *this;
        ++*this;
        return before;
      }
      bool operator==(const Iterator& o) const { return at_ == o.at_; }

     private:
      void read() {
        Index step = *next_++;
        if (step & 0x80) {
          step &= 0x7f;
          for (unsigned shift = 7;; shift += 7) {
            const Index more = *next_++;
            step |= (more & 0x7f) << shift;
            if (!(more & 0x80)) break;
          }
        }
        value_ += step;
      }

      const std::uint8_t *at_ = nullptr, *next_ = nullptr;
      Index value_ = 0;
    };

    Tets(const std::uint8_t* begin, const std::uint8_t* end) : begin_(begin), end_(end) {}
    Iterator begin() const { return Iterator(begin_); }
    Iterator end() const { return Iterator::end(end_); }

   private:
    const std::uint8_t *begin_, *end_;
  };

  StarMap() = default;
  /// \param points ascending
  /// \param point_count number of all points, listed or not
  StarMap(std::vector<Index> points, std::size_t point_count, const TetList& tets);

  const std::vector<Index>& points() const { return points_; }  ///< ascending
  bool lists(Index point) const { return slots_[point] != no_index; }
  Index slot(Index point) const { return slots_[point]; }  ///< index in points(), or no_index
  /// The tets around a listed point.
  Tets tets(Index point) const {
    const Index s = slots_[point], chunk = s / chunk_rows;
    const std::uint8_t* bytes = chunks_[chunk].data();
    return {bytes + offsets_[s + chunk], bytes + offsets_[s + chunk + 1]};
  }
  /// Frees the rows; tets() must not be called afterwards.
  void forget_tets() {
    std::vector<std::vector<std::uint8_t>>().swap(chunks_);
    std::vector<std::uint32_t>().swap(offsets_);
  }

 private:
  static constexpr Index chunk_rows = 4096;

  std::vector<Index> points_, slots_;
  std::vector<std::vector<std::uint8_t>> chunks_;  ///< rows of chunk_rows slots, then one padding byte
  std::vector<std::uint32_t> offsets_;             ///< of rows in their chunk, and of each chunk's end
};

}  // namespace tetwright

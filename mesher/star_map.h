#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

#include "common/types.h"
#include "mesher/tet_list.h"

namespace tetwright {

/// For the points near interfaces the tets they belong to. A row of tets is kept as the steps from one number
/// to the next, 7 bits to a byte, the low ones first: 1.5 bytes for most.
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
      /// Behind each row there is at least one more byte to be read.
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
  /// `points` ascending; `point_count` in all.
  StarMap(std::vector<Index> points, std::size_t point_count, const TetList& tets);

  const std::vector<Index>& points() const { return points_; }  ///< ascending
  bool lists(Index point) const { return slots_[point] != no_index; }
  Index slot(Index point) const { return slots_[point]; }  ///< place in points(), or no_index
  /// The tets around a listed point.
  Tets tets(Index point) const {
    const Index s = slots_[point], block = s / block_rows;
    const std::uint8_t* bytes = blocks_[block].data();
    return {bytes + offsets_[s + block], bytes + offsets_[s + block + 1]};
  }
  /// Gives the memory of the tets back; tets() is not to be called any more.
  void forget_tets() {
    std::vector<std::vector<std::uint8_t>>().swap(blocks_);
    std::vector<std::uint32_t>().swap(offsets_);
  }

 private:
  static constexpr Index block_rows = 4096;

  std::vector<Index> points_, slots_;
  std::vector<std::vector<std::uint8_t>> blocks_;  ///< the rows of so many slots each, then one byte
  std::vector<std::uint32_t> offsets_;             ///< of rows in their block, and of each block's end
};

}  // namespace tetwright

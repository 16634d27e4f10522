// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tetwright/prepare.h"
#include "tools/bricks/brick_part.h"
#include "tools/bricks/brick_scratch.h"

namespace tetwright {

/// The parts of all bricks of a round, in memory or in files. Bricks may be kept concurrently.
class BrickStore {
 public:
  /// \param boxes BrickBorder::brick of each brick
  /// \param scratch null: in memory. Must outlive this object, like `report`
  /// \param round from 1
  BrickStore(std::vector<CellBox> boxes, const BrickScratch* scratch, int round, BrickReport& report);

  std::size_t count() const { return boxes_.size(); }
  int round() const { return round_; }
  /// The border of a brick if a file has what the task asks for.
  std::optional<BrickBorder> finished(const BrickTask& task);
  /// Keeps a brick and returns its border.
  BrickBorder keep(std::size_t brick, BrickPart part);
  /// \param bytes to_bytes() of the brick
  BrickBorder keep(std::size_t brick, const std::string& bytes);
  /// A part that is kept. May be called concurrently, but not while parts are kept.
  /// \throws InputError if its file is damaged
  std::shared_ptr<const BrickPart> part(std::size_t brick) const;
  /// All parts without their borders, moved out of memory or read.
  /// \param meshes false: without the coarsened meshes
  std::vector<BrickPart> take(bool meshes = true);
  /// Keeps parts again that take() moved out of memory.
  void put_back(std::vector<BrickPart> parts);
  /// Frees the coarsened meshes in memory.
  void drop_meshes();

 private:
  void check(std::size_t brick, const BrickPart& part) const;
  BrickPart read(std::size_t brick, bool kept_surface) const;

  std::vector<CellBox> boxes_;
  const BrickScratch* scratch_;
  int round_;
  std::vector<BrickPart> parts_;
  std::vector<std::uint8_t> kept_surface_;  ///< by brick: BrickPart::kept_surface
  BrickReport& report_;
};

}  // namespace tetwright

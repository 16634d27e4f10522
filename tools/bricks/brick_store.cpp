// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_store.h"

#include <utility>

#include "tetwright/error.h"
#include "tools/bricks/brick_bytes.h"

namespace tetwright {

namespace {

void drop_mesh(BrickPart& part) {
  part.mesh = {};
  std::vector<std::uint8_t>().swap(part.flags);
}

}  // namespace

BrickStore::BrickStore(std::vector<CellBox> boxes, const BrickScratch* scratch, int round,
                       BrickReport& report)
    : boxes_(std::move(boxes)),
      scratch_(scratch),
      round_(round),
      parts_(boxes_.size()),
      kept_surface_(boxes_.size(), 0),
      report_(report) {}

std::optional<BrickBorder> BrickStore::finished(const BrickTask& task) {
  if (!scratch_ || !scratch_->has({task.brick, round_, task.keep_surface})) return {};
  try {
    BrickPart part = read(task.brick, task.keep_surface);
    if (part.border.halo < task.halo) return {};
    ++report_.resumed;
    kept_surface_[task.brick] = task.keep_surface;
    return std::move(part.border);
  } catch (const InputError&) {
    return {};  // damaged: it is made again
  }
}

BrickBorder BrickStore::keep(std::size_t brick, BrickPart part) {
  check(brick, part);
  kept_surface_[brick] = part.kept_surface;
  if (scratch_) scratch_->write({brick, round_, part.kept_surface}, to_bytes(part));
  BrickBorder border = std::move(part.border);
  part.border = {};
  if (!scratch_) parts_[brick] = std::move(part);
  return border;
}

BrickBorder BrickStore::keep(std::size_t brick, const std::string& bytes) {
  BrickPart part = brick_part(bytes, "brick " + std::to_string(brick));
  if (!scratch_) return keep(brick, std::move(part));
  check(brick, part);
  kept_surface_[brick] = part.kept_surface;
  scratch_->write({brick, round_, part.kept_surface}, bytes);
  return std::move(part.border);
}

std::shared_ptr<const BrickPart> BrickStore::part(std::size_t brick) const {
  if (scratch_) return std::make_shared<const BrickPart>(read(brick, kept_surface_[brick] != 0));
  return {std::shared_ptr<const BrickPart>(), &parts_[brick]};
}

std::vector<BrickPart> BrickStore::take(bool meshes) {
  std::vector<BrickPart> parts = std::exchange(parts_, std::vector<BrickPart>(boxes_.size()));
  for (std::size_t b = 0; b < boxes_.size(); ++b) {
    if (scratch_) parts[b] = read(b, kept_surface_[b] != 0);
    parts[b].border = {};
    if (!meshes) drop_mesh(parts[b]);
  }
  if (scratch_) report_.scratch_bytes = scratch_->used_bytes();
  return parts;
}

void BrickStore::put_back(std::vector<BrickPart> parts) {
  if (!scratch_) parts_ = std::move(parts);
}

void BrickStore::drop_meshes() {
  for (BrickPart& part : parts_) drop_mesh(part);
}

void BrickStore::check(std::size_t brick, const BrickPart& part) const {
  if (part.border.brick != boxes_[brick])
    throw InputError("brick " + std::to_string(brick), 0, "this is another brick; run the same call again");
}

BrickPart BrickStore::read(std::size_t brick, bool kept_surface) const {
  const BrickFile file{brick, round_, kept_surface};
  BrickPart part = brick_part(scratch_->read(file), scratch_->path(file));
  check(brick, part);
  return part;
}

}  // namespace tetwright

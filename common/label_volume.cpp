#include "common/label_volume.h"

namespace tetwright {

Vec3 LabelVolume::to_input(const Vec3& index) const { return origin + directions * index; }

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's own types behind openvdb_grids.h. Included only by openvdb_conversion.cpp and openvdb_grids.cpp,
// because OpenVDB's headers take long to compile.
#include <openvdb/openvdb.h>

#include <utility>

#include "mesher/level_sets/openvdb_grids.h"

namespace tetwright {

struct DistanceGrid::Impl {
  explicit Impl(openvdb::FloatGrid::Ptr made) : grid(std::move(made)) {}
  openvdb::FloatGrid::Ptr grid;
};

/// Must be called before any other function of OpenVDB; may be called repeatedly and concurrently.
void initialise_openvdb();

}  // namespace tetwright

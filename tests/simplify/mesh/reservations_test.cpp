// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/reservations.h"

#include <gtest/gtest.h>

#include <limits>

#include "simplify/mesh/free_slots.h"
#include "simplify/operations/insertion.h"
#include "tests/simplify/workbench.h"
#include "tetwright/error.h"

namespace tetwright::reservations_test {
namespace {

using Points = std::vector<Index>;

TEST(Reservations, WhatAnEarlierWinnerClaimedIsNotFree) {
  Reservations r;
  r.reset(10);
  r.begin_batch(3);
  EXPECT_TRUE(r.free(Points{0, 1, 2}));
  r.claim(Points{1, 2, 3});
  EXPECT_FALSE(r.free(Points{0, 1}));
  EXPECT_FALSE(r.free(Points{3}));
  EXPECT_TRUE(r.free(Points{0, 4}));
  r.claim(Points{3, 4});  // one vertex a second time
  EXPECT_FALSE(r.free(Points{3}));
  EXPECT_FALSE(r.free(Points{1}));
  r.begin_batch(3);
  EXPECT_TRUE(r.free(Points{0, 1, 2, 3, 4}));
  r.grow(20);
  EXPECT_TRUE(r.free(Points{19}));
  r.claim(Points{19});
  EXPECT_FALSE(r.free(Points{19}));
}

TEST(Reservations, NumbersOfWinnersBeginAnewBeforeTheyRunOut) {
  Reservations r;
  r.reset(10, std::numeric_limits<std::uint32_t>::max() - 4);
  r.claim(Points{5});  // a number higher than all later ones
  r.begin_batch(10);
  EXPECT_TRUE(r.free(Points{5}));
  for (Index p = 0; p < 10; ++p) {
    EXPECT_TRUE(r.free(Points{p}));
    r.claim(Points{p});
    EXPECT_FALSE(r.free(Points{p}));
  }
  r.begin_batch(3);
  for (Index p = 0; p < 10; ++p) EXPECT_TRUE(r.free(Points{p}));
}

TEST(FreeSlots, WhatIsGivenBackIsFreeAfterTheBatch) {
  FreeSlots slots;
  slots.reset(5, 7);
  EXPECT_EQ(slots.take(), 5u);
  slots.give_back(2);
  slots.give_back(3);
  EXPECT_EQ(slots.available(), 1u);
  EXPECT_EQ(slots.take(), 6u);
  EXPECT_EQ(slots.available(), 0u);
  slots.end_batch();
  EXPECT_EQ(slots.available(), 2u);
  EXPECT_EQ(slots.take(), 3u);
  slots.grow(2);
  EXPECT_EQ(slots.available(), 3u);
  EXPECT_EQ(slots.unused(), 2u);
  EXPECT_EQ(slots.take(), 2u);
  EXPECT_EQ(slots.take(), 7u);
  EXPECT_EQ(slots.take(), 8u);
}

#ifndef NDEBUG

TEST(WriteRule, WhoDecidesWritesNothing) {
  Workbench w(grid_mesh(2));
  const Index p = w.at(1, 1, 1), t = w.mesh.incident_tet(p);
  {
    const WriteRule::Deciding deciding;
    EXPECT_THROW(w.mesh.set_position(p, Vec3::Zero()), InternalError);
    EXPECT_THROW(w.mesh.set_incident_tet(p, t), InternalError);
    EXPECT_THROW(w.mesh.touch(p), InternalError);
    EXPECT_THROW(w.mesh.set_points(t, dead_tet), InternalError);
    EXPECT_THROW(w.mesh.set_link(t, 0, FaceLink()), InternalError);
    EXPECT_THROW(w.mesh.set_region(t, 0), InternalError);
    EXPECT_THROW(w.mesh.set_quality(t, 0), InternalError);
    EXPECT_THROW(w.mesh.change_count(1), InternalError);
  }
  w.mesh.touch(p);
  w.expect_sound();
}

TEST(WriteRule, ACommitWritesItsWriteSetAlone) {
  Workbench w(grid_mesh(2));
  const Index p = w.at(1, 1, 1), t = w.mesh.incident_tet(p);
  const Tet points = w.mesh.points(t);
  const Vec3 position = w.mesh.position(p);
  {
    const WriteRule::Committing one(std::span<const Index>(points).first(3));
    EXPECT_THROW(w.mesh.set_quality(t, 0), InternalError);  // the tet's fourth point is not claimed
    EXPECT_THROW(w.mesh.touch(points[3]), InternalError);
    EXPECT_THROW(w.mesh.set_link(t, 0, w.mesh.link(t, 0)), InternalError);
    w.mesh.set_link(t, 3, w.mesh.link(t, 3));  // the face of the three claimed points
    w.mesh.touch(points[0]);
  }
  {
    const WriteRule::Committing all(points);
    w.mesh.set_position(p, position);
    w.mesh.set_quality(t, w.mesh.quality(t));
    const Index other = w.at(0, 2, 0) == p ? w.at(2, 0, 0) : w.at(0, 2, 0);
    if (!contains(points, other)) {
      EXPECT_THROW(w.mesh.set_position(other, position), InternalError);
    }
  }
  w.expect_sound();
}

// A proposal that writes outside its write set is detected.
TEST(WriteRule, ACommitOutsideItsWriteSetThrows) {
  Workbench w(grid_mesh(2));
  make_bad(w);
  Proposal& p = w.ws->proposal;
  ASSERT_EQ(insert_in_tet(*w.ws, w.rules, 5, InsertionPlace::centre), Outcome::done);
  std::erase(p.write_set, w.mesh.points(5)[2]);
  p.read_set_size = p.write_set.size();
  w.begin_batch({&p});
  ASSERT_TRUE(w.admit(p));
  EXPECT_THROW(commit(w.mesh, w.grid, p, w.commit_workspace), InternalError);
}

#endif

}  // namespace
}  // namespace tetwright::reservations_test

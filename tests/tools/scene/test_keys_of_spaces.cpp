// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/keys_of_spaces.hpp"

using namespace delf;

TEST_CASE("each kind of space says why it does not read a key") {
  CHECK(why_unread(SpaceKind::circle, "lattice.sites").empty());
  CHECK(why_unread(SpaceKind::point, "lattice.sites") == "a point has neither length nor sites");
  CHECK(why_unread(SpaceKind::circle, "boundary.left") == "a circle has no walls");
  CHECK(why_unread(SpaceKind::interval, "boundary.winding") == "an interval has no winding");
  CHECK(why_unread(SpaceKind::interval, "lattice.mesh") == "only lattice.space = complex has a mesh");
  CHECK(why_unread(SpaceKind::mesh, "lattice.mesh").empty());
  CHECK(why_unread(SpaceKind::mesh, "run.until").empty());
  CHECK(why_unread(SpaceKind::still, "run.until") == "has no effect with lattice.time = none");
  CHECK(why_unread(SpaceKind::spacetime, "boundary.mesh") == "has no effect where sites have times of their own");
  CHECK(why_unread(SpaceKind::spacetime, "run.threads").empty());
  for (const char* key : {"lattice.sites", "run.threads", "initial.start", "output.section"})
    CHECK_FALSE(why_unread(SpaceKind::mesh, key).empty());
  CHECK(why_unread(SpaceKind::mesh, "boundary.left").empty());  // a part, which the mesh is asked for
}

TEST_CASE("a key that says of no space that it is read is of lattices alone") {
  for (const SpaceKind lattice : {SpaceKind::circle, SpaceKind::interval, SpaceKind::point})
    CHECK(why_unread(lattice, "scheme.seed_order").empty());
  for (const SpaceKind complex : {SpaceKind::mesh, SpaceKind::still, SpaceKind::spacetime})
    CHECK(why_unread(complex, "scheme.seed_order") ==
          "needs a regular lattice (not applicable to lattice.space = complex)");
}

TEST_CASE("every key is read by some kind of space") {
  for (const Parameter& key : keys()) {
    bool is_read = false;
    for (const SpaceKind kind : {SpaceKind::circle, SpaceKind::interval, SpaceKind::point, SpaceKind::mesh,
                                 SpaceKind::still, SpaceKind::spacetime})
      is_read = is_read || why_unread(kind, key.key).empty();
    INFO(key.key);
    CHECK(is_read);
  }
}

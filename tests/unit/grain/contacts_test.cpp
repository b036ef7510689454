#include "catch.hpp"

#include <dem/grain/contact_list.hpp>

TEST_CASE("the number of committed contacts is that of the last step, whatever the present one finds") {
  dem::ContactMemories<2> memories;
  CHECK(memories.committed() == 0);
  memories.now.make_room(3);
  memories.now.count = 3;
  CHECK(memories.committed() == 0);
  memories.commit();
  CHECK(memories.committed() == 3);
  memories.now.make_room(1);
  memories.now.count = 1;
  CHECK(memories.committed() == 3);
  memories.commit();
  CHECK(memories.committed() == 1);
}

TEST_CASE("histories that are committed by a copy leave this step's memory to others") {
  dem::ContactMemories<2> memories;
  memories.now.make_room(2);
  memories.now.count = 2;
  memories.now.key[0] = 3, memories.now.key[1] = 7;
  memories.now.history[1][1] = -0.25;
  memories.commit_copy();
  memories.now.key[0] = 4;
  CHECK(memories.committed() == 2);
  CHECK(memories.last.key[0] == 3);
  CHECK(memories.last.key[1] == 7);
  CHECK(memories.last.history[1][1] == -0.25);
  CHECK(memories.last.key.size() >= 2 + dem::pack_width);  // whole packs are read
}

#include "catch.hpp"

#include <dem/grain/contact_list.hpp>

TEST_CASE("the number of committed contacts is that of the last step, whatever the present one finds") {
  dem::ContactMemories<2> memories;
  CHECK(memories.committed() == 0);
  memories.make_room(3);
  memories.now.count = 3;
  CHECK(memories.committed() == 0);
  memories.commit();
  CHECK(memories.committed() == 3);
  memories.make_room(1);
  memories.now.count = 1;
  CHECK(memories.committed() == 3);
  memories.commit();
  CHECK(memories.committed() == 1);
}

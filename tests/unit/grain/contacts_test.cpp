#include "catch.hpp"

#include <dem/grain/contact_list.hpp>

TEST_CASE("the number of committed contacts is that of the last step, whatever the present one finds") {
  dem::HistoriesOfSteps<2> histories;
  CHECK(histories.committed() == 0);
  histories.now.make_room(3);
  histories.now.count = 3;
  CHECK(histories.committed() == 0);
  histories.commit();
  CHECK(histories.committed() == 3);
  histories.now.make_room(1);
  histories.now.count = 1;
  CHECK(histories.committed() == 3);
  histories.commit();
  CHECK(histories.committed() == 1);
}

TEST_CASE("histories that are committed by a copy leave this step's memory to others") {
  dem::HistoriesOfSteps<2> histories;
  histories.now.make_room(2);
  histories.now.count = 2;
  histories.now.key[0] = 3, histories.now.key[1] = 7;
  histories.now.history[1][1] = -0.25;
  histories.commit_copy();
  histories.now.key[0] = 4;
  CHECK(histories.committed() == 2);
  CHECK(histories.last.key[0] == 3);
  CHECK(histories.last.key[1] == 7);
  CHECK(histories.last.history[1][1] == -0.25);
  CHECK(histories.last.key.size() >= 2 + dem::pack_width);  // whole packs are read
}

#include <dem/core/short_list.hpp>

#include "catch.hpp"

#include <memory>

TEST_CASE("a short list keeps its items where its room ends, and beyond") {
  dem::ShortList<std::shared_ptr<int>, 4> list;
  const auto on_stack = [&] {
    const auto at = reinterpret_cast<std::uintptr_t>(list.items.data()), from = reinterpret_cast<std::uintptr_t>(&list);
    return at >= from && at < from + sizeof(list);
  };
  const auto shared = std::make_shared<int>(0);
  for (int k = 0; k < 40; ++k) {
    CHECK(on_stack() == (k <= 4));
    list.items.push_back(k % 2 == 0 ? std::make_shared<int>(k) : shared);
  }
  REQUIRE(list.items.size() == 40);
  for (int k = 0; k < 40; k += 2) CHECK(*list.items[static_cast<std::size_t>(k)] == k);
  CHECK(shared.use_count() == 21);
  list.items.clear();
  CHECK(shared.use_count() == 1);
}

#include "combinations/combinations.hpp"

TEMPLATE_PRODUCT_TEST_CASE("mixed grains come to rest under every law and weigh what they weigh", "",
                           (combinations::ElasticGrains, combinations::StickyGrains, combinations::PlasticGrains),
                           (combinations::SeveralKinds, combinations::SeveralOfPoints)) {
  combinations::pour<TestType>();
}

TEST_CASE("a bed of mixed grains goes on from a file on other threads in every bit") {
  combinations::check_threads<combinations::StickyGrains<combinations::SeveralKinds>>();
}

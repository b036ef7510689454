#include "world/combinations.hpp"

TEMPLATE_PRODUCT_TEST_CASE("polyhedra and mixed grains come to rest under every law and weigh what they weigh", "",
                           (combinations::ElasticGrains, combinations::StickyGrains, combinations::PlasticGrains),
                           (combinations::Polyhedron, combinations::SeveralKinds, combinations::SeveralOfPoints)) {
  combinations::pour<TestType>();
}

#include "world/combinations.hpp"

TEMPLATE_PRODUCT_TEST_CASE("grains of balls and superquadrics come to rest under every law and weigh what they weigh",
                           "", (combinations::ElasticGrains, combinations::StickyGrains, combinations::PlasticGrains),
                           (Cube8, combinations::Superquadric, combinations::SuperquadricPoints)) {
  combinations::pour<TestType>();
}

#include "combinations/combinations.hpp"

// Every kind of grain meets every law in a mixture, where grains of one kind touch each other as they do alone; alone
// each kind meets one.

TEMPLATE_TEST_CASE("grains come to rest under every law and weigh what they weigh", "",
                   combinations::StickyGrains<Cube8>, combinations::ElasticGrains<combinations::Superquadric>,
                   combinations::PlasticGrains<combinations::SuperquadricPoints>,
                   combinations::ElasticGrains<combinations::Polyhedron>) {
  combinations::pour<TestType>();
}

TEMPLATE_TEST_CASE("a bed of grains of any kind goes on from a file on other threads in every bit", "",
                   combinations::ElasticGrains<combinations::Superquadric>,
                   combinations::PlasticGrains<combinations::SuperquadricPoints>,
                   combinations::ElasticGrains<combinations::Polyhedron>) {
  combinations::check_threads<TestType>();
}

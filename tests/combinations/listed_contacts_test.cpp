#include "world/listed_contacts.hpp"
#include "combinations/combinations.hpp"

using listed::add_bed_and_plate;
using listed::check_listed;

// One model has every shape, a law with histories of all kinds, patches and searches that remember.
TEST_CASE("listed contacts of all shapes in one world add up to the forces, and asking changes nothing") {
  using All = combinations::ElasticGrains<combinations::SeveralKinds>;
  dem::World<All> w(options({0, 0, -g}, 3e-6));
  w.set_contact(combinations::constants_of<All>());
  w.add_species(Sphere(1e-3));
  w.add_species(dem::shape::cube8(0.8e-3));
  w.add_species(dem::shape::cube(0.8e-3));
  w.add_species(combinations::Superquadric({1e-3, 0.9e-3, 0.8e-3}, {4, 4, 4}));
  add_bed_and_plate(w, 2.1e-3, 4);
  REQUIRE(w.run(800));
  const auto count = check_listed(w);
  CHECK(count[0] > 40);
  CHECK(count[1] > 20);
}

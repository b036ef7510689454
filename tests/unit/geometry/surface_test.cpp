#include "core/error_of.hpp"
#include "surface_contacts.hpp"

#include <dem/geometry/box/box.hpp>
#include <dem/geometry/plane/plane.hpp>

#include <random>

using Catch::Approx;
using dem::Vec3;
using dem::surface::Box;
using dem::surface::Plane;

TEST_CASE("a sphere touches a plane from above, and from below too") {
  const Plane plane;
  check_one(surface_contacts(plane, {3, -4, 0.4}, 0.5), {0, 0, -1}, 0.4);
  check_one(surface_contacts(plane, {0, 0, -2.0}, 0.5), {0, 0, -1}, -2.0);  // deep inside it is pushed out all the same
  CHECK(surface_contacts(plane, {0, 0, 0.51}, 0.5).empty());
  CHECK(plane.near({0, 0, 0.4}, 0.5));
  CHECK(!plane.near({0, 0, 0.6}, 0.5));
  CHECK(plane.bounds().high.z() == 0.0);
}

TEST_CASE("a sphere touches a box once, on a face, an edge or a corner") {
  const Box box({2, 4, 6});
  CHECK(box.edges() == Vec3(2, 4, 6));
  check_one(surface_contacts(box, {0.3, 0.4, 3.4}, 0.5), {0, 0, -1}, 0.4);
  check_one(surface_contacts(box, {-1.4, 0.4, 0}, 0.5), {1, 0, 0}, 0.4);
  check_one(surface_contacts(box, {1.3, 2.4, 0}, 0.6), {-0.6, -0.8, 0}, 0.5);
  check_one(surface_contacts(box, {-1.1, -2.2, -3.2}, 0.4), Vec3(1, 2, 2) / 3, 0.3);
  CHECK(surface_contacts(box, {1.3, 2.4, 0}, 0.4).empty());
}

TEST_CASE("a sphere whose centre is inside a box leaves it through the nearest face") {
  const Box box({2, 4, 6});
  check_one(surface_contacts(box, {0.9, 0, 0}, 0.5), {-1, 0, 0}, -0.1);
  check_one(surface_contacts(box, {-0.9, 0, 0}, 0.5), {1, 0, 0}, -0.1);
  check_one(surface_contacts(box, {0, -1.8, 0}, 0.5), {0, 1, 0}, -0.2);
  check_one(surface_contacts(box, {0, 0, 2.7}, 0.5), {0, 0, -1}, -0.3);
  // The centre of a cube, and a point (a sphere of radius 0).
  REQUIRE(surface_contacts(Box({2, 2, 2}), Vec3::Zero(), 0.5).size() == 1);
  check_one(surface_contacts(box, {0.9, 0, 0}, 0.0), {-1, 0, 0}, -0.1);
  CHECK(surface_contacts(box, {1.1, 0, 0}, 0.0).empty());
  CHECK(box.near({0.9, 0, 0}, 0.0));
  CHECK(!box.near({1.1, 0, 0}, 0.0));
}

TEST_CASE("the contact with a box changes little where faces, edges and corners meet") {
  // Walk round an edge in small steps: the normal may not jump, or resting grains would be shaken.
  const Box box({2, 2, 2});
  Vec3 last = Vec3::Zero();
  for (double t = 0.0; t <= 1.35; t += 0.01) {
    const Vec3 p(0.5 + t, 0.0, 1.85 - t);  // from above the top face to beside the right one, passing the edge
    const auto found = surface_contacts(box, p, 1.0);
    REQUIRE(found.size() == 1);
    CHECK(found[0].normal.norm() == Approx(1.0));
    if (t > 0.0) CHECK((found[0].normal - last).norm() < 0.06);  // at 0.25 from the edge a step of 0.014 turns 0.057
    last = found[0].normal;
  }
}

TEST_CASE("near never misses a contact, and bounds hold what touches") {
  std::mt19937 engine(2);
  std::uniform_real_distribution<double> place(-3.0, 3.0), size(0.0, 1.0);
  const Box box({2, 3, 1});
  int touching = 0, excluded = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec3 p(place(engine), place(engine), place(engine));
    const double r = size(engine);
    const bool touches_box = !surface_contacts(box, p, r).empty();
    touching += touches_box;
    excluded += !box.near(dem::from_eigen(p), r);
    if (touches_box) {
      CHECK(box.near(dem::from_eigen(p), r));
      CHECK(((p.array() >= box.bounds().low.array() - r).all() && (p.array() <= box.bounds().high.array() + r).all()));
    }
  }
  CHECK(touching > 200);
  CHECK(excluded > 200);
}

TEST_CASE("a box of no size is refused") {
  check_refused([] { Box({1, 0, 1}); }, "edge length of a box is 0 m");
  check_refused([] { Box({1, 1, -3}); }, "edge length of a box is -3 m", "greater than zero");
}

#pragma once

// Whether the contacts that a world lists are those that it computes with.

#include "world/laws.hpp"

#include <dem/world/contacts.hpp>

#include <array>
#include <map>

namespace listed {

using Catch::Approx;
using dem::ContactKind;
using dem::contacts_of;

/// A force and a torque, and the sum of the sizes that they were made of, against which they round.
struct SumOfContacts {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double force_size = 0.0, torque_size = 0.0;

  void add(const Vec3& f, const Vec3& t) {
    force += f;
    torque += t;
    force_size += f.norm();
    torque_size += t.norm();
  }
};

/// The contacts of a world add up to the forces of an evaluation at the same state, on grains, surfaces and bodies; and
/// the world runs on as one that was not asked. Returns how many contacts there were of each kind.
template <class Model>
std::array<int, 3> check_listed(dem::World<Model>& w) {
  dem::World<Model> evaluated = w, untouched = w;
  evaluated.evaluate_anew();
  evaluated.prepare();

  std::map<std::uint32_t, SumOfContacts> grains, surfaces, pairs;
  std::array<int, 3> count = {};
  for (const auto& c : contacts_of(w)) {
    ++count[static_cast<std::size_t>(c.kind)];
    CHECK(c.normal.norm() == Approx(1.0).epsilon(1e-9));
    CHECK((c.force + c.normal_force() * c.normal - c.tangential_force()).norm() <= 1e-15 * c.force.norm());
    CHECK(std::abs(c.tangential_force().dot(c.normal)) <= 1e-9 * c.force.norm());
    if (c.kind != ContactKind::bodies) grains[c.grain.value].add(c.force, c.torque);
    if (c.kind == ContactKind::grains) grains[c.other_grain.value].add(-c.force, c.other_torque);
    if (c.kind == ContactKind::grain_on_surface) surfaces[c.surface.value].add(-c.force, c.other_torque);
    if (c.kind != ContactKind::bodies) {
      CHECK((c.centre() - w.position(c.grain)).norm() < 1e-15 * (1.0 + w.position(c.grain).norm()));
    }
    if (c.kind == ContactKind::bodies) {
      const bool back = c.own_surface != w.state().body_contacts.pairs[c.pair.index()].a;
      pairs[c.pair.value].add(back ? Vec3(-c.force) : c.force, c.torque);
    }
  }
  // Sums in another order: each of some ten terms rounds by 1e-16.
  const auto check = [](const SumOfContacts& sum, const Vec3& force, const Vec3& torque) {
    CHECK((sum.force - force).norm() <= 1e-14 * sum.force_size);
    CHECK((sum.torque - torque).norm() <= 1e-14 * sum.torque_size);
  };
  for (const GrainId p : w.grains()) check(grains[p.value], evaluated.force(p), evaluated.torque(p));
  for (std::size_t s = 0; s < w.state().surfaces.size(); ++s) {
    check(surfaces[static_cast<std::uint32_t>(s)], evaluated.surface_force(SurfaceId(s)),
          evaluated.surface_torque(SurfaceId(s)));
  }
  for (const auto& [pair, sum] : pairs) {
    CHECK((sum.force - evaluated.body_contact_force(dem::BodyContactId(pair))).norm() <= 1e-14 * sum.force_size);
  }

  REQUIRE(w.run(50));
  REQUIRE(untouched.run(50));
  int differ = 0;
  for (const GrainId p : w.grains()) {
    differ += w.position(p) != untouched.position(p) || w.rotation(p) != untouched.rotation(p) ||
              w.angular_velocity(p) != untouched.angular_velocity(p);
  }
  CHECK(differ == 0);
  return count;
}

/// Grains that fall into a box, with a plate on its way down onto them.
template <class Model>
void add_bed_and_plate(dem::World<Model>& w, double pitch, int per_edge) {
  const double edge = per_edge * pitch;
  add_open_box(w, {edge, edge, 0});
  for (int k = 0; k < per_edge * per_edge * per_edge; ++k) {
    dem::NewGrain n =
        grain_at(pitch * (Vec3(k % per_edge, k / per_edge % per_edge, k / (per_edge * per_edge)) + Vec3::Constant(0.5)),
                 {0.05 * (k % 3 - 1), 0.04 * (k % 5 - 2), -0.2}, {3.0 * (k % 7 - 3), 5, 0});
    n.species = SpeciesId(static_cast<std::size_t>(k) % w.state().species.size());
    n.rotation = Random(static_cast<unsigned>(k)).rotation();
    w.add_grain(n);
  }
  auto& m = w.machine();
  const Vec3 edges(0.9 * edge, 0.9 * edge, pitch);
  const auto plate = m.add_body(dem::mbd::box_body("plate", edges, 3000)
                                    .at({0.5 * edge, 0.5 * edge, (per_edge + 0.6) * pitch})
                                    .moving({0, 0, -0.2}));
  const auto box = w.add_surface(plate, dem::surface::Box(edges));
  // A block that lies on the plate.
  const Vec3 small = 0.3 * edges;
  const auto block =
      m.add_body(dem::mbd::box_body("block", small, 3000)
                     .at({0.5 * edge, 0.5 * edge, (per_edge + 0.6) * pitch + 0.5 * (edges.z() + small.z()) - 2e-5})
                     .moving({0, 0, -0.2}));
  w.add_body_contact(box, w.add_surface(block, dem::surface::Box(small)));
}

}  // namespace listed

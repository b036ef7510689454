// Cells that repeat themselves: what happens at a border is what happens anywhere else.

#include "scenes.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/mesh/triangle_mesh.hpp>
#include <dem/soil/averages.hpp>
#include <dem/world/contacts.hpp>
#include <dem/world/energy.hpp>

#include <numbers>

#include "core/error_of.hpp"
#include "state_hash.hpp"

namespace {

using models::PeriodicCubes;

constexpr double length = 0.030, width = 0.024;  // m, of the cell

dem::WorldOptions cell(const Vec3& gravity, dem::PeriodicAxes periodic, int threads = 1) {
  dem::WorldOptions o = options(gravity, 1e-5);
  o.domain = dem::surface::Aabb{{0, 0, -1}, {length, width, 1}};
  o.periodic = periodic;
  o.threads = threads;
  return o;
}

/// How far apart two points are, but for whole periods along x and y.
double apart(const Vec3& a, const Vec3& b) {
  Vec3 d = a - b;
  d.x() -= length * std::round(d.x() / length);
  d.y() -= width * std::round(d.y() / width);
  return d.norm();
}

template <class World>
void set_up(World& w) {
  w.set_contact(sand<typename World::Model>(0.4));
  w.add_species(dem::shape::cube8(1e-3));
}

/// A bed on a floor, begun at an offset in the cell.
template <class World>
void add_bed(World& w, const Vec3& offset, int layers) {
  set_up(w);
  w.add_surface(w.ground(), dem::surface::Plane{});
  add_block(w, SpeciesId(0), offset + Vec3(1.5e-3, 1.5e-3, 2e-3), 3e-3, 10, 8, layers, 0.3);
}

}  // namespace

TEST_CASE("grains that meet across the corner of a cell move as grains that meet elsewhere") {
  // Blocks whose cubes fly at each other, and all of it along a diagonal, so that the borders cut through it anew and
  // anew, and histories of contacts go through them.
  const auto drift = Vec3(0.8, 0.5, 0);
  auto fill = [&](auto& w) {
    set_up(w);
    add_block(w, SpeciesId(0), Vec3(-2e-3, -2e-3, 0), 2.6e-3, 3, 3, 3, 0.2);
    const Vec3 middle(0.6e-3, 0.6e-3, 2.6e-3);
    for (const GrainId p : w.grains()) {
      w.set_velocity(p, w.velocity(p) + drift - 30.0 * (w.position(p) - middle));
    }
  };
  dem::World<PeriodicCubes> repeated(cell(Vec3::Zero(), {.x = true, .y = true}));
  dem::World<Cubes> open(options(Vec3::Zero(), 1e-5));
  fill(repeated);
  fill(open);
  double touching = 0.0;
  for (int k = 0; k < 50; ++k) {
    REQUIRE(repeated.run(20));
    REQUIRE(open.run(20));
    for (const GrainId p : open.grains()) touching += open.force(p).norm() > 0.0 ? 1.0 : 0.0;
  }
  CHECK(touching > 50.0);  // forces were seen, a few grains at each look
  for (const GrainId p : open.grains()) {
    CAPTURE(p.value);
    // Each step rounds positions of 0.03 m by 1e-18 m; contacts enlarge it, by 1e5 at the most in so few.
    CHECK(apart(repeated.position(p), open.position(p)) < 1e-11);
    CHECK((repeated.velocity(p) - open.velocity(p)).norm() < 1e-8);
    CHECK((repeated.rotation(p) - open.rotation(p)).norm() < 1e-8);
    // Positions are put back into the cell when neighbours are listed.
    CHECK(repeated.position(p).x() > -1e-3);
    CHECK(repeated.position(p).x() < length + 1e-3);
  }
}

TEST_CASE("a bed is the same wherever its cell is said to begin") {
  const Vec3 shift(length / 3, width / 5, 0);
  dem::World<PeriodicCubes> here(cell({1.0, 0.5, -g}, {.x = true, .y = true})),
      there(cell({1.0, 0.5, -g}, {.x = true, .y = true}));
  add_bed(here, Vec3::Zero(), 3);
  add_bed(there, shift, 3);
  REQUIRE(here.run(1500));
  REQUIRE(there.run(1500));
  double weight = 0.0;
  for (const GrainId p : here.grains()) {
    CAPTURE(p.value);
    CHECK(apart(there.position(p) - shift, here.position(p)) < 1e-9);  // rounding, which collisions enlarge
    weight += here.position(p).z() > 0.0 ? 1.0 : 0.0;
  }
  CHECK(weight == 240.0);  // none fell through the floor
}

TEST_CASE("what goes on in a cell that repeats in all directions keeps its momentum") {
  dem::WorldOptions o = cell(Vec3::Zero(), {true, true, true});
  o.domain->low.z() = 0.0;
  o.domain->high.z() = 0.02;
  dem::World<PeriodicCubes> w(o);
  set_up(w);
  add_block(w, SpeciesId(0), Vec3(1e-3, 1e-3, 1e-3), 3e-3, 10, 8, 6, 1.0);
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const GrainId p : w.grains()) sum += w.velocity(p);
    return sum;
  };
  const Vec3 before = momentum();
  const Vec3 first = w.velocity(GrainId(0));
  REQUIRE(w.run(2000));
  CHECK((w.velocity(GrainId(0)) - first).norm() > 0.01);  // it met others
  // 480 velocities of 1 m/s, each changed 2,000 times by amounts that are rounded to 1e-16 of it.
  CHECK((momentum() - before).norm() < 1e-10);
  for (const GrainId p : w.grains()) {
    CHECK(w.position(p).z() > -2e-4);
    CHECK(w.position(p).z() < 0.02 + 2e-4);
  }
}

TEST_CASE("a grain is also buried in the image of a solid that reaches across a border") {
  for (const double x : {0.001, length - 0.001, 0.5 * length}) {
    CAPTURE(x);
    dem::World<PeriodicCubes> w(cell(Vec3::Zero(), {.x = true, .y = true}));
    set_up(w);
    const dem::surface::TriangleMesh block(dem::mesh::box({0.016, 0.016, 0.016}));
    w.add_surface(w.ground(), block, {.name = "block", .position = {0, 0.5 * width, 0}});  // from x = -8 to 8 mm
    w.add_grain({SpeciesId(0), {x, 0.5 * width, 0}});
    const std::string refusal = message_of([&] { (void)w.run(1); });
    CHECK((refusal.find("lies within surface 'block'") != std::string::npos) == (x != 0.5 * length));
  }
}

TEST_CASE("the number of threads changes no bit of a periodic bed") {
  dem::World<PeriodicCubes> one(cell({3.0, 0, -g}, {.x = true, .y = true})),
      three(cell({3.0, 0, -g}, {.x = true, .y = true}, 3));
  for (auto* w : {&one, &three}) {
    add_bed(*w, Vec3::Zero(), 5);
    REQUIRE(w->run(600));
    w->remove_grain(GrainId(17));
    w->add_grain({.species = SpeciesId(0), .position = {length + 1e-3, 0.01, 0.04}});  // it is put into the cell
    REQUIRE(w->run(900));
  }
  CHECK(one.position(GrainId(400)).x() < length);
  for (const GrainId p : one.grains()) {
    CAPTURE(p.value);
    CHECK(one.position(p) == three.position(p));
    CHECK(one.velocity(p) == three.velocity(p));
  }
}

TEST_CASE("a machine part meets grains across a border, in whichever cell it is") {
  // A blade is drawn through a bed, from the middle of a cell and from two cells farther on.
  const auto force_on_blade = [](double start, std::vector<Vec3>& forces) {
    dem::World<PeriodicCubes> w(cell({0, 0, -g}, {.x = true, .y = true}));
    add_bed(w, Vec3::Zero(), 3);
    for (const GrainId p : w.grains()) {
      const Vec3 from_blade = w.position(p) - Vec3(0.026, 0, 0);
      const double y = from_blade.y() - width * std::round(from_blade.y() / width);
      if (std::abs(from_blade.x()) < 3e-3 && std::abs(y) < 6e-3) w.remove_grain(p);
    }
    auto& m = w.machine();
    const Vec3 edges(2e-3, 8e-3, 0.02);
    const auto blade = m.add_body(dem::mbd::box_body("blade", edges, 2650).at({start, 0.0, 0.013}));
    const auto slide =
        m.add_joint(dem::mbd::prismatic("slide", w.ground(), blade, Vec3(start, 0, 0.013), Vec3::UnitX()));
    m.add_motion(dem::mbd::prescribed_joint(
        "draw", slide, dem::mbd::Signal::function([](double t) { return 0.5 * (t - 0.01) * (t > 0.01 ? 1.0 : 0.0); })));
    const auto s = w.add_surface(blade, dem::surface::Box(edges));
    for (int k = 0; k < 30; ++k) {
      const auto report = w.run(100);
      INFO(report.text);
      REQUIRE(report);
      forces.push_back(w.surface_force(s));
    }
    CHECK(w.machine().bodies()[blade.index()].position().x() == Catch::Approx(start + 0.01).epsilon(1e-3));
  };
  const auto largest = [](const std::vector<Vec3>& forces) {
    double norm = 0.0;
    for (const Vec3& f : forces) norm = std::max(norm, f.norm());
    return norm;
  };
  std::vector<Vec3> near, far;
  force_on_blade(0.026, near);  // it crosses the border at 0.03 m, and stands on that at y = 0
  force_on_blade(0.026 + 2 * length, far);
  double sum = 0.0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    // Places are rounded to 1e-17 m, one cell from another, and the collisions of 3,000 steps enlarge that by 1e10.
    CHECK((near[k] - far[k]).norm() < 1e-3 * largest(near));
    sum += near[k].x();
  }
  CHECK(sum < -largest(near));  // the bed holds it back
}

TEST_CASE("contacts across borders are listed with the rest, and inlets see grains beyond them", "[slow]") {
  dem::World<PeriodicCubes> w(cell({2.0, 1.0, -g}, {.x = true, .y = true}));
  set_up(w);
  w.add_surface(w.ground(), dem::surface::Plane{});
  dem::InletOptions o;
  o.grains = SpeciesId(0);
  o.mass_flow = 0.5;
  o.velocity = {0, 0, -0.3};
  w.add_inlet(dem::InletRegion::box({0, 0, 0.012}, {length, width, 0.016}), o);
  REQUIRE(w.run(9000));
  REQUIRE(w.grain_count() > 200);
  double deepest = 0.0;
  std::vector<Vec3> forces(w.grains().back().index() + 1, Vec3::Zero());
  int across = 0;
  for (const auto& c : dem::contacts_of(w)) {
    deepest = std::max(deepest, c.overlap);
    forces[c.grain.index()] += c.force;
    if (c.kind != dem::ContactKind::grains) continue;
    forces[c.other_grain.index()] -= c.force;
    across += (w.position(c.grain) - w.position(c.other_grain)).norm() > 0.01 ? 1 : 0;
  }
  CHECK(across > 5);
  CHECK(deepest < 0.3e-3);  // m: no grain was put into another
  const auto grains = w.grains();
  REQUIRE(w.run(1));  // evaluates the forces of that state, with which it moves the grains
  for (const GrainId p : grains) {
    CAPTURE(p.value);
    CHECK((forces[p.index()] - w.force(p)).norm() < 1e-12);  // rounding of sums of some 0.01 N
  }
}

TEST_CASE("a grain that comes to a part wakes nothing in a cell where all others sleep, at its borders or elsewhere") {
  // 64 towers of 4 fill one chunk, so the new grain has a row that no list knows yet. A write beyond the chunks is seen
  // where containers check their bounds.
  dem::WorldOptions o = cell({0, 0, -g}, {.x = true, .y = true});
  o.sleep = dem::SleepOptions{.balance = 0.2, .change = 0.2, .jolt = 0.2, .motion = 0.01, .window = 50};
  dem::World<PeriodicCubes> w(o);
  set_up(w);
  const auto glued = w.add_species(dem::shape::cube8(1e-3), {.held = true});
  w.add_surface(w.ground(), dem::surface::Plane{});
  for (int k = 0; k < 256; ++k) {
    w.add_grain({SpeciesId(0), Vec3(length / 8 * (k % 8), width / 8 * (k / 8 % 8), 1e-3 + 2e-3 * (k / 64))});
  }
  REQUIRE(w.run_for(0.1));
  REQUIRE(w.asleep_count() == 256);
  const auto part = w.machine().add_fixed_body("part", Vec3(0, 0, 0.02));
  const GrainId grain = w.add_grain({glued, Vec3(0, 0, 0.02)});
  w.attach(grain, part);
  REQUIRE(w.run(1));
  CHECK(w.asleep_count() == 256);
  CHECK(!w.is_asleep(grain));
  CHECK(w.position(grain) == Vec3(0, 0, 0.02));
}

TEST_CASE("a cell may run empty and be filled again") {
  dem::World<PeriodicCubes> w(cell({0, 0, -g}, {.x = true, .y = true}));
  set_up(w);
  add_block(w, SpeciesId(0), Vec3(1e-3, 1e-3, 0), 3e-3, 4, 4, 1, 0.1);
  w.add_outlet({{-1, -1, -1}, {1, 1, -1e-3}});
  REQUIRE(w.run(4000));
  CHECK(w.grain_count() == 0);
  REQUIRE(w.run(20));
  CHECK(dem::contacts_of(w).empty());
  w.add_grain({.species = SpeciesId(0), .position = {0, 0, 0.01}});
  REQUIRE(w.run(20));
  CHECK(w.grain_count() == 1);
}

TEST_CASE("a part that turns until it neither fits the cell nor fills it is reported") {
  dem::World<PeriodicCubes> w(cell({0, 0, 0}, {.x = true, .y = true}));
  set_up(w);
  w.add_grain({.species = SpeciesId(0), .position = {0.01, 0.01, 0.1}});
  const Vec3 edges(0.004, 0.004, 0.04);  // upright it fits
  const auto bar =
      w.machine().add_body(dem::mbd::box_body("bar", edges, 2650).at({0.01, 0.01, 0}).moving({0, 0, 0}, {0, 100, 0}));
  w.add_surface(bar, dem::surface::Box(edges), {.name = "bar"});
  const auto report = w.run(2000);
  CHECK_FALSE(report);
  CHECK(report.text.find("surface 'bar' reaches from") != std::string::npos);
  CHECK(w.time() > 0.002);
}

TEST_CASE("a cell that cannot be is refused in words") {
  check_refused([] { dem::World<Cubes> w({.periodic = {.x = true}}); }, "using Domain = dem::domain::Periodic");
  check_refused([] { dem::World<PeriodicCubes> w; }, "set WorldOptions::domain to the cell");
  check_refused(
      [] {
        dem::World<PeriodicCubes> w({.domain = dem::surface::Aabb{{0, 0, 0}, {1, 1, 1}}});
      },
      "name no periodic direction");
  dem::WorldOptions o = cell({0, 0, -g}, {.x = true});
  o.domain->high.x() = 5e-3;
  dem::World<PeriodicCubes> small(o);
  set_up(small);
  small.add_grain({.species = SpeciesId(0)});
  check_refused([&] { small.prepare(); }, "period in x is 0.005 m, but must be above");
  dem::World<PeriodicCubes> short_floor(cell({0, 0, -g}, {.x = true}));
  set_up(short_floor);
  short_floor.add_surface(short_floor.ground(), dem::surface::Box({length, 1, 0.01}),
                          {.name = "floor", .position = {length / 2, 0, 0}});
  check_refused([&] { short_floor.prepare(); }, "or fill the cell and more");
  check_refused(
      [&] {
        short_floor.add_inlet(dem::InletRegion::box({0, 0, 0}, {1, 0, 0}),
                              {.name = "rain", .grains = SpeciesId(0), .mass_flow = 1});
      },
      "inlet 'rain' reaches from 0 to 1 m in x");
  dem::World<PeriodicCubes> long_part(cell({0, 0, -g}, {.x = true}));
  set_up(long_part);
  long_part.add_surface(long_part.ground(), dem::surface::Box({0.029, 1, 0.01}), {.name = "slab"});
  check_refused([&] { long_part.prepare(); }, "surface 'slab' reaches from -0.0145 to 0.0145 m in x");
  // What touches nothing need not fit until it is switched on.
  long_part.set_active(dem::SurfaceId(0), false);
  REQUIRE(long_part.run(1));
  long_part.set_active(dem::SurfaceId(0), true);
  check_refused([&] { (void)long_part.run(1); }, "surface 'slab' reaches from -0.0145 to 0.0145 m in x");
}

TEST_CASE("contacts across a border count in lists, stresses and energies") {
  // A layer of cubes, face on face, which fills the cell: its borders cut through cubes. Four contacts a face.
  dem::World<PeriodicCubes> w(cell(Vec3::Zero(), {.x = true, .y = true}));
  const double depth = 4e-6, pitch = 3e-3, high = 4e-3;
  w.set_contact(sand<PeriodicCubes>(0.4));
  w.add_species(dem::shape::cube8(0.5 * (pitch + depth)));
  for (int k = 0; k < 80; ++k) {
    w.add_grain({SpeciesId(0), {0.7e-3 + pitch * (k % 10), 1e-3 + pitch * (k / 10), 0}});
  }
  CHECK(dem::contacts_of(w).size() == 80 * 2 * 4);
  const dem::surface::Aabb box = {{0, 0, -0.5 * high}, {length, width, 0.5 * high}};
  for (const auto& a : dem::soil::averages(w, {box, {5, 3, 1}}).values) {
    // 2.5 faces in a cell of the grid along x, and so on: only the sum is that of whole cubes.
    CHECK(a.contact_stress(2, 2) == Catch::Approx(0.0).margin(1e-9));
  }
  const auto whole = dem::soil::average_in(w, box);
  for (const int axis : {0, 1}) {  // one period on either side is known
    auto far = box;
    far.low[axis] = -(axis == 0 ? length : width);
    far.high[axis] = 2.0 * (axis == 0 ? length : width);
    CHECK(dem::soil::average_in(w, far).density == Catch::Approx(whole.density));
    far.high[axis] *= 1.05;
    check_refused([&] { dem::soil::average_in(w, far); }, axis == 0 ? "along x, where" : "along y, where");
  }
  const double stress = 4 * 2000.0 * depth / (pitch * high);
  CHECK(whole.stress()(0, 0) == Catch::Approx(stress).epsilon(1e-9));
  CHECK(whole.stress()(1, 1) == Catch::Approx(stress).epsilon(1e-9));
  CHECK(whole.coordination == Catch::Approx(4.0));
  CHECK(whole.density == Catch::Approx(total_mass(w) / (length * width * high)));

  Random random(4);
  for (const GrainId p : w.grains()) w.set_velocity(p, Vec3(0.5, 0.3, 0) + random.vector(0.2));
  dem::count_energy(w);
  const auto start = dem::energy_of(w);
  REQUIRE(w.run(800));  // 4 mm along x: some cubes are put back into the cell
  const auto end = dem::energy_of(w);
  CHECK(end.dissipated() > 1e-3 * start.kinetic());
  CHECK(end.balance() == Catch::Approx(start.balance()).epsilon(1e-6));

  std::vector<Vec3> sum(80, Vec3::Zero());
  double size = 0.0;
  for (const auto& c : dem::contacts_of(w)) {
    sum[c.grain.index()] += c.force;
    sum[c.other_grain.index()] -= c.force;
    size = std::max(size, c.force.norm());
  }
  w.evaluate_anew();
  w.prepare();
  for (const GrainId p : w.grains()) CHECK((w.force(p) - sum[p.index()]).norm() < 1e-13 * size);
}

TEST_CASE("an inlet keeps clear of grains across a border") {
  // A layer over the whole cell, filled until nothing fits. Without weight a grain that touched another would move.
  dem::World<PeriodicCubes> w(cell({0, 0, 0}, {.x = true, .y = true}));
  set_up(w);
  w.add_inlet(dem::InletRegion::box({0, 0, 0}, {length, width, 1e-3}), {.grains = SpeciesId(0), .grain_flow = 1e8});
  REQUIRE(w.run(400));
  CHECK(w.grain_count() > 50);
  double least = 1.0;
  for (const GrainId a : w.grains()) {
    for (const GrainId b : w.grains()) {
      if (a.index() < b.index()) least = std::min(least, apart(w.position(a), w.position(b)));
    }
    CHECK(w.force(a).norm() == 0.0);
  }
  CHECK(least > 2.0 * w.species(SpeciesId(0)).shape.bounding_radius());
}

TEST_CASE("grains that are attached to a part stay in the cell, and load their part as they do elsewhere") {
  // A part flies through three cells, and pushes a cube before it: without a border in its way, and with.
  const auto push = [](auto& w) {
    set_up(w);
    w.add_species(dem::shape::cube8(1e-3), {.held = true});
    const dem::BodyId cart =
        w.machine().add_body(dem::mbd::box_body("cart", Vec3::Constant(4e-3), 2000).at({0.012, 0.01, 0}));
    const auto rail =
        w.machine().add_joint(dem::mbd::prismatic("rail", w.ground(), cart, {0.012, 0.01, 0}, Vec3::UnitX()));
    w.machine().add_motion(dem::mbd::prescribed_joint("drive", rail, dem::mbd::Signal::ramp(0, 2.0)));
    const auto sensor = w.machine().add_sensor(dem::mbd::contact_sensor("cart", cart, 0.05));
    const GrainId bow = w.add_grain({SpeciesId(1), {0.016, 0.01, 5e-4}});
    w.attach(bow, cart);
    const GrainId other = w.add_grain({SpeciesId(0), {0.02, 0.01, 0}});
    REQUIRE(w.run(5000));
    const dem::Wrench& load = w.machine().sensor(sensor).mean();
    CHECK(apart(w.position(bow), w.machine().body(cart).position() + Vec3(4e-3, 0, 5e-4)) < 1e-12);
    CHECK(w.velocity(other).x() > 1.9);
    return std::pair(load.force.x, load.torque.y);
  };
  dem::World<PeriodicCubes> periodic(cell({0, 0, 0}, {.x = true, .y = true}));
  dem::World<Cubes> open(options({0, 0, 0}, 1e-5));
  const auto [force, torque] = push(periodic);
  const auto [open_force, open_torque] = push(open);
  // Places differ by rounding of 1e-17 m, and contacts are as stiff as 2000 N/m.
  CHECK(force == Catch::Approx(open_force).epsilon(1e-8));
  CHECK(torque == Catch::Approx(open_torque).epsilon(1e-6).margin(1e-12));
  CHECK(force < 0.0);
  for (const GrainId p : periodic.grains()) {
    CHECK(periodic.position(p).x() > -1e-3);
    CHECK(periodic.position(p).x() < length + 1e-3);
  }
}

namespace {

/// Pa, compression is positive: forces of contacts times what leads from one centre to the other, by volume (m^3).
template <class World>
Mat3 virial_stress(const World& w, double volume) {
  Mat3 sum = Mat3::Zero();
  for (const auto& c : dem::contacts_of(w)) sum -= c.force * (c.arm - c.other_arm).transpose();
  return sum / volume;
}

}  // namespace

TEST_CASE("a compressed packing bears the same stress in its cell as two copies of it in a cell twice as long",
          "[slow]") {
  // Cubes that are a little tilted, and nearer to each other than they are wide, push each other about and come to
  // rest.
  const double pitch = 1.98e-3, edge = 5 * pitch, volume = edge * edge * edge;
  const auto packing = [&](int copies) {
    dem::WorldOptions o = options(Vec3::Zero(), 1e-5);
    o.domain = dem::surface::Aabb{Vec3::Zero(), {copies * edge, edge, edge}};
    o.periodic = {true, true, true};
    dem::World<PeriodicCubes> w(o);
    w.set_contact({.normal = {2000, 0.05, 1}, .friction = {0.4, 2000, 0.05, 0.975}});
    w.add_species(dem::shape::cube8(1e-3));
    for (int copy = 0; copy < copies; ++copy) {
      Random random(1);
      for (int k = 0; k < 125; ++k) {
        const Vec3 at = pitch * Vec3(k % 5, k / 5 % 5, k / 25) + random.vector(0.02 * pitch);
        const Mat3 turn = Eigen::AngleAxisd(random.between(0, 0.2), random.vector().normalized()).toRotationMatrix();
        w.add_grain({SpeciesId(0), at + Vec3(copy * edge, 0, 0), Vec3::Zero(), turn});
      }
    }
    return w;
  };
  auto one = packing(1), two = packing(2);
  for (const std::uint64_t steps : {1u, 300u, 3000u}) {
    REQUIRE(one.run(steps));
    REQUIRE(two.run(steps));
    const Mat3 stress = virial_stress(one, volume);
    CHECK(stress.trace() / 3 > 1e4);  // Pa
    CHECK(dem::contacts_of(two).size() == 2 * dem::contacts_of(one).size());
    // Places of 0.02 m are rounded to 3e-18 m, overlaps are some 1e-5 m: 3e-13 of the force of a contact. Grains that
    // hold each other do not enlarge it.
    CHECK((virial_stress(two, 2 * volume) - stress).norm() < 1e-12 * stress.norm());
    const auto mean = dem::soil::average_in(one, {Vec3::Zero(), Vec3::Constant(edge)});
    CHECK((mean.contact_stress - stress).norm() < 1e-12 * stress.norm());
  }
  CHECK(kinetic_energy(one) < 1e-20);  // J: it rests
}

TEST_CASE(
    "a standing wave in a chain of cubes swings as the closed form says, in a cell of one wave length and of two") {
  // Face on face: the four contacts of two faces are one spring K, which does not let go as the chain is compressed by
  // more than it swings. A wave of the number q swings with omega = 2 sqrt(K/m) sin(q a/2), a being the pitch.
  constexpr int cubes_a_wave = 12;
  constexpr double half_edge = 1e-3, overlap = 2e-6, pitch = 2 * half_edge - overlap, swing = 1e-6, dt = 1e-5;
  const double phase = 2 * std::numbers::pi / cubes_a_wave;  // q a
  for (const int waves : {1, 2}) {
    const int n = waves * cubes_a_wave;
    dem::WorldOptions o = options(Vec3::Zero(), dt);
    o.domain = dem::surface::Aabb{{0, -1, -1}, {n * pitch, 1, 1}};
    o.periodic = {.x = true};
    dem::World<PeriodicCubes> w(o);
    w.set_contact({.normal = {2000, 0, 1}, .friction = {0.4, 2000, 0.015, 0.975}});
    const auto cube = w.add_species(dem::shape::cube8(half_edge));
    const auto place = [&](int k) { return 0.7e-3 + k * pitch; };  // the borders cut through a cube
    for (int k = 0; k < n; ++k) w.add_grain({cube, {place(k) + swing * std::cos(phase * k), 0, 0}});
    const double omega = 2 * std::sqrt(4 * 2000.0 / w.species(cube).mass) * std::sin(phase / 2);
    // Steps of symplectic Euler are those of a swing of a little more than omega, seen half a step later.
    const double a_step = 2 * std::asin(omega * dt / 2);
    double largest = 0.0;                      // of its swing
    for (int step = 1; step <= 800; ++step) {  // 13 periods
      REQUIRE(w.run(1));
      double amplitude = 0.0;
      for (int k = 0; k < n; ++k) {
        double moved = w.position(GrainId(static_cast<std::uint32_t>(k))).x() - place(k);
        moved -= n * pitch * std::round(moved / (n * pitch));
        amplitude += 2.0 / n * moved * std::cos(phase * k);
      }
      const double expected = swing * std::cos((step + 0.5) * a_step) / std::cos(0.5 * a_step);
      largest = std::max(largest, std::abs(amplitude - expected) / swing);
    }
    // Each step rounds places of 0.05 m by 3e-18 m, which is 3e-12 of the swing. That adds up as chance has it. An
    // omega that is wrong by 1e-9 of itself would be seen: the phase is 80 rad in the end.
    CHECK(largest < 1e-8);
  }
}

TEST_CASE("a bed has the same bits in a cell somewhere else, and if its grains are put in whole periods away",
          "[slow]") {
  // Places from 1 to 2 m are whole numbers of 2^-52 m. A shift that is one too, and an even one, from such places to
  // such places is not rounded, and what is added later is rounded alike. What contacts read is how far apart grains
  // are.
  //
  // The order of rows, in which forces are added up, is that of the lists' cells, along a curve. A shift by whole
  // blocks of eight cells keeps it; the period is one here. So a shift by a third of the period has other bits, though
  // it could be exact: "a bed is the same wherever its cell is said to begin" has a tolerance.
  constexpr double period = 0x1p-5, cell_of_list = 0x1p-8;  // m
  const auto bed = [=](const Vec3& shift, int periods) {
    const Vec3 corner = Vec3(1.0625, 1.0625, 0) + shift;
    dem::WorldOptions o = options({3.0, 1.5, -g}, 1e-5);
    o.domain = dem::surface::Aabb{corner - Vec3(0, 0, 1), corner + Vec3(period, period, 1)};
    o.periodic = {.x = true, .y = true};
    const auto cube = dem::shape::cube8(1e-3);
    o.skin = cell_of_list - 2 * cube.bounding_radius();
    dem::World<PeriodicCubes> w(o);
    w.set_contact(sand<PeriodicCubes>(0.4));
    const auto species = w.add_species(cube);
    w.add_surface(w.ground(), dem::surface::Plane{});
    Random random(1);
    for (int k = 0; k < 400; ++k) {
      const Vec3 at(1.0625 + 3e-3 * (k % 10) + 1e-3, 1.0625 + 3e-3 * (k / 10 % 10) + 1e-3, 3e-3 * (k / 100) + 2e-3);
      const Mat3 turn = random.rotation();
      w.add_grain({species, at + shift + period * periods * Vec3(k % 3 - 1, k % 2, 0), random.vector(0.3), turn});
    }
    REQUIRE(w.run(3000));
    return w;
  };
  const auto here = bed(Vec3::Zero(), 0);
  CHECK(here.state().rebuilds > 3);
  CHECK(hash_of(bed(Vec3::Zero(), 2)) == hash_of(here));
  for (const Vec3& shift : {Vec3(0.25, 0.125, 0), Vec3(period, 3 * period, 0)}) {
    CHECK(hash_of(bed(shift, 0), shift) == hash_of(here));
  }
}

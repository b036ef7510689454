#include "world/scenes.hpp"

namespace {

/// Grains that fall into a V of two boxes, everything turned by `turn` and moved by `shift`; if asked for, a plate of a
/// machine falls on them. Returns the positions, turned and moved back; those of the plate are the last ones.
struct Outcome {
  std::vector<Vec3> positions, spins;
  Vec3 on_first_box = Vec3::Zero();  // N, sum over a hundred looks
  double load = 0.0;                 // N, the same of its size
};

template <class Model>
Outcome run_turned(const typename Model::Shape& shape, const Mat3& turn, const Vec3& shift, bool has_plate) {
  dem::World<Model> w(options(turn * Vec3(0, 0, -9.81), 1e-5));
  w.set_contact(sand<Model>());
  const auto species = w.add_species(shape);
  SurfaceId first;
  for (const double side : {1.0, -1.0}) {
    dem::SurfaceOptions o;
    o.rotation = turn * Eigen::AngleAxisd(side * 0.6, Vec3::UnitY()).toRotationMatrix();
    o.position = shift + o.rotation * Vec3(-0.01 * side, 0, -0.005);
    const auto s = w.add_surface(w.ground(), dem::surface::Box({0.04, 0.03, 0.01}), o);
    if (side > 0) first = s;
  }
  Random random(3);
  for (int k = 0; k < 12; ++k) {
    dem::NewGrain p;
    p.species = species;
    p.position =
        shift + turn * (Vec3(3e-3 * (k % 3 - 1), 3e-3 * (k / 3 % 2), 0.0055 + 3e-3 * (k / 6)) + random.vector(2e-4));
    p.velocity = turn * random.vector(0.2);
    p.rotation = turn * random.rotation();
    p.angular_velocity = turn * random.vector(20.0);
    w.add_grain(p);
  }
  dem::BodyId plate;
  SurfaceId under;
  if (has_plate) {
    plate = w.machine().add_body(dem::mbd::given_body("plate", 1e-4, Vec3(6e-10, 6e-10, 1e-9))
                                     .at(shift + turn * Vec3(0, 0, 0.014), turn)
                                     .moving(turn * Vec3(0, 0, -0.3), turn * Vec3(3, 1, 2)));
    under = w.add_surface(plate, dem::surface::Box({0.008, 0.008, 0.001}));
  }
  int touching = 0;
  double on_plate = 0.0;
  Outcome o;
  for (int k = 0; k < 100; ++k) {
    REQUIRE(w.run(40));
    o.on_first_box += turn.transpose() * w.surface_force(first);
    o.load += w.surface_force(first).norm();
    if (has_plate) on_plate += w.surface_force(under).norm();
    for_each_grain(w, [&](GrainId p) { touching += w.force(p).norm() > 0.0; });
  }
  CHECK(touching > 20);  // looked at every 40th step; a collision takes about 20
  REQUIRE(o.load > 0.0);
  for_each_grain(w, [&](GrainId p) {
    o.positions.push_back(turn.transpose() * (w.position(p) - shift));
    o.spins.push_back(turn.transpose() * w.angular_velocity(p));
  });
  if (!has_plate) return o;
  REQUIRE(on_plate > 0.0);
  const dem::Body& body = w.machine().body(plate);
  o.positions.push_back(turn.transpose() * (body.position() - shift));
  o.spins.push_back(turn.transpose() * body.angular_velocity());
  return o;
}

template <class Model>
void check_same(const typename Model::Shape& shape, const Mat3& turn, const Vec3& shift, double tolerance,
                bool has_plate = false) {
  const Outcome plain = run_turned<Model>(shape, Mat3::Identity(), Vec3::Zero(), has_plate);
  const Outcome turned = run_turned<Model>(shape, turn, shift, has_plate);
  double position = 0.0, spin = 0.0;
  for (std::size_t k = 0; k < plain.positions.size(); ++k) {
    position = std::max(position, (plain.positions[k] - turned.positions[k]).norm());
    spin = std::max(spin, (plain.spins[k] - turned.spins[k]).norm());
  }
  CAPTURE(position, spin);
  CHECK(position < tolerance * 1e-3);  // of the size of a grain
  // A collision at 0.4 m/s presses v sqrt(m/K) = 5e-5 m in. A position that is wrong by `tolerance` of 1e-3 m makes its
  // force, and the spin of up to 20 rad/s that it leaves, wrong by 20 times as much of itself.
  CHECK(spin < 20.0 * tolerance * 20.0);
  CHECK((plain.on_first_box - turned.on_first_box).norm() < 20.0 * tolerance * plain.load);
}

}  // namespace

TEST_CASE("a turned scene moves as the scene does, turned") {
  // Rounding of 1e-16 a step grows as grains collide, about tenfold each time: 4,000 steps (0.04 s) are a few
  // collisions each. 1e-9 of a grain leaves room for six.
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  check_same<Cubes>(dem::shape::cube8(1.2e-3), turn, Vec3::Zero(), 1e-9);
  check_same<Balls>(Sphere(1.2e-3), turn, Vec3::Zero(), 1e-9);
  check_same<Grains<Cube8, dem::integrator::PredictorCorrector>>(dem::shape::cube8(1.2e-3), turn, Vec3::Zero(), 1e-9);
  check_same<Grains<Cube8, dem::integrator::VelocityVerlet>>(dem::shape::cube8(1.2e-3), turn, Vec3::Zero(), 1e-9);
}

TEST_CASE("a plate of a machine on grains moves in a turned scene as it does, turned") {
  // The plate adds one or two collisions to the few of each grain, each of which makes tenfold of a rounding.
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  check_same<Cubes>(dem::shape::cube8(1.2e-3), turn, Vec3::Zero(), 1e-8, true);
  check_same<Balls>(Sphere(1.2e-3), turn, Vec3::Zero(), 1e-8, true);
}

TEST_CASE("a moved scene moves as the scene does") {
  // 10 m away positions round by 1e-15 m, which is 1e-12 of a grain to begin with.
  check_same<Cubes>(dem::shape::cube8(1.2e-3), Mat3::Identity(), Vec3(-10.0, 7.0, 3.0), 1e-6);
}

TEST_CASE("quarter turns about the axes change nothing but the axes") {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    const Mat3 turn = Eigen::AngleAxisd(M_PI / 2, axis).toRotationMatrix();
    check_same<Cubes>(dem::shape::cube8(1.2e-3), turn, Vec3::Zero(), 1e-9);
  }
}

#include <dem/mbd/body/mesh_body.hpp>

#include <array>
#include <vector>

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("simple shapes have the mass and inertia of the textbook") {
  const BodyMass box = box_mass({1.0, 2.0, 3.0}, 10.0);
  CHECK(box.mass == Approx(60.0));
  CHECK(box.inertia(0, 0) == Approx(60.0 * (4.0 + 9.0) / 12.0));
  CHECK(box.inertia(2, 2) == Approx(60.0 * (1.0 + 4.0) / 12.0));
  const BodyMass can = cylinder_mass(0.5, 2.0, 100.0);
  CHECK(can.mass == Approx(100.0 * pi * 0.25 * 2.0));
  CHECK(can.inertia(2, 2) == Approx(can.mass * 0.125));
  CHECK(can.inertia(0, 0) == Approx(can.mass * (0.75 + 4.0) / 12.0));
  const BodyMass ball = sphere_mass(0.3, 1000.0);
  CHECK(ball.inertia(1, 1) == Approx(0.4 * ball.mass * 0.09));
}

TEST_CASE("a closed mesh has the mass properties of the solid it encloses") {
  // A box of 1 x 2 x 3 m, far from the origin, as 12 triangles.
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(Vec3(100.0 + (i & 1), 50.0 + (i >> 1 & 1) * 2.0, (i >> 2) * 3.0));
  const std::vector<std::array<std::uint32_t, 3>> faces = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                           {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                           {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const BodyMass mesh = mesh_mass(corners, faces, 10.0);
  const BodyMass box = box_mass({1.0, 2.0, 3.0}, 10.0);
  CHECK(mesh.mass == Approx(box.mass));
  CHECK((mesh.centre_of_mass - Vec3(100.5, 51.0, 1.5)).norm() < 1e-12);
  CHECK((mesh.inertia - box.inertia).norm() < 1e-10);

  std::vector<std::array<std::uint32_t, 3>> inside_out = faces;
  for (auto& f : inside_out) std::swap(f[0], f[1]);
  CHECK(mesh_mass(corners, inside_out, 10.0).mass == Approx(box.mass));  // it is turned round

  // Beside it a second one, of 1 m^3, that looks inward: neither is subtracted.
  std::vector<Vec3> both = corners;
  for (int i = 0; i < 8; ++i) both.push_back(Vec3(110.0 + (i & 1), 50.0 + (i >> 1 & 1), i >> 2));
  std::vector<std::array<std::uint32_t, 3>> of_both = faces;
  for (const auto& f : inside_out) of_both.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
  CHECK(mesh_mass(both, of_both, 10.0).mass == Approx(70.0));

  // Solids that touch at a face or an edge stay two, whose edges are not shared.
  for (const Vec3& beside : {Vec3(1, 0, 0), Vec3(1, 2, 0)}) {
    std::vector<Vec3> touching = corners;
    for (const Vec3& c : corners) touching.push_back(c + beside);
    std::vector<std::array<std::uint32_t, 3>> of_two = faces;
    for (const auto& f : faces) of_two.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
    CHECK(mesh_mass(touching, of_two, 10.0).mass == Approx(120.0));
  }

  std::vector<std::array<std::uint32_t, 3>> open(faces.begin(), faces.end() - 1);
  CHECK_THAT(message_of([&] { mesh_mass(corners, open, 10.0); }),
             Contains("not closed: 3 of its edges belong to one triangle only"));
  CHECK_THAT(message_of([&] {
               mesh_mass(corners, std::vector<std::array<std::uint32_t, 3>>{{0, 1, 9}}, 1.0);
             }),
             Contains("names vertex 9"));
}

TEST_CASE("two halves make a whole") {
  const BodyMass half = box_mass({1.0, 1.0, 1.0}, 5.0);
  const BodyMass whole = half.moved({-0.5, 0, 0}) + half.moved({0.5, 0, 0});
  CHECK((whole.inertia - box_mass({2.0, 1.0, 1.0}, 5.0).inertia).norm() < 1e-12);
}

TEST_CASE("a body is turned into its principal axes, its points stay where they are") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 tensor = turn * Vec3(1.0, 2.0, 2.5).asDiagonal() * turn.transpose();
  Machine<PredictorCorrector> m;
  const Mat3 pose = Eigen::AngleAxisd(-1.1, Vec3(0, 1, 1).normalized()).toRotationMatrix();
  const BodyId id =
      m.add_body(given_body("part", 3.0, tensor, {0.1, 0.2, 0.3}).at({1, 2, 3}, pose).moving({0.5, 0, 0}, {0, 0, 2}));
  const Body& b = m.body(id);
  CHECK(b.inertia.minCoeff() == Approx(1.0));
  CHECK(b.inertia.maxCoeff() == Approx(2.5));
  CHECK((m.reference_point(id, {0, 0, 0}) - Vec3(1, 2, 3)).norm() < 1e-14);
  CHECK((m.reference_rotation(id) - pose).norm() < 1e-14);
  CHECK((b.position() - (Vec3(1, 2, 3) + pose * Vec3(0.1, 0.2, 0.3))).norm() < 1e-14);
  const Mat3 global = b.rotation() * b.inertia.asDiagonal() * b.rotation().transpose();
  CHECK((global - pose * tensor * pose.transpose()).norm() < 1e-13);
  // The origin of the reference frame moves as given.
  const Vec3 origin_velocity = b.velocity() + b.angular_velocity().cross(Vec3(1, 2, 3) - b.position());
  CHECK((origin_velocity - Vec3(0.5, 0, 0)).norm() < 1e-14);
}

TEST_CASE("principal axes stay as near to the drawing's as they can") {
  const auto part = [](const Mat3& tensor) { return build_body(given_body("part", 1.0, tensor)); };
  const auto check_moments = [](const BuiltBody& b, const Vec3& moments, double tolerance) {
    CHECK((b.body.inertia - moments).norm() < tolerance);
  };
  // A wheel about y whose products of inertia are those of single precision: it keeps its axes and their order.
  Mat3 wheel = Vec3(3.84, 6.69, 3.84 * (1 + 1e-7)).asDiagonal();
  wheel(0, 1) = wheel(1, 0) = 2e-7;
  wheel(0, 2) = wheel(2, 0) = -3e-7;
  const BuiltBody w = part(wheel);
  check_moments(w, {3.84, 6.69, 3.84}, 1e-6);
  // The wheel's axis leans by 2e-7 / (6.69 - 3.84) rad.
  CHECK((w.reference_axes - Mat3::Identity()).norm() < 2e-7);
  // A ball, of which any axes are principal ones.
  Mat3 ball = Mat3::Identity();
  ball(1, 2) = ball(2, 1) = 1e-9;
  CHECK(part(ball).reference_axes == Mat3::Identity());
  // A part that was drawn askew by 0.2 rad is turned by that, whatever the order of its moments is.
  std::array<double, 3> moments = {2.0, 2.5, 3.0};
  do {
    const Vec3 given(moments[0], moments[1], moments[2]);
    const Mat3 askew = Eigen::AngleAxisd(0.2, Vec3(1, -2, 2).normalized()).toRotationMatrix();
    const BuiltBody b = part(askew * given.asDiagonal() * askew.transpose());
    check_moments(b, given, 1e-14);
    CHECK((b.reference_axes.transpose() - askew).norm() < 1e-14);
  } while (std::next_permutation(moments.begin(), moments.end()));
}

TEST_CASE("impossible bodies are refused in words") {
  Machine<PredictorCorrector> m;
  CHECK_THAT(message_of([&] { m.add_body(BodySpec{.name = "arm"}); }),
             Contains("mass of body 'arm' is 0 kg (or set fixed = true)"));
  CHECK_THAT(message_of([&] { m.add_body(given_body("arm", 1.0, Vec3(1, 1, 3))); }), Contains("no mass distribution"));
  CHECK_THAT(message_of([&] { m.add_body(brick("arm", X).at(X, 2.0 * Mat3::Identity())); }),
             Contains("not a right-handed rotation"));
  CHECK_THAT(message_of([&] {
               box_body("b", {1, 0, 1}, 1000.0);
             }),
             Contains("body 'b': smallest edge of a box is 0 m"));
  CHECK_THAT(message_of([&] { sphere_body("b", 1, -1.0); }), Contains("body 'b': density is -1"));
  CHECK_THAT(message_of([&] { m.add_body(brick("arm", Vec3(0, std::nan(""), 0))); }),
             Contains("body 'arm' was given (0, nan, 0)") && Contains("must be finite"));
  CHECK_THAT(message_of([&] { m.add_body(brick("arm", X).moving(Vec3(HUGE_VAL, 0, 0))); }), Contains("must be finite"));
  Mat3 half = Vec3(1.0, 1.2, 1.4).asDiagonal();
  half(1, 0) = 0.1;  // without its mirror image
  CHECK_THAT(message_of([&] { m.add_body(given_body("arm", 1.0, half)); }),
             Contains("inertia tensor is not symmetric") && Contains("differ by 0.1"));
  m.add_body(brick("arm", X));
  CHECK_THAT(message_of([&] { m.add_body(brick("arm", Y)); }), Contains("two bodies are named 'arm'"));
  CHECK_THAT(message_of([&] { m.body_named("leg"); }), Contains("no body is named 'leg'; there ") && Contains("'arm'"));
}

TEST_CASE("a free body keeps energy and angular momentum, and turns over about its middle axis") {
  // I1 < I2 < I3; spin close to the middle axis. Euler's solution: w2 is periodic with 4 K(k) / rate.
  const Vec3 inertia(1.0, 2.0, 2.5), w(0.01, 3.0, 0.02);
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const BodyId id = m.add_body(given_body("racket", 1.0, inertia).moving({0.1, 0, 0}, w));
  const double e2 = inertia.dot(w.cwiseAbs2()), l2 = inertia.cwiseProduct(w).squaredNorm();
  const double I1 = inertia[0], I2 = inertia[1], I3 = inertia[2];
  double rate = std::sqrt((I3 - I2) * (l2 - e2 * I1) / (I1 * I2 * I3));
  double k2 = (I2 - I1) * (e2 * I3 - l2) / ((I3 - I2) * (l2 - e2 * I1));
  if (k2 > 1.0) {  // turns about the first axis instead of the third: exchange them
    rate *= std::sqrt(k2);
    k2 = 1.0 / k2;
  }
  const double period = 4.0 * std::comp_ellint_1(std::sqrt(k2)) / rate;
  const Vec3 momentum = angular_momentum(m.body(id));
  const double energy = kinetic_energy(m.body(id));
  double lowest = 3.0, before = 3.0;
  std::vector<double> crossings;  // s, where w2 changes its sign: half a period apart
  const double dt = period / 50000.0;
  REQUIRE(m.run(period, dt, [&] {
    const double now = m.body(id).motion.angular_velocity.y;
    lowest = std::min(lowest, now);
    if ((now > 0.0) != (before > 0.0)) crossings.push_back(m.time() - dt * now / (now - before));
    before = now;
  }));
  CHECK(lowest < -2.99);  // it turned over
  REQUIRE(crossings.size() == 2);
  // The turn over is exponentially sensitive to w1 and w3: an error of 1e-5 in them shifts it by 1e-5 of 1/1.3 s.
  CHECK(crossings[1] - crossings[0] == Approx(0.5 * period).epsilon(1e-5));
  // Second order in dt; w dt is about 1e-3, so 1e-6 relative a turn and less than 1e-5 over the period.
  CHECK(kinetic_energy(m.body(id)) == Approx(energy).epsilon(1e-5));
  CHECK((angular_momentum(m.body(id)) - momentum).norm() < 1e-5 * momentum.norm());
  CHECK(m.body(id).motion.angular_velocity.y == Approx(3.0).epsilon(1e-3));
  CHECK(m.body(id).position().x() == Approx(0.1 * period).epsilon(1e-9));
}

// Brakes, clutches and limited-slip differentials.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEMPLATE_TEST_CASE("a brake stops a wheel after I w / T, holds it, and lets go above its capacity", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const double inertia = 0.2, capacity = 6.0, start = 30.0, dt = 1e-4;  // stops after 1 s and 15 rad
  const BodyId wheel = m.add_body(ball("wheel", 2.0, inertia).moving(Vec3::Zero(), {0, 0, start}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const BrakeId b = m.add_brake(brake("brake", axle, capacity));
  const LoadId load = m.add_load(applied_torque("load", wheel, Z, 0.0));
  REQUIRE(m.run(0.5, dt));
  // Euler is late by a step in the angle, 30 rad/s 1e-4 s; until the spring is stretched, 1e-6 rad, there is less
  // torque.
  CHECK(m.speed(axle) == Approx(15.0).epsilon(1e-4));
  CHECK(m.coordinate(axle) == Approx(11.25).epsilon(3e-4));
  CHECK(m.brake(b).torque == Approx(-capacity).epsilon(1e-12));
  CHECK(m.brake(b).is_slipping());
  REQUIRE(m.run(0.6, dt));
  const double stopped = m.coordinate(axle);
  CHECK(stopped == Approx(15.0).epsilon(3e-4));
  CHECK(std::abs(m.speed(axle)) < 1e-12);
  CHECK_FALSE(m.brake(b).is_slipping());
  CHECK(m.brake(b).history.slip_work == Approx(0.5 * inertia * start * start).epsilon(3e-4));
  // Held against nearly all that it can hold: after the spring has settled nothing moves any more.
  // (Put on at once, it would be twice itself in a spring.)
  m.set_load(load, Signal::smooth_step(0.0, 0.99 * capacity, 1.1, 1.2));
  REQUIRE(m.run(0.2, dt));
  const double held = m.coordinate(axle);
  CHECK(held - stopped == Approx(0.99 * capacity / m.brake(b).k).epsilon(1e-6));
  REQUIRE(m.run(2.0, dt));
  CHECK(std::abs(m.coordinate(axle) - held) < 1e-13);  // rounding of an angle of 15 rad
  CHECK(m.brake(b).torque == Approx(-0.99 * capacity).epsilon(1e-9));
  // More than it can hold: it slips with what is left.
  m.set_load(load, 1.5 * capacity);
  REQUIRE(m.run(0.1, dt));
  CHECK(m.speed(axle) == Approx(0.1 * 0.5 * capacity / inertia).epsilon(2e-3));  // the spring gave way for 1 ms at most
  // Open: all of the load accelerates the wheel.
  const double before = m.speed(axle);
  m.set_capacity(b, 0.0);
  REQUIRE(m.run(0.1, dt));
  CHECK(m.speed(axle) - before == Approx(0.1 * 1.5 * capacity / inertia).epsilon(2e-3));
  CHECK(m.brake(b).torque == 0.0);
}

TEST_CASE("what a bearing carries has no share in its brake") {
  // A wheel that carries 10 kN on its hub. Open, the brake does nothing; closed, it gives its capacity and no more.
  Machine<PredictorCorrector> m;
  const BodyId wheel = m.add_body(ball("wheel", 20.0, 1.5).moving(Vec3::Zero(), {0, 50.0, 0}));
  const JointId hub = m.add_joint(revolute("hub", m.ground(), wheel, {0, 0, 0}, Y));
  m.add_load(applied_force("load", wheel, {0, 0, 0}, -Z, 1e4));
  const BrakeId b = m.add_brake(brake("brake", hub, 0.0));
  REQUIRE(m.run(1.0, 1e-4));
  CHECK(m.speed(hub) == Approx(50.0).epsilon(1e-12));
  m.set_capacity(b, Signal::ramp(0.0, 100.0, 1.0));  // pressed ever harder: I w loses T^2/2 / 100 N m/s
  REQUIRE(m.run(1.0, 1e-4));
  CHECK(m.speed(hub) == Approx(50.0 - 50.0 / 1.5).epsilon(1e-5));
}

TEMPLATE_TEST_CASE("a clutch brings two shafts to one speed, and the heat is that of an inelastic impact", "",
                   PredictorCorrector, SymplecticEuler, VelocityVerlet) {
  Machine<TestType> m;
  m.gravity.setZero();
  const double dt = 1e-4, I1 = 0.3, I2 = 0.1, w1 = 40.0, T = 10.0;
  const BodyId engine = m.add_body(ball("engine", 1.0, I1).moving(Vec3::Zero(), {w1, 0, 0}));
  const BodyId box = m.add_body(ball("box", 1.0, I2).at({0.5, 0, 0}));
  const JointId in = m.add_joint(revolute("in", m.ground(), engine, {0, 0, 0}, X));
  const JointId out = m.add_joint(revolute("out", m.ground(), box, {0.5, 0, 0}, X));
  // One pair of shafts by the difference of two joints, one between the bodies themselves.
  const BodyId p = m.add_body(ball("p", 1.0, I1).at({0, 2, 0}).moving(Vec3::Zero(), {w1, 0, 0}));
  const BodyId q = m.add_body(ball("q", 1.0, I2).at({0.5, 2, 0}));
  const ClutchId c = m.add_clutch(clutch("dry clutch", in, out, T));
  const ClutchId d = m.add_clutch(clutch("free clutch", p, q, {0.25, 2, 0}, X, T));
  const double together = w1 / (T * (1 / I1 + 1 / I2));  // 0.3 s
  REQUIRE(m.run(0.5 * together, dt));
  CHECK(m.clutch(c).speed == Approx(-0.5 * w1).epsilon(1e-3));
  CHECK(m.slip_speed(d) == Approx(-0.5 * w1).epsilon(1e-3));
  Recorder rows(m);
  rows.add(c);
  CHECK(rows.columns() ==
        std::vector<std::string>{"dry clutch_capacity_Nm", "dry clutch_torque_Nm", "dry clutch_slip_speed_rad_per_s"});
  CHECK(rows.sample()[1] == Approx(T));  // drives the output, which lags
  REQUIRE(m.run(0.6 * together, dt));
  const double common = I1 * w1 / (I1 + I2), reduced = I1 * I2 / (I1 + I2);
  CHECK(m.speed(in) == Approx(common).epsilon(1e-9));
  CHECK(m.speed(out) == Approx(common).epsilon(1e-9));
  CHECK(m.body(p).angular_velocity().x() == Approx(common).epsilon(1e-9));
  CHECK(m.body(q).angular_velocity().x() == Approx(common).epsilon(1e-9));
  // The angle of the slip is first order in Euler: w1 dt/2 of 6 rad.
  CHECK(m.clutch(c).history.slip_work == Approx(0.5 * reduced * w1 * w1).epsilon(1e-3));
  CHECK(m.clutch(d).history.slip_work == Approx(0.5 * reduced * w1 * w1).epsilon(1e-3));
}

TEMPLATE_TEST_CASE("a car with locked wheels stands on a slope and does not creep", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // A car of 1,000 kg on a road of 20 deg, with two wheels that roll without slipping: x is the way up the road.
  Machine<TestType> m;
  const double slope = 20.0 / 180 * pi, r = 0.4, dt = 1e-4, mass = 1000.0, wheel_mass = 30.0, inertia = 2.0;
  m.gravity = 9.81 * Vec3(-std::sin(slope), 0, -std::cos(slope));
  const BodyId car = m.add_body(given_body("car", mass, Vec3(500, 1500, 1500)).at({0, 0, 1}));
  const JointId road = m.add_joint(prismatic("road", m.ground(), car, {0, 0, 1}, X));
  JointId hub[2];
  BrakeId brakes[2];
  for (int k = 0; k < 2; ++k) {
    const Vec3 at(k == 0 ? -1.2 : 1.2, 0, r);
    const BodyId wheel = m.add_body(ball(k == 0 ? "rear" : "front", wheel_mass, inertia).at(at));
    hub[k] = m.add_joint(revolute("", car, wheel, at, Y));
    m.add_coupling(rack_and_pinion("", hub[k], road, r));
    brakes[k] = m.add_brake(brake("", hub[k], 0.0));
  }
  const double weight = (mass + 2 * wheel_mass) * 9.81 * std::sin(slope);  // 3,557 N, 1,423 N m at the wheels
  m.set_capacity(brakes[0], 1000.0);
  m.set_capacity(brakes[1], 1000.0);
  REQUIRE(m.run(8.0, dt));  // the car swings on its springs of 65 kN/mm, which dampers of 9 kN s/m end by 4.4 a second
  const double start = m.coordinate(road);
  CHECK(std::abs(start) < 1e-3);
  double most = 0.0;
  REQUIRE(m.run(60.0, dt, [&] { most = std::max(most, std::abs(m.coordinate(road) - start)); }));
  CHECK(most < 1e-12);  // a minute: nothing but rounding
  CHECK(std::abs(m.brake(brakes[0]).torque) == Approx(0.5 * weight * r).epsilon(1e-6));
  CHECK(std::abs(m.brake(brakes[1]).torque) == Approx(0.5 * weight * r).epsilon(1e-6));
  // One of the brakes alone slips: the car rolls with what is left.
  m.set_capacity(brakes[1], 0.0);
  REQUIRE(m.run(1.0, dt));
  const double acceleration = (weight - 1000.0 / r) / (mass + 2 * wheel_mass + 2 * inertia / (r * r));
  CHECK(m.speed(road) == Approx(-acceleration).epsilon(1e-2));  // the first metre of a millimetre stretches springs
}

TEST_CASE(
    "a limited-slip differential gives the slower wheel up to its bias ratio times the torque of the faster one") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const double dt = 1e-4, torque = 80.0, I_in = 0.01, I = 0.5, bias = 3.0, f = 4.0;
  const BodyId shaft = m.add_body(ball("shaft", 1.0, I_in));
  const BodyId left = m.add_body(ball("left", 1.0, I).at({0, 1, 0}));
  const BodyId right = m.add_body(ball("right", 1.0, I).at({0, -1, 0}));
  const JointId in = m.add_joint(revolute("in", m.ground(), shaft, {0, 0, 0}, X));
  const JointId l = m.add_joint(revolute("l", m.ground(), left, {0, 1, 0}, Y));
  const JointId r = m.add_joint(revolute("r", m.ground(), right, {0, -1, 0}, Y));
  const CouplingId gears = m.add_coupling(differential("gears", in, l, r, f));
  const ClutchId plates = m.add_clutch(limited_slip("plates", gears, 0.0, bias));
  const BrakeId grip = m.add_brake(brake("grip", r, 1e5));
  const LoadId engine = m.add_load(applied_torque("engine", shaft, X, torque));
  REQUIRE(m.run(0.2, dt));
  // The left wheel spins alone, with S/4 of the outputs' S = f (torque - I_in a_in) and a_in = f/2 a. So it does after
  // the gears were given another ratio.
  const auto check_bias = [&](double ratio) {
    const double S = ratio * torque / (1.0 + ratio * ratio * I_in / (2.0 * (1.0 + bias) * I)),
                 a = S / ((1.0 + bias) * I);
    const double before = m.speed(l);  // the gears were not under load at once
    REQUIRE(m.run(0.2, dt));
    CHECK(m.speed(l) - before == Approx(0.2 * a).epsilon(1e-3));
    CHECK(-m.brake(grip).torque == Approx(bias / (1.0 + bias) * S).epsilon(1e-3));
    CHECK(m.clutch(plates).is_slipping());
  };
  const auto shift = [&](double ratio) {
    for (const std::size_t output : {1, 2}) m.set_ratio(gears, -0.5 * ratio, output);
    REQUIRE(m.run(0.2, dt));
  };
  check_bias(f);
  shift(0.5 * f);
  check_bias(0.5 * f);
  shift(f);
  // Both wheels free: they turn together, as an open differential's would.
  m.set_load(engine, 0.0);
  m.set_capacity(grip, 0.0);
  REQUIRE(m.run(0.1, dt));
  // A preload keeps what an open one would not: the wheels turn together, however the torques differ.
  m.set_capacity(plates, 25.0);
  const LoadId ice = m.add_load(applied_torque("ice", left, Y, 20.0));
  REQUIRE(m.run(3.0, dt));
  CHECK(m.speed(l) == Approx(m.speed(r)).epsilon(1e-9));
  CHECK(m.clutch(plates).torque == Approx(-10.0).epsilon(1e-2));  // half of it moves over
  m.set_load(ice, 80.0);                                          // 40 would have to move over, 25 do
  const double l0 = m.speed(l), r0 = m.speed(r);
  REQUIRE(m.run(0.5, dt));
  // With q the difference of speeds: I q' = 80 - 2 capacity, and the capacity has the share of the gears' torque in it,
  // which accelerates the shaft, S = I_in f^2/2 (l' + r') with (I + I_in f^2/2) (l' + r') = 80.
  const double shared = 0.5 * f * f * I_in * 80.0 / (I + 0.5 * f * f * I_in);
  const double capacity = 25.0 + 0.5 * (bias - 1.0) / (bias + 1.0) * shared;
  CHECK((m.speed(l) - l0) - (m.speed(r) - r0) == Approx(0.5 * (80.0 - 2.0 * capacity) / I).epsilon(5e-3));
}

TEST_CASE("brakes and clutches that cannot be are refused, and a capacity that is no number is named") {
  Machine<PredictorCorrector> m;
  const BodyId wheel = m.add_body(ball("wheel"));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z));
  const JointId weld = m.add_joint(fixed("weld", m.ground(), m.add_body(ball("other")), {0, 0, 0}));
  check_refused([&] { m.add_brake(brake("b", weld, 1.0)); }, "'b'", "leaves no coordinate free");
  check_refused([&] { m.add_clutch(clutch("c", axle, axle, 1.0)); }, "'c' names the same coordinate twice");
  check_refused([&] { m.add_brake(brake("d", axle, 1.0).with_stiffness(0.0, 1.0)); }, "stiffness", "'d'");
  check_refused([&] { m.add_brake(brake("e", JointId(), 1.0)); }, "'e' names a joint");
  check_refused([&] { m.set_capacity(BrakeId(), 1.0); },
                "the clutch or brake that is asked for has an id that was never set");
  const JointId a = m.add_joint(revolute("a", m.ground(), m.add_body(ball("x")), {0, 0, 0}, Z));
  const CouplingId g = m.add_coupling(gear("gear", axle, a, 2.0));
  check_refused([&] { m.add_clutch(limited_slip("f", g, 0.0, 2.0)); }, "'gear'", "no differential");
  m.add_brake(brake("bad", axle, Signal::function([](double t) { return t > 0.05 ? NAN : 1.0; })));
  CHECK_THAT(m.run(0.1, 1e-3).text, Contains("The capacity of clutch or brake 'bad' is not a number"));
}

TEMPLATE_TEST_CASE("brakes hold in sub-steps too, whatever is tried in them", "", PredictorCorrector, SymplecticEuler,
                   VelocityVerlet) {
  InWorld<TestType> w;
  const BodyId wheel = w.m.add_body(ball("wheel", 2.0, 0.2).moving(Vec3::Zero(), {0, 0, 3.0}));
  const JointId axle = w.m.add_joint(revolute("axle", w.m.ground(), wheel, {0, 0, 0}, Z));
  const BrakeId b = w.m.add_brake(brake("brake", axle, 6.0));
  w.m.substeps = 4;
  w.start(1e-3);
  const auto load = [&] { w.m.body(wheel).apply_torque({0, 0, 3.0}); };  // it stops after 0.2 s and 0.3 rad
  for (int k = 0; k < 500; ++k) w.step(1e-3, Vec3::Zero(), load);
  // Forces from outside may be half a step late or early, which is 3 rad/s 0.5 ms.
  CHECK(w.m.coordinate(axle) == Approx(0.3).margin(2e-3));
  CHECK(w.m.brake(b).history.slip_work == Approx(0.5 * 0.2 * 9.0 + 3.0 * 0.3).margin(6.0 * 2e-3));
  const double held = w.m.coordinate(axle);
  for (int k = 0; k < 500; ++k) w.step(1e-3, Vec3::Zero(), load);
  CHECK(std::abs(w.m.coordinate(axle) - held) < 1e-14);
}

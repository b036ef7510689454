// What a vehicle needs of joints, springs, loads and drives.

#include "mbd_test.hpp"

using namespace dem;
using namespace dem::mbd;
using namespace dem::mbd::test;

TEST_CASE("a half shaft with a plunging joint turns the wheel evenly while it travels by 80 mm") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const double length = 0.5, travel = 0.08, speed = 50.0;
  const Vec3 at(0, length, 0), spin = speed * Y;
  const auto shaft = [&](const char* name, const Vec3& p) {
    return m.add_body(given_body(name, 3.0, Vec3(0.05, 0.02, 0.05)).at(p).moving(Vec3::Zero(), spin));
  };
  const BodyId flange = shaft("flange", Vec3::Zero()), half = shaft("half shaft", 0.5 * at), wheel = shaft("wheel", at);
  const BodyId carrier = m.add_body(brick("carrier", at, 10.0));
  const JointId in = m.add_joint(revolute("gearbox", m.ground(), flange, Vec3::Zero(), Y));
  const JointId slide = m.add_joint(prismatic("suspension", m.ground(), carrier, at, Z));
  const JointId hub = m.add_joint(revolute("hub", carrier, wheel, at, Y));
  const JointId inner = m.add_joint(plunging_constant_velocity("inner", flange, half, Vec3::Zero(), Y, Y));
  const JointId outer = m.add_joint(constant_velocity("outer", half, wheel, at, Y, Y));
  m.add_motion(prescribed_speed("engine", in, speed));
  m.add_motion(prescribed_joint("road", slide, Signal::function([=](double t) {
                                  return travel * 0.5 * (1.0 - std::cos(2 * pi * t)) - travel * std::sin(2 * pi * t);
                                })));
  m.add_actuator(joint_actuator("load", hub, 0.0, 2.0));  // 100 N m
  m.joint_tolerance = 1.0;                                // m: the jolt of the start opens joints for a moment
  REQUIRE(m.run(0.1, 1e-4));                              // the start is a jolt, as the suspension sets off at once
  double most = 0.0, uneven = 0.0, apart = 0.0;
  REQUIRE(m.run(1.0, 1e-4, [&] {
    const double h = m.coordinate(slide);
    most = std::max(most, std::abs(h));
    uneven = std::max(uneven, std::abs(m.speed(hub) / speed - 1.0));
    apart = std::max(apart, std::abs(m.coordinate(inner) - (length - std::sqrt(length * length - h * h))));
  }));
  CHECK(most > 0.08);
  // The swing of the half shaft presses joints of some 1e7 N/m by 1e-6 m, and 100 N m twist springs of 1e5 N m/rad by
  // 1 mrad.
  CHECK(apart < 1e-5);
  CHECK(uneven < 1e-4);
  CHECK(m.coordinate(hub) == Approx(m.coordinate(in)).epsilon(1e-4));
  CHECK(m.violation(inner).rotation < 2e-3);
  CHECK(m.violation(outer).displacement < 1e-4);
}

TEST_CASE("a joint that is switched off lets go, and one that is switched on takes the bodies as they are") {
  Machine<PredictorCorrector> m;
  m.gravity = {0, 0, -10.0};
  const double dt = 1e-4;
  const BodyId box = m.add_body(brick("box", {0.3, 0, 0}, 4.0));
  const JointId hold = m.add_joint(fixed("hold", m.ground(), box, {0, 0, 0}));
  const BodyId arm = m.add_body(ball("arm", 1.0, 0.1).at({0, 5, 0}).moving(Vec3::Zero(), {0, 0, 7.0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 5, 0}, Z)
                                        .with_friction({.coefficient = 0.1, .radius = 0.1, .preload = 10.0}));
  m.joint_tolerance = 1.0;  // m: joints that catch a falling body give way
  REQUIRE(m.run(0.05, dt));
  CHECK(m.reaction(hold).force.z == Approx(40.0).epsilon(1e-3));
  const double spin = m.speed(hinge), turned = m.coordinate(hinge);
  m.switch_on(hold, false);
  m.switch_on(hinge, false);
  REQUIRE(m.run(0.2, dt));
  CHECK(m.reaction(hold).force.z == 0.0);
  CHECK(m.violation(hold).displacement == 0.0);
  CHECK(m.gap(hold).displacement == Approx(0.2).epsilon(1e-3));  // g t^2/2
  CHECK(m.body(box).position().z() == Approx(-0.2).epsilon(1e-3));
  // Its friction, 2 rad/s^2, lets go with it: the trapezoidal rule has half of it in the step after.
  CHECK(m.speed(hinge) == Approx(spin).margin(1.02 * dt));
  CHECK(m.coordinate(hinge) - turned == Approx(0.2 * spin).margin(0.2 * 1.02 * dt));
  const double z = m.body(box).position().z();
  m.switch_on(hold);
  m.switch_on(hinge);
  CHECK(m.violation(hold).displacement < 1e-14);
  REQUIRE(m.run(0.1, dt));
  // It is stopped from 2 m/s within some steps: at omega dt = 0.5 that takes 2 m/s dt/0.5.
  CHECK(std::abs(m.body(box).position().z() - z) < 4.0 * 2.0 * dt);
  CHECK(m.body(box).velocity().norm() < 1e-6);
  CHECK(m.reaction(hold).force.z == Approx(40.0).epsilon(1e-3));
  CHECK(m.speed(hinge) < spin);  // and rubs again
}

TEST_CASE("every kind of joint that is switched on holds the present pose unstrained") {
  const Vec3 tilted = Vec3(0.3, -0.2, 1.0).normalized();
  const auto each = [&](JointKind kind) {
    Machine<PredictorCorrector> m;
    const BodyId a = m.add_body(brick("a", {0, 0, 0})), b = m.add_body(brick("b", {0.2, 0.1, 0.3}));
    JointSpec spec = joint(kind, "j", a, b, {0.1, 0, 0.1}, Z);
    if (traits_of(kind).two_axes) spec.axis_b = tilted;
    if (kind == JointKind::distance) spec.at_b = {0.2, 0.1, 0.3};
    const JointId j = m.add_joint(spec);
    CHECK(m.violation(j).displacement < 1e-12);
    m.switch_on(j, false);
    m.body(b).motion.position += {0.05, -0.07, 0.03};
    m.body(b).motion.rotation =
        from_eigen(rotation_between(Z, tilted)) * rotation_from_vector(Vector3<double>{0, 0, 0.4});
    INFO(name_of(kind));
    CHECK(m.gap(j).displacement + m.gap(j).rotation > 1e-3);
    m.switch_on(j);
    CHECK(m.violation(j).displacement < 1e-12);
    CHECK(m.violation(j).rotation < 1e-12);
    m.design_for(1e-4);
    m.initialise(0.0, Vec3::Zero());
    const Wrench w = m.reaction(j);  // of springs of 1e7 N/m that are stretched by rounding alone
    CHECK(norm(w.force) + norm(w.torque) < 1e-5);
  };
  for (const JointKind kind :
       {JointKind::fixed, JointKind::spherical, JointKind::revolute, JointKind::cylindrical, JointKind::prismatic,
        JointKind::planar, JointKind::universal, JointKind::constant_velocity, JointKind::plunging_constant_velocity,
        JointKind::point_on_line, JointKind::point_on_plane, JointKind::distance}) {
    each(kind);
  }
}

TEMPLATE_TEST_CASE("gears are changed while they turn, without a jump of angles", "", PredictorCorrector,
                   SymplecticEuler, VelocityVerlet) {
  // The output starts at r1 times the input's speed. In the new gear it takes part of the input's momentum: the impulse
  // J between them brings both to w2 = r2 w1, I1 (w1 - w1') = r2 J, I2 (w2' - w2) = J.
  Machine<TestType> m;
  m.gravity.setZero();
  const double dt = 1e-4, I1 = 0.2, I2 = 0.5, r1 = 0.25, r2 = 1.5, torque = 3.0;
  const BodyId a = m.add_body(ball("in", 1.0, I1).moving(Vec3::Zero(), {40.0, 0, 0}));
  const BodyId b = m.add_body(ball("out", 1.0, I2).at({1, 0, 0}).moving(Vec3::Zero(), {10.0, 0, 0}));
  const JointId in = m.add_joint(revolute("in", m.ground(), a, {0, 0, 0}, X));
  const JointId out = m.add_joint(revolute("out", m.ground(), b, {1, 0, 0}, X));
  const CouplingId box = m.add_coupling(gear("gearbox", in, out, r1));
  m.add_load(applied_torque("engine", a, X, torque));
  REQUIRE(m.run(0.5, dt));
  const double w1 = 40.0 + 0.5 * torque / (I1 + r1 * r1 * I2);
  CHECK(m.speed(in) == Approx(w1).epsilon(1e-5));
  CHECK(m.speed(out) == Approx(r1 * w1).epsilon(1e-5));
  // Neutral: the engine alone turns faster.
  m.switch_on(box, false);
  REQUIRE(m.run(0.1, dt));
  const double faster = m.speed(in);
  CHECK(faster == Approx(w1 + 0.1 * torque / I1).epsilon(1e-4));
  CHECK(m.speed(out) == Approx(r1 * w1).epsilon(1e-4));
  CHECK(m.coupling(box).multiplier == 0.0);
  // The next gear.
  const double angle = m.coordinate(out), k = m.coupling(box).k;
  m.set_ratio(box, r2);
  m.switch_on(box);
  CHECK(m.coupling(box).k < k);  // derived for the old ratio it would be too stiff
  REQUIRE(m.run(0.05, dt));
  const double w = (I1 * faster + r2 * I2 * r1 * w1) / (I1 + r2 * r2 * I2), gain = torque / (I1 + r2 * r2 * I2);
  CHECK(m.speed(in) == Approx(w + 0.05 * gain).epsilon(1e-3));
  CHECK(m.speed(out) == Approx(r2 * m.speed(in)).epsilon(1e-5));
  CHECK(m.coordinate(out) - angle == Approx(0.05 * r2 * (w + 0.025 * gain)).epsilon(2e-2));  // the shift takes 1 ms
  // A ratio that is changed under load, with the output held: the multiplier goes on from where it was. The input is
  // then out of balance by 2 %, which moves it by some 1 % in a step.
  m.add_brake(brake("stop", out, 1e4));
  REQUIRE(m.run(1.0, dt));
  const double multiplier = m.coupling(box).multiplier;
  CHECK(multiplier == Approx(-torque / r2).epsilon(1e-3));
  m.set_ratio(box, 1.02 * r2);
  REQUIRE(m.step(dt));
  CHECK(m.coupling(box).multiplier == Approx(multiplier).epsilon(0.02));
  REQUIRE(m.run(1.0, dt));
  CHECK(m.coupling(box).multiplier == Approx(multiplier / 1.02).epsilon(1e-3));
  check_refused([&] { m.set_ratio(box, 0.0); }, "'gearbox'", "switch it off");
  check_refused([&] { m.set_ratio(box, 1.0, 2); }, "term 2", "'gearbox'");
}

TEST_CASE("a law between two bodies keeps momentum and angular momentum, and is a torque converter") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const double c = 0.4, I1 = 0.3, I2 = 0.1;
  const BodyId pump = m.add_body(ball("pump", 1.0, I1).moving(Vec3::Zero(), {30.0, 0, 0}));
  const BodyId turbine = m.add_body(ball("turbine", 1.0, I2));
  const LoadId oil = m.add_load(custom_load("oil", pump, turbine, [=](double, const Body& a, const Body& b) {
    return Wrench{{0, 0, 0}, {c * (a.angular_velocity().x() - b.angular_velocity().x()), 0, 0}};
  }));
  // Off the line between the two: what b feels at its centre turns a.
  const BodyId p = m.add_body(brick("p", {0, 3, 0}, 2.0)), q = m.add_body(brick("q", {1, 3.5, 0.2}, 1.0));
  m.add_load(custom_load("pull", p, q, [](double t, const Body&, const Body&) {
    return Wrench{{1.0, -2.0, 3.0 * t}, {0.1, 0.2, -0.3}};
  }));
  REQUIRE(m.run(0.3, 1e-4));
  const double rate = c * (1 / I1 + 1 / I2), slip = 30.0 * std::exp(-rate * 0.3), mean = 30.0 * I1 / (I1 + I2);
  CHECK(m.body(pump).angular_velocity().x() == Approx(mean + slip * I2 / (I1 + I2)).epsilon(1e-6));
  CHECK(m.body(turbine).angular_velocity().x() == Approx(mean - slip * I1 / (I1 + I2)).epsilon(1e-6));
  CHECK(m.load(oil).wrench.torque.x == Approx(c * slip).epsilon(1e-3));
  CHECK((2.0 * m.body(p).velocity() + m.body(q).velocity()).norm() < 1e-13);
  // The predictor-corrector keeps it to second order in dt: 1e-8 of terms of 1 kg m^2/s.
  CHECK((angular_momentum(m.body(p)) + angular_momentum(m.body(q))).norm() < 1e-7);
  CHECK(m.body(p).angular_velocity().norm() > 1.0);
  m.switch_on(oil, false);
  const double free = m.body(turbine).angular_velocity().x();
  REQUIRE(m.run(0.1, 1e-4));
  // Half of the last torque is in the step after it.
  CHECK(m.body(turbine).angular_velocity().x() == Approx(free).margin(0.51 * c * slip / I2 * 1e-4));
  check_refused(
      [&] { m.add_load(custom_load("self", p, p, [](double, const Body&, const Body&) { return Wrench{}; })); },
      "'self'", "itself");
  check_refused([&] { m.set_load(oil, 1.0); }, "'oil' has a law of its own");
}

TEST_CASE("springs on joints swing with their stiffness and rest where their table says") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const double I = 0.2, k = 50.0, dt = 1e-4;
  const BodyId wheel = m.add_body(ball("wheel", 1.0, I).moving(Vec3::Zero(), {0, 0, 1.0}));
  const JointId axle = m.add_joint(revolute("axle", m.ground(), wheel, {0, 0, 0}, Z).starting_at(2.0));
  const SpringId bar = m.add_spring(joint_spring("bar", axle, k));
  // Soft to 0.1 rad, stiff beyond, and a slide with a coil of given free length.
  const BodyId arm = m.add_body(ball("arm", 1.0, 0.1).at({1, 0, 0}));
  const JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {1, 0, 0}, Z));
  const SpringId rubber =
      m.add_spring(joint_spring_table("rubber", hinge, {{-0.3, 45.0}, {-0.1, 5.0}, {0.1, -5.0}, {0.3, -45.0}}, 3.0));
  m.add_load(applied_torque("torque", arm, Z, 25.0));
  const BodyId block = m.add_body(ball("block", 2.0).at({2, 0, 0}));
  const JointId guide = m.add_joint(prismatic("guide", m.ground(), block, {2, 0, 0}, Z));
  m.add_spring(joint_spring("coil", guide, 800.0, 60.0, 0.25));
  const double omega = std::sqrt(k / I), quarter = 0.5 * pi / omega;
  REQUIRE(m.run(quarter, dt));
  CHECK(m.coordinate(axle) == Approx(2.0 + 1.0 / omega).epsilon(1e-5));
  CHECK(m.spring(bar).force == Approx(-k / omega).epsilon(1e-3));
  const double swing = m.coordinate(axle);
  m.switch_on(bar, false);
  REQUIRE(m.run(2.0, dt));
  CHECK(std::abs(m.coordinate(axle) - swing) < 1e-2);  // it was at its turning point
  CHECK(m.coordinate(hinge) == Approx(0.2).epsilon(1e-6));
  CHECK(m.spring(rubber).force == Approx(-25.0).epsilon(1e-6));
  CHECK(m.coordinate(guide) == Approx(0.25).epsilon(1e-6));
  const JointId weld = m.add_joint(fixed("weld", arm, block, {1.5, 0, 0}));
  check_refused([&] { m.add_spring(joint_spring("no", weld, 1.0)); }, "'no'", "leaves no coordinate free");
}

TEST_CASE("a bushing with tables gives the force and torque of each axis, which are the gradient of its energy") {
  Machine<PredictorCorrector> m;
  const BodyId b = m.add_body(brick("b", {0, 0, 0}));
  const BushingTables tables{.x = {{-0.02, -2000.0}, {-0.01, -100.0}, {0.01, 100.0}, {0.02, 2000.0}},
                             .y = {{-1.0, -3e4}, {1.0, 3e4}},
                             .z = {{-0.01, 0.0}, {0.0, 0.0}, {0.02, 400.0}},  // no pull
                             .about_z = {{-0.2, -50.0}, {-0.1, -2.0}, {0.1, 2.0}, {0.2, 50.0}}};
  const JointId rubber = m.add_joint(bushing("rubber", m.ground(), b, {0, 0, 0}, Z, tables, {10, 20, 30}, {1, 2, 3}));
  const auto at = [&](const Vector3<double>& d, const Vector3<double>& turn) {
    m.body(b).motion.position = d;
    m.body(b).motion.rotation = rotation_from_vector(turn);
    m.initialise(0.0, Vec3::Zero());
    return m.reaction(rubber);
  };
  const auto energy = [&] { return energy_of(m.parts(), Vec3::Zero()).elastic; };
  CHECK(at({0.015, 0, 0}, {0, 0, 0}).force.x == Approx(-1050.0));
  CHECK(energy() == Approx(0.5 * 0.01 * 100.0 + 0.005 * 0.5 * (100.0 + 1050.0)));
  CHECK(at({-0.015, 0, 0}, {0, 0, 0}).force.x == Approx(1050.0));
  CHECK(at({0, 0.01, 0}, {0, 0, 0}).force.y == Approx(-300.0));
  CHECK(at({0, 0, -0.01}, {0, 0, 0}).force.z == 0.0);
  CHECK(at({0, 0, 0.01}, {0, 0, 0}).force.z == Approx(-200.0));
  CHECK(at({0, 0, 0}, {0, 0, 0.15}).torque.z == Approx(-26.0));
  CHECK(energy() == Approx(0.5 * 0.1 * 2.0 + 0.05 * 0.5 * (2.0 + 26.0)));
  CHECK(norm(at({0, 0, 0}, {0.3, 0, 0}).torque) < 1e-12);  // an empty table resists nothing
  m.body(b).motion.velocity = {1, 1, 1};
  const Wrench w = at({0, 0, 0}, {0, 0, 0});
  CHECK((to_eigen(w.force) - Vec3(-10, -20, -30)).norm() < 1e-12);
  m.body(b).motion.velocity = {0, 0, 0};
  // About an axis askew the torque is what the energy falls by.
  const Vector3<double> r = {0.2, -0.1, 0.16};
  const Vector3<double> t = at({0, 0, 0}, r).torque;
  for (int i = 0; i < 3; ++i) {
    const double h = 1e-5;
    const Vector3<double> little = from_eigen(Vec3(h * Vec3::Unit(i)));
    m.body(b).motion.rotation = rotation_from_vector(little) * rotation_from_vector(r);
    const double up = energy();
    m.body(b).motion.rotation = rotation_from_vector(-little) * rotation_from_vector(r);
    CHECK(to_eigen(t)[i] == Approx(-(up - energy()) / (2 * h)).epsilon(1e-6).margin(1e-9));
  }
  check_refused(
      [&] {
        m.add_joint(bushing("none", m.ground(), b, {0, 0, 0}, Z, BushingTables{}, {0, 0, 0}, {0, 0, 0}));
      },
      "'none'", "no stiffness at all");
}

TEST_CASE("an engine pulls, brakes with closed throttle, and idles") {
  Machine<PredictorCorrector> m;
  m.gravity.setZero();
  const double I = 0.25, dt = 1e-4, drag = 0.2;
  const auto crank = [&](const char* name, double y, double speed) {
    const BodyId b = m.add_body(ball(name, 1.0, I).at({0, y, 0}).moving(Vec3::Zero(), {speed, 0, 0}));
    return m.add_joint(revolute(name, m.ground(), b, {0, y, 0}, X));
  };
  const JointId a = crank("a", 0, 100.0), b = crank("b", 1, 100.0), c = crank("c", 2, 60.0);
  const Curve flat = {{0.0, 180.0}, {300.0, 180.0}}, motoring = Curve::line(0.0, -drag);
  const ActuatorId car = m.add_actuator(engine("car", a, flat, motoring, 1.0));
  m.add_actuator(engine("mapped", b, {{0.0, motoring}, {0.5, Curve::line(100.0, 0.0)}, {1.0, flat}}, 0.75));
  const ActuatorId idler =
      m.add_actuator(engine("idler", c, flat, Curve::line(-20.0, 0.0).held_outside()).idling_at(75.0, 0.05));
  REQUIRE(m.run(0.1, dt));
  CHECK(m.speed(a) == Approx(100.0 + 0.1 * 180.0 / I).epsilon(1e-9));
  CHECK(m.speed(b) == Approx(100.0 + 0.1 * 140.0 / I).epsilon(1e-9));
  CHECK(m.actuator(car).power() == Approx(180.0 * m.speed(a)).epsilon(1e-3));
  const double w = m.speed(a);
  m.set_throttle(car, 0.0);
  REQUIRE(m.run(0.5, dt));
  CHECK(m.speed(a) == Approx(w * std::exp(-0.5 * drag / I)).margin(0.51 * 180.0 / I * dt));  // engine braking
  // Idling: a tenth of the throttle balances 20 N m of drag, which the governor gives 2 rad/s below 75.
  REQUIRE(m.run(2.0, dt));
  CHECK(m.speed(c) == Approx(73.0).epsilon(1e-9));
  m.set_throttle(idler, 0.5);
  const double before = m.speed(c);
  REQUIRE(m.run(0.1, dt));
  CHECK(m.speed(c) == Approx(before + 0.1 * 80.0 / I).epsilon(1e-3));
  check_refused([&] { m.set_throttle(car, -0.5); }, "throttle of an engine");
  check_refused([&] { m.set_target(car, 1.0); }, "'car'");
  check_refused([&] { m.add_actuator(engine("no", a, Curve{}, motoring)); }, "'no' needs two tables");
  check_refused([&] { m.add_actuator(engine("no", a, {{0.0, motoring}, {0.9, flat}})); }, "'no'", "last one 1");
  check_refused([&] { motor("m", a, flat).idling_at(70.0); }, "'m' is no engine");
}

TEST_CASE("an anti-roll bar resists the difference of both wheels and leaves bounce alone") {
  const double k = 2e4, bar = 1.5e4, force = 300.0;
  for (const bool on_points : {true, false}) {
    Machine<PredictorCorrector> m;
    m.gravity.setZero();
    const BodyId chassis = m.add_body(brick("chassis", {0, 0, 0.5}, 500.0));
    m.add_joint(fixed("stand", m.ground(), chassis, {0, 0, 0.5}));
    BodyId wheel[2];
    JointId slide[2];
    LoadId load[2];
    for (int i = 0; i < 2; ++i) {
      const Vec3 at(0, i == 0 ? 0.7 : -0.7, 0.3);
      const std::string side = i == 0 ? "left" : "right";
      wheel[i] = m.add_body(ball(side, 30.0, 1.0).at(at));
      slide[i] = m.add_joint(prismatic("slide " + side, chassis, wheel[i], at, Z));
      m.add_spring(joint_spring("spring " + side, slide[i], k, 2000.0));
      load[i] = m.add_load(applied_force("road " + side, wheel[i], at, Z, i == 0 ? force : 0.0));
    }
    const CouplingId stabiliser = on_points ? m.add_anti_roll_bar({.name = "bar",
                                                                   .chassis = chassis,
                                                                   .left = wheel[0],
                                                                   .right = wheel[1],
                                                                   .at_left = {0.1, 0.6, 0.3},
                                                                   .at_right = {0.1, -0.6, 0.3},
                                                                   .stiffness = bar})
                                            : m.add_coupling(anti_roll_bar("bar", slide[0], slide[1], bar));
    REQUIRE(m.run(1.5, 2e-4));
    // (k + bar) l - bar r = F, (k + bar) r - bar l = 0; the chassis tilts by 1e-6 rad.
    const double l = force * (k + bar) / (k * (k + 2 * bar)), r = force * bar / (k * (k + 2 * bar));
    CHECK(m.coordinate(slide[0]) == Approx(l).epsilon(3e-4));
    CHECK(m.coordinate(slide[1]) == Approx(r).epsilon(3e-4));
    CHECK(m.coupling(stabiliser).multiplier == Approx(-bar * (l - r)).epsilon(3e-4));
    m.set_load(load[1], force);
    REQUIRE(m.run(1.5, 2e-4));
    CHECK(m.coordinate(slide[0]) == Approx(force / k).epsilon(1e-4));
    CHECK(std::abs(m.coupling(stabiliser).multiplier) < 1e-3 * force);
  }
}

TEST_CASE("points of a body's drawing have a velocity") {
  Machine<PredictorCorrector> m;
  const Vec3 v(1, 2, 3), w(0.3, -0.5, 0.9), p(0.4, 0.1, -0.2);
  const Mat3 turn = to_eigen(rotation_from_vector(Vector3<double>{0.2, 0.7, -0.4}));
  BodySpec spec = given_body("car", 3.0, Vec3(0.3, 0.4, 0.5), {0.6, -0.2, 0.1}).at({5, 6, 7}, turn).moving(v, w);
  const BodyId car = m.add_body(spec);
  CHECK((m.reference_velocity(car) - v).norm() < 1e-14);
  CHECK((m.reference_point_velocity(car, p) - (v + w.cross(Vec3(turn * p)))).norm() < 1e-14);
  const ConnectionId hook = m.add_connection_in_reference("hook", car, p);
  CHECK((m.connection_velocity(hook) - m.reference_point_velocity(car, p)).norm() < 1e-14);
}

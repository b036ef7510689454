// The suspension against the kinematics of its points, and the whole car against a model with rigid joints: at rest,
// and rocking.

// gcc 12 takes the undefined registers of its own AVX-512 header for a mistake of Eigen's matrices of open size.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "catch.hpp"
#include "reference_model.hpp"

#include <dem/mbd/mbd.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

using namespace dem;
using namespace dem::vehicle;
using dem::vehicle::test::Corner;
using dem::vehicle::test::RigidModel;

namespace {

using Machine = mbd::Machine<integrator::VelocityVerlet>;

/// The Humvee with tyres that put no force to the side, and nothing that damps it but the shocks.
VehicleSpec plain_humvee() {
  VehicleSpec s = humvee({.rubber_rear = false});
  s.tyre.damping = 0.0;
  s.tyre.lateral_stiffness = 1.0;
  s.tyre.tread_damping = 0.0;
  return s;
}

struct Car {
  Machine machine;
  Vehicle vehicle;
  explicit Car(const VehicleSpec& s) {
    const RigidModel::State u = RigidModel{s}.at_rest();
    vehicle = add_vehicle(Assembly(machine, "car", Vec3(0, 0, u[2])), s, Road{});
    machine.joint_tolerance = 0.5;  // m: light shafts wind up; how far points of the car are off is checked below
    machine.design_for(5e-5);
  }
};

}  // namespace

TEST_CASE("wheel travel, camber and toe over bump are those of the points") {
  const VehicleSpec car = humvee();
  for (const bool front : {true, false}) {
    DoubleWishboneSpec spec = front ? car.front : car.rear;
    spec.spring_force = {{0.0, 0.0}, {1.0, 0.0}};
    spec.shock = 0.0;
    spec.upper_ball.is_rubber = spec.lower_ball.is_rubber = false;
    Machine m;
    m.gravity = Vec3::Zero();
    const Assembly in(m);
    const DoubleWishbone w = add_double_wishbone(in, "corner", m.ground(), spec);
    add_toe_link(in, "corner", m.ground(), w.knuckle, spec.points);
    // 0.25 rad are 0.12 m of wheel travel, up and then down.
    m.add_motion(mbd::prescribed_joint("bump", w.lower_hinge, mbd::Signal::sine(0.25, 0.5)));
    const Corner corner{spec.points};
    double largest_travel = 0.0, largest_toe = 0.0;
    for (int k = 0; k < 8; ++k) {
      REQUIRE(m.run(0.25, 1e-4));
      const double q = m.coordinate(w.lower_hinge);
      const Mat3 turn = m.reference_rotation(w.knuckle);
      const Vec3 wheel = m.reference_point(w.knuckle, spec.points.wheel - spec.points.knuckle);
      const Vec3 axis = turn * Vec3::UnitY(), expected = corner.axis(q);
      INFO((front ? "front" : "rear") << " at " << q << " rad");
      // Joints give way by m a/k: 35 kg at 1.3 m/s^2 on some 1e7 N/m, 5 um, and this on levers of 0.3 m.
      CHECK(wheel.z() - spec.points.wheel.z() == Approx(corner.travel(q)).margin(1e-5));
      CHECK(std::asin(axis.z()) == Approx(std::asin(expected.z())).margin(3e-5));
      CHECK(std::atan2(-axis.x(), axis.y()) == Approx(std::atan2(-expected.x(), expected.y())).margin(3e-5));
      largest_travel = std::max(largest_travel, std::abs(wheel.z() - spec.points.wheel.z()));
      largest_toe = std::max(largest_toe, std::abs(axis.x()));
    }
    CHECK(largest_travel > 0.1);
    CHECK(largest_toe > 1e-3);
  }
}

TEST_CASE("a rack steers to where it is told, with rods behind the kingpins and ahead of them") {
  for (const bool is_ahead : {false, true}) {
    VehicleSpec spec = humvee({.rubber_rear = false});
    Vec3 &inner = spec.steering.rod_inner, &outer = spec.steering.rod_outer;
    if (is_ahead) outer.x() -= 2.0 * spec.steering_arm(), inner.x() = outer.x() - 0.05;
    CHECK((spec.steering_arm() > 0.0) == is_ahead);
    Machine m;
    m.joint_tolerance = 0.5;  // m: light shafts wind up
    Vehicle car = add_vehicle(Assembly(m, "car", Vec3(0, 0, 0.46 - spec.front.points.wheel.z())), spec, Road{});
    const double dt = 5e-5;
    design_for(m, dt);
    for (long k = std::lround(0.6 / dt); k > 0; --k) {
      drive(m, car, {.steer = 0.2}, dt);
      REQUIRE(m.step(dt));
    }
    for (const std::size_t k : {0, 1}) CHECK(steer_of(m, car, k) == Approx(0.2).margin(0.05));
  }
  VehicleSpec spec = humvee();
  spec.steering.rod_outer.x() -= spec.steering_arm();
  Machine m;
  CHECK_THROWS_WITH(add_vehicle(Assembly(m), spec), Catch::Matchers::Contains("tie rods must end 0.001 m or more"));
}

TEST_CASE("at rest the car stands where its energy is least, and its axles carry its weight") {
  const VehicleSpec spec = plain_humvee();
  Car car(spec);
  const mbd::Mechanism& m = car.machine;
  REQUIRE(car.machine.run(8.0, 5e-5));  // a bounce loses a third each 0.6 s
  const RigidModel::State u = RigidModel{spec}.at_rest();
  const Vehicle& v = car.vehicle;
  // Joints give way by some 0.1 mm under 20 kN.
  CHECK(point_of(m, v, Vec3::Zero()).z() == Approx(u[2]).margin(1e-3));
  for (std::size_t k = 0; k < 4; ++k) {
    const Corner corner = RigidModel{spec}.corner(k);
    CHECK(travel_of(m, v, k) == Approx(corner.travel(u[6 + static_cast<int>(k)])).margin(1e-3));
  }
  double weight = 0.0, moment = 0.0;
  for (const Body& b : m.bodies()) {
    weight += 9.81 * b.mass;
    moment += 9.81 * b.mass * b.position().x();
  }
  const auto tyre = [&](std::size_t k) { return tyre_of(m, v.wheels[k]); };
  const double front = tyre(0).load + tyre(1).load, rear = tyre(2).load + tyre(3).load;
  CHECK(front + rear == Approx(weight).epsilon(1e-3));
  CHECK(front * tyre(0).contact.x() + rear * tyre(2).contact.x() == Approx(moment).margin(1e-3 * weight));
  // 1.5e-6 was seen; what is left of the swing after 8 s need not be the same on both sides.
  CHECK(tyre(0).load == Approx(tyre(1).load).epsilon(1e-5));
}

TEST_CASE("bounce, pitch and roll have the frequencies of the linear model") {
  const VehicleSpec spec = plain_humvee();
  const RigidModel model{spec};
  const RigidModel::State u0 = model.at_rest();
  for (const bool symmetric : {true, false}) {
    const RigidModel::Matrix modes = symmetric ? RigidModel::symmetric() : RigidModel::antisymmetric();
    const RigidModel::Matrix K = model.stiffness(u0, modes), M = model.mass(u0, modes);
    const Eigen::GeneralizedSelfAdjointEigenSolver<RigidModel::Matrix> linear(K, M);
    Car car(spec);
    const mbd::Mechanism& m = car.machine;
    const Vehicle& v = car.vehicle;
    REQUIRE(car.machine.run(3.0, 5e-5));
    for (auto& s : car.machine.parts().springs) {
      if (s.spec.name.find("shock") != std::string::npos) s.spec.force_over_speed = {};
    }
    const auto coordinates = [&] {
      Eigen::VectorXd w(5);
      const Vec3 at = point_of(m, v, Vec3::Zero());
      const Mat3 r = m.reference_rotation(v.chassis);
      std::array<double, 4> q;
      for (std::size_t k = 0; k < 4; ++k) q[k] = m.coordinate(v.suspension[k].lower_hinge);
      if (symmetric) {
        w << at.x(), at.z(), std::asin(-r(2, 0)), 0.5 * (q[0] - q[1]), 0.5 * (q[2] - q[3]);
      } else {
        w << at.y(), std::atan2(r(2, 1), r(2, 2)), std::atan2(r(1, 0), r(0, 0)), 0.5 * (q[0] + q[1]),
            0.5 * (q[2] + q[3]);
      }
      return w;
    };
    const Eigen::VectorXd rest = coordinates();
    // A push of 2 cm/s and 1 deg/s: millimetres, within one piece of the springs' tables.
    Body& chassis = car.machine.body(v.chassis);
    chassis.motion.velocity.z += symmetric ? 0.02 : 0.0;
    const Vec3 spin = symmetric ? Vec3(0, 0.01, 0) : Vec3(0.02, 0, 0);
    chassis.motion.angular_velocity += from_eigen(Vec3(chassis.rotation().transpose() * spin));
    std::vector<Eigen::VectorXd> way;
    for (int k = 0; k < 600; ++k) {
      REQUIRE(car.machine.run(0.01, 5e-5));
      way.push_back(coordinates() - rest);
    }
    // The modes of the body: the lowest ones that the springs hold. The first of the symmetric ones is driving off, the
    // first two of the others are sliding and turning.
    const int first = symmetric ? 1 : 2, last = symmetric ? 2 : 2;
    for (int mode = first; mode <= last; ++mode) {
      const double expected = std::sqrt(linear.eigenvalues()[mode]) / (2.0 * M_PI);
      const Eigen::VectorXd weights = M * linear.eigenvectors().col(mode);
      // Zero crossings of what the motion has of this mode.
      double from = 0.0, to = 0.0, mean = 0.0;
      int count = -1;
      std::vector<double> a;
      for (const auto& w : way) a.push_back(weights.dot(w));
      for (const double x : a) mean += x / static_cast<double>(a.size());
      for (std::size_t k = 1; k < a.size(); ++k) {
        const double x = a[k - 1] - mean, y = a[k] - mean;
        if (x < 0.0 && y >= 0.0) {
          to = 0.01 * (static_cast<double>(k) + x / (x - y));
          if (++count == 0) from = to;
        }
      }
      REQUIRE(count > 3);
      const double measured = count / (to - from);
      WARN((symmetric ? "bounce or pitch " : "roll ") << measured << " Hz, linear " << expected << " Hz");
      CHECK(measured == Approx(expected).epsilon(0.03));
    }
  }
}

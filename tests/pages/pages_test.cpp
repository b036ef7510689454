// The pages' pieces of code that are in no example, letter by letter (cmake/check_pages.sh compares them).

#include "catch.hpp"

#include <dem/grain/materials.hpp>
#include <dem/law/friction/cundall_strack.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/normal/elastic.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/normal/restitution.hpp>
#include <dem/mbd/mbd.hpp>
#include <dem/world/model.hpp>

#include <cmath>

using Catch::Approx;

namespace {

struct Found {
  double angle, carried;
};

int machine_of_readme(Found& found) {
  // clang-format off
#include <dem/mbd/mbd.hpp>

using namespace dem::mbd;
Machine<dem::integrator::PredictorCorrector> m;  // gravity is 9.81 m/s^2 along -z
const dem::BodyId arm = m.add_body(box_body("arm", {1, 0.1, 0.1}, 2700).at({0.5, 0, 0}));
const dem::JointId hinge = m.add_joint(revolute("hinge", m.ground(), arm, {0, 0, 0}, {0, 1, 0}));
m.add_actuator(joint_actuator("servo", hinge, 2e4, 2e3, Signal::smooth_step(0, -0.5, 0, 1)));  // -0.5 about y is up
if (const auto report = m.run(2.0, 1e-4); !report) return fmt::print("{}\n", report.text), 1;
fmt::print("angle {:.4f} rad, the hinge carries {:.1f} N\n", m.coordinate(hinge), m.reaction(hinge).force.z);
  // clang-format on
  found = {m.coordinate(hinge), m.reaction(hinge).force.z};
  return 0;
}

struct Elastic : dem::Model {
  using Normal = dem::contact::Hertz;
  using Friction = dem::friction::Mindlin;
};
struct Springs : dem::Model {
  using Normal = dem::contact::LinearSpringDashpot;
  using Friction = dem::friction::CundallStrack;
};
struct Worlds {
  dem::ContactParameters<Elastic> elastic;
  dem::ContactParameters<Springs> springs;

  void set_contact(const dem::ContactParameters<Elastic>& p) { elastic = p; }
  void set_contact(const dem::ContactParameters<Springs>& p) { springs = p; }
};

Worlds constants_of_architecture() {
  Worlds world;
  // clang-format off
const auto quartz = dem::contact::elastic_pair({.young = 7e10, .poisson = 0.2});
const double e = 0.7, mu = 0.4;
world.set_contact({.normal = dem::contact::Hertz::with_restitution(quartz, e),  // Normal = Hertz, Friction = Mindlin
                   .friction = dem::friction::Mindlin::with_restitution(quartz, mu, e)});

// Normal = LinearSpringDashpot, Friction = CundallStrack: the spring of an impact that lasts as long as Hertz's
const double k = dem::contact::stiffness_of_equal_time(quartz, {.effective_radius = 5e-4, .effective_mass = 5e-6, .speed = 0.1});
world.set_contact({.normal = dem::contact::LinearSpringDashpot::with_restitution(k, e),
                   .friction = dem::friction::CundallStrack::with_restitution(quartz, mu, k, e)});
  // clang-format on
  return world;
}

}  // namespace

TEST_CASE("the machine of the README swings to its set point, and its hinge carries the arm") {
  Found found{};
  REQUIRE(machine_of_readme(found) == 0);
  // The servo is a spring of 2e4 N m/rad that the weight of the arm, 27 kg and 0.5 m out, turns on; a second at rest.
  const double weight = 27.0 * 9.81;
  CHECK(found.angle == Approx(-0.5 + 0.5 * weight * std::cos(found.angle) / 2e4).epsilon(1e-5));
  CHECK(found.carried == Approx(weight).epsilon(1e-5));
}

TEST_CASE("the constants of ARCHITECTURE are those of quartz") {
  const Worlds w = constants_of_architecture();
  CHECK(w.elastic.normal.modulus == Approx(7e10 / (2 * (1 - 0.04))));         // E*
  CHECK(w.elastic.friction.shear_modulus == Approx(7e10 / 2.4 / (2 * 1.8)));  // G* = G/(2 (2 - nu))
  CHECK(w.elastic.friction.coefficient == 0.4);
  CHECK(w.springs.friction.stiffness == Approx(w.springs.normal.stiffness * 2 * 0.8 / 1.8));
  // Both laws rebound alike for one damping ratio.
  CHECK(dem::contact::restitution_of(w.springs.normal.damping_ratio) == Approx(0.7).epsilon(1e-9));
  CHECK(dem::contact::restitution_of(w.elastic.normal.damping_ratio) == Approx(0.7).epsilon(1e-9));
}

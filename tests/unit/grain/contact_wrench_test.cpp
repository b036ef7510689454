#include "catch.hpp"

#include <dem/grain/contact_wrench.hpp>
#include <dem/law/cohesion/dmt.hpp>
#include <dem/law/cohesion/jkr.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/friction/coulomb_viscous.hpp>
#include <dem/law/friction/mindlin.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/normal/hertz.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/law/normal/linear_spring_dashpot.hpp>
#include <dem/law/rolling/torsion.hpp>
#include <dem/world/model.hpp>

using Catch::Approx;
using namespace dem;

namespace {

struct Plastic : Model {
  using Normal = contact::Hysteretic;
  using Friction = friction::CoulombViscous;
  using Cohesion = cohesion::LiquidBridge;
};
struct Sticky : Model {
  using Normal = contact::Hertz;
  using Friction = friction::CoulombViscous;
  using Rolling = rolling::Torsion;
  using Cohesion = cohesion::DMT;
};
struct Soft : Sticky {
  using Cohesion = cohesion::JKR;
};

struct Pulling : Model {
  using Normal = contact::LinearSpringDashpot;
};

constexpr double radius = 1e-3;

template <class M>
grain::NormalForce<double> at(double overlap, const ContactParameters<M>& p, ContactHistory<M, double>& h) {
  return grain::normal_force<M>(contact::NormalState<double>{overlap, 0.0, radius, 1e-5, 1e-6}, p, h);
}

}  // namespace

TEST_CASE("across a gap the normal law does nothing and forgets, and the bridge pulls on") {
  const ContactParameters<Plastic> p = {{1000, 4000}, {0, 0}, {}, cohesion::LiquidBridge::of(0.07, 0.0, 1e-12)};
  const double whole = 4 * M_PI * radius * 0.07;
  ContactHistory<Plastic, double> h = {};
  CHECK(at<Plastic>(2e-5, p, h).repulsion == Approx(0.02 - whole));
  CHECK(at<Plastic>(1.75e-5, p, h).repulsion == Approx(0.01 - whole));  // along the steep line
  CHECK(at<Plastic>(1.75e-5, p, h).pressing == Approx(0.01));           // the pull is not what presses
  const auto apart = at<Plastic>(-1e-6, p, h);
  CHECK(apart.repulsion < 0.0);
  CHECK(apart.repulsion > -whole);
  CHECK(apart.pressing == 0.0);
  CHECK(h.normal.largest_overlap == 0.0);
  CHECK(h.cohesion.formed == 1.0);
  CHECK(at<Plastic>(1e-5, p, h).repulsion == Approx(0.01 - whole));  // a fresh contact: along the first line
}

TEST_CASE("what limits friction is the repulsion and the grip, never less than nothing") {
  const double modulus = 1e8, work = 0.1, overlap = 1e-7;
  const double hertz = 4.0 / 3.0 * modulus * std::sqrt(radius * overlap) * overlap;
  ContactHistory<Sticky, double> dmt = {};
  const auto a = at<Sticky>(overlap, {{modulus, 0.0}, {0, 0}, {0, 1, 0}, {work}}, dmt);
  CHECK(a.repulsion == Approx(hertz - 2 * M_PI * work * radius));
  CHECK(a.pressing == Approx(hertz));
  ContactHistory<Soft, double> jkr = {};
  const ContactParameters<Soft> p = {{modulus, 0.0}, {0, 0}, {0, 1, 0}, {work, modulus}};
  const auto b = at<Soft>(overlap, p, jkr);
  CHECK(b.repulsion < hertz);
  CHECK(b.pressing == Approx(b.repulsion + 3 * M_PI * work * radius));
  const auto gap = at<Soft>(-0.9 * cohesion::JKR::range(p.cohesion, radius), p, jkr);
  CHECK(gap.repulsion < 0.0);
  CHECK(gap.pressing == Approx(gap.repulsion + 3 * M_PI * work * radius));
  CHECK(at<Soft>(-1e-4, p, jkr).pressing == 0.0);
}

TEST_CASE("a contact's wrench has the torque of rolling and torsion, equal and opposite") {
  const ContactParameters<Sticky> p = {{1e8, 0.0}, {0, 0}, {0.2, 1e9, 0.0}, {0.0}};
  const contact::SphereContactPoint<double> point = {{2 * radius - 1e-6, 0, 0}, radius, radius};
  const grain::RelativeMotion<double> e = {point.link, {0, 0, 0}, {3, 0, 0}, {1, 0, 0}, 1e5};
  ContactHistory<Sticky, double> h = {};
  double ratio = 0.0;
  const auto w = grain::contact_wrench<Sticky, double>(point, e, p, 1e-3, h, ratio);
  // R* = r/2; the spring is stiff, so it is at its limit: mu_t R* Fn against the spin of i.
  const double limit = 0.2 * 0.5 * radius * -w.force.x;
  CHECK(-w.force.x == Approx(4.0 / 3.0 * 1e8 * std::sqrt(0.5 * radius * 1e-6) * 1e-6));
  CHECK(w.torque_i.x == Approx(-limit));
  CHECK(w.torque_j.x == Approx(limit));
  CHECK(ratio == Approx(0.5 * 1e-6 / (0.5 * radius)));
}

TEST_CASE("a point of a patch gives its share of what the whole contact gives, by every law") {
  struct Elastic : Model {
    using Normal = contact::Hertz;
    using Friction = friction::Mindlin;
    using Rolling = rolling::Torsion;
    using Cohesion = cohesion::JKR;
  };
  const ContactParameters<Elastic> p = {{1e7, 0.3}, {0.5, 3e6, 0.2}, {0.2, 1e3, 0.3}, {0.05, 1e7}};
  const grain::RelativeMotion<double> e = {{0, 0, 2 * radius}, {0.02, -0.01, 0.1}, {3, 4, 5}, {-1, 0, 2}, 1e5};
  const auto of = [&](double share, ContactHistory<Elastic, double>& h) {
    double overlap_ratio;
    const contact::ContactPoint<double> point = {{0, 0, 1}, 1e-5, {0, 0, radius}, 0.5 * radius, share};
    return grain::contact_wrench<Elastic, double>(point, e, p, 1e-6, h, overlap_ratio);
  };
  ContactHistory<Elastic, double> whole_history = {}, share_history = {};
  for (int step = 0; step < 3; ++step) {
    const auto whole = of(1.0, whole_history), share = of(0.25, share_history);
    CHECK(norm(whole.force) > 0.0);
    CHECK(std::abs(whole.torque_i.z) > 0.0);
    // A quarter is a power of two, so nothing is rounded.
    CHECK(to_eigen(share.force) == 0.25 * to_eigen(whole.force));
    CHECK(to_eigen(share.torque_i) == 0.25 * to_eigen(whole.torque_i));
    CHECK(to_eigen(share.torque_j) == 0.25 * to_eigen(whole.torque_j));
    CHECK(to_eigen(share_history.friction.spring_force) == to_eigen(whole_history.friction.spring_force));
  }
}

TEST_CASE("points that are less than a whole contact together keep its damping ratio") {
  // A share S of the spring K with the damper 2 b sqrt(S K m) is as damped as K with 2 b sqrt(K m): sqrt(S) of
  // a whole contact's damper, and no more than the stable time step, which takes each contact as a whole one, allows.
  struct Damped : Model {
    using Normal = contact::LinearSpringDashpot;
    using Friction = friction::None;
  };
  const double k = 1000.0, b = 0.3, inverse_mass = 1e5, speed = 0.1, d = 1e-5, share = 0.25;
  const ContactParameters<Damped> p = {{k, b}, {}};
  const grain::RelativeMotion<double> e = {{0, 0, 2 * radius}, {0, 0, speed}, {0, 0, 0}, {0, 0, 0}, inverse_mass};
  const contact::ContactPoint<double> point = {{0, 0, 1}, d, {0, 0, radius}, 0.5 * radius, share, share};
  ContactHistory<Damped, double> h = {};
  double overlap_ratio;
  const double force = -grain::contact_wrench<Damped, double>(point, e, p, 1e-6, h, overlap_ratio).force.z;
  CHECK(force == Approx(share * k * d + 2.0 * b * std::sqrt(share * k / inverse_mass) * speed).epsilon(1e-14));
}

TEST_CASE("a normal law that pulls at the end of a contact presses nothing together") {
  // Friction limited by a negative force would push along the sliding.
  const ContactParameters<Pulling> p = {contact::LinearSpringDashpot::with_restitution(1e4, 0.3, true), {}};
  ContactHistory<Pulling, double> h = {};
  const auto parting = grain::normal_force<Pulling>(contact::NormalState<double>{1e-8, -1.0, radius, 1e-5, 1e-6}, p, h);
  CHECK(parting.repulsion < 0.0);
  CHECK(parting.pressing == 0.0);
}

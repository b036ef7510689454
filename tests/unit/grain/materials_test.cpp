#include "core/error_of.hpp"

#include <dem/grain/materials.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>
#include <dem/mbd/body/body.hpp>
#include <dem/world/model.hpp>

using dem::MaterialId;

namespace {
using ModelMaterials = dem::Materials<dem::Model>;

ModelMaterials::Parameters with_mu(double mu) { return {{2000.0, 0.0, 1.0}, {mu, 1000.0, 0.0, 0.0}}; }
double mu_of(const ModelMaterials& m, MaterialId a, MaterialId b) {
  return m.table()[m.row(a, b)].friction.coefficient;
}
}  // namespace

TEST_CASE("a pair of materials has one set of constants, whichever is named first") {
  ModelMaterials m;
  const MaterialId sand = m.id("sand"), steel = m.id("steel");
  m.set_default(with_mu(0.1));
  m.set("steel", "sand", with_mu(0.3));
  m.set("sand", "sand", with_mu(0.5));
  CHECK(mu_of(m, sand, steel) == 0.3);
  CHECK(mu_of(m, steel, sand) == 0.3);
  CHECK(mu_of(m, sand, sand) == 0.5);
  CHECK(mu_of(m, steel, steel) == 0.1);
  // Set again, the other way round: replaced, not doubled.
  m.set("sand", "steel", with_mu(0.7));
  CHECK(mu_of(m, steel, sand) == 0.7);
}

TEST_CASE("materials that come later leave the pairs that were set alone") {
  ModelMaterials m;
  m.set_default(with_mu(0.1));
  m.set("a", "b", with_mu(0.2));
  for (const auto* name : {"c", "d", "e", "f"}) m.set(name, "a", with_mu(0.3));
  CHECK(mu_of(m, m.id("a"), m.id("b")) == 0.2);
  CHECK(mu_of(m, m.id("b"), m.id("a")) == 0.2);
  CHECK(mu_of(m, m.id("d"), m.id("a")) == 0.3);
  CHECK(mu_of(m, m.id("d"), m.id("b")) == 0.1);
  m.set_default(with_mu(0.9));
  CHECK(mu_of(m, m.id("d"), m.id("b")) == 0.9);
  CHECK(mu_of(m, m.id("a"), m.id("b")) == 0.2);
  CHECK(m.count() == 6);
  CHECK(m.name(m.id("c")) == "c");
}

TEST_CASE("constants of one pair may be given to another") {
  ModelMaterials m;
  m.set_default(with_mu(0.1));
  m.set("a", "b", m.table()[0]);  // of the table, which grows
  m.set("c", "d", with_mu(0.2));
  m.set("a", "a", m.table()[m.row(m.id("c"), m.id("d"))]);
  m.set("c", "d", m.table()[0]);
  CHECK(mu_of(m, m.id("a"), m.id("b")) == 0.1);
  CHECK(mu_of(m, m.id("a"), m.id("a")) == 0.2);
  CHECK(mu_of(m, m.id("c"), m.id("d")) == 0.1);
}

TEST_CASE("two materials that may meet need constants") {
  ModelMaterials m;
  const MaterialId sand = m.id("sand");
  m.id("steel");
  m.id("rubber");
  m.mark_as_grain(sand);
  m.set("sand", "sand", with_mu(0.5));
  check_refused([&] { m.check_complete(); }, "no contact constants", "'sand'", "'steel'", "set_contact");
  m.set("sand", "steel", with_mu(0.5));
  check_refused([&] { m.check_complete(); }, "'sand'", "'rubber'");
  m.set("sand", "rubber", with_mu(0.5));
  CHECK_NOTHROW(m.check_complete());  // steel and rubber, both of machine parts, never meet
}

TEST_CASE("a default serves every pair") {
  ModelMaterials m;
  m.mark_as_grain(m.id("sand"));
  m.id("steel");
  m.set_default(with_mu(0.5));
  CHECK_NOTHROW(m.check_complete());
}

TEST_CASE("constants that make no sense are refused where they are set") {
  ModelMaterials m;
  check_refused([&] { m.set_default({{-1.0, 0.0, 1.0}, {0.1, 1.0, 0.0, 0.0}}); }, "normal stiffness is -1");
  check_refused(
      [&] {
        m.set("a", "b", {{1.0, 0.0, 1.0}, {-0.1, 1.0, 0.0, 0.0}});
      },
      "contact of 'a' and 'b': friction coefficient is -0.1");
}

TEST_CASE("constants of rolling and cohesion are checked, and the farthest reach of all pairs is known") {
  struct Wet : dem::Model {
    using Rolling = dem::rolling::ElasticPlastic;
    using Cohesion = dem::cohesion::LiquidBridge;
  };
  dem::Materials<Wet> m;
  const auto pair = [](double mu_r, double rupture) {
    return dem::ContactParameters<Wet>{{2000, 0, 1}, {0.4, 1000, 0, 0}, {mu_r, 1000, 0.3}, {0.07, 1e-12, rupture}};
  };
  check_refused([&] { m.set_default(pair(-0.1, 1e-4)); }, "rolling coefficient is -0.1");
  check_refused([&] { m.set("a", "b", pair(0.1, -1.0)); }, "rupture distance of a liquid bridge is -1 m");
  m.find_range(1e-3);
  CHECK(m.range() == 0.0);
  m.set("a", "a", pair(0.1, 1e-4));
  m.set("a", "b", pair(0.1, 3e-4));
  m.find_range(1e-3);
  CHECK(m.range() == 3e-4);
  m.set_default(pair(0.1, 5e-4));
  m.find_range(1e-3);
  CHECK(m.range() == 5e-4);
  CHECK(m.table()[m.row(m.id("b"), m.id("a"))].rolling.coefficient == 0.1);
  // A model that names neither takes no more room for them.
  STATIC_REQUIRE(sizeof(dem::ContactParameters<dem::Model>) == 7 * sizeof(double));
}

TEST_CASE("a cohesion law that tells a range which is none is refused") {
  struct Odd : dem::cohesion::LiquidBridge {
    static double range(const Parameters<double>& p, double) { return p.rupture; }
    static void check(const Parameters<double>&) {}
  };
  struct Model : dem::Model {
    using Cohesion = Odd;
  };
  for (const double told : {std::nan(""), HUGE_VAL, -1e-3}) {
    dem::Materials<Model> m;
    m.set_default({{2000, 0, 1}, {0.4, 1000, 0, 0}, {}, {0.07, 1e-12, told}});
    check_refused([&] { m.find_range(1e-3); }, "range that a cohesion law tells");
  }
}

TEST_CASE("a body that cannot be integrated is refused") {
  dem::Body b;
  b.name = "rod";
  CHECK_NOTHROW(dem::check_body(b));
  b.mass = 0.0;
  check_refused([&] { dem::check_body(b); }, "mass of body 'rod' is 0 kg", "fixed = true");
  b.fixed = true;
  CHECK_NOTHROW(dem::check_body(b));  // a fixed body needs no mass
  b.fixed = false;
  b.mass = 1.0;
  b.inertia = {1.0, 1.0, -1.0};
  check_refused([&] { dem::check_body(b); }, "principal inertia of body 'rod' is -1");
  b.inertia = {1.0, 1.0, 2.5};
  check_refused([&] { dem::check_body(b); }, "1, 1, 2.5", "no mass distribution", "sum of the other two");
}

TEST_CASE("a force off the centre of mass turns the body") {
  dem::Body b;
  b.motion.position = {1, 2, 3};
  b.apply({0, 0, 2}, {1.5, 2, 3});
  b.apply_torque({0.25, 0, 0});
  CHECK(to_eigen(b.force) == dem::Vec3(0, 0, 2));
  CHECK(to_eigen(b.torque) == dem::Vec3(0.25, -1, 0));
}

TEST_CASE("points of a body move with it") {
  dem::Body b;
  const dem::Mat3 turn = Eigen::AngleAxisd(M_PI / 2, dem::Vec3::UnitZ()).toRotationMatrix();
  b.motion = {{1, 0, 0}, {0, 3, 0}, {0, 0, 2}, dem::from_eigen(turn)};
  CHECK((b.point({1, 0, 0}) - dem::Vec3(1, 1, 0)).norm() < 1e-15);
  CHECK((b.point_velocity({1, 0, 0}) - dem::Vec3(-2, 3, 0)).norm() < 1e-15);
  b.motion.angular_velocity = {2, 0, 0};  // body axes: global y
  CHECK((b.angular_velocity() - dem::Vec3(0, 2, 0)).norm() < 1e-15);
}

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/geometry/sphere/sphere.hpp>
#include <dem/grain/contact_evaluator.hpp>
#include <dem/integrator/velocity_verlet.hpp>
#include <dem/law/friction/none.hpp>
#include <dem/law/normal/hysteretic.hpp>
#include <dem/parallel/serial.hpp>
#include <dem/world/world.hpp>

#include "catch.hpp"

using namespace dem;
using namespace dem::grain;

namespace {

/// Slips (along x, m) of three contacts after a step in which nothing moves: a new point of pair 0, whose old points
/// had slipped by 1 and 3 micrometres; the old point of pair 1, 8 micrometres; a point of pair 2, which did not touch
/// before.
template <class Shape>
std::array<double, 3> slips() {
  const std::vector<ContactParameters<Model>> table = {{{1000.0, 0.0, 1.0}, {0.5, 1000.0, 0.0, 1.0}, {}, {}}};
  HistoriesOfSteps<history_size<Model>> histories;
  histories.last.reserve(16);
  histories.last.count = 3;
  histories.last.key = {5, 9, PairKey::make(1, 2).value};
  histories.last.history[0] = {1e-6, 3e-6, 8e-6};
  const std::vector<Hit> hits = {
      {7, 0, 1, 0}, {PairKey::make(1, 2).value, 0, 2, 0}, {PairKey::make(2, 1).value, 0, 3, 0}};
  // Pressed by 1 mm: 1 N, so that 0.5 N limits springs of at most 8e-3 N.
  const contact::ContactPoint<double> point = {{0, 0, 1}, 1e-3, {0, 0, 1e-3}, 1e-3, 1.0};
  const PartnerView still = {{0, 0, 0}, 1e-3, {0, 0, 0}, 1.0, {0, 0, 0}};
  ContactForces forces;
  ContactEvaluator<Model, contact::ContactPoint, Shape> evaluator(table, 1e-6);
  const auto view = [&](std::size_t) -> const PartnerView& { return still; };
  evaluator.run(
      hits, histories, forces, [&](std::size_t) { return point; }, view, view);
  const auto& now = histories.now.history[0];
  return {now[0], now[1], now[2]};
}

/// Hysteretic as a law that says nothing of patches.
struct Forgetful {
  template <class T>
  using Parameters = contact::Hysteretic::Parameters<T>;
  template <class T>
  using History = contact::Hysteretic::History<T>;
  template <class T>
  static T force(const Parameters<T>& p, const contact::NormalState<T>& s, History<T>& h) {
    return contact::Hysteretic::force(p, s, h);
  }
  static double stiffness(const Parameters<double>& p, const contact::NormalState<double>&) {
    return p.unloading_stiffness;
  }
  static void check(const Parameters<double>&) {}
};

template <class Law>
struct PressedCubes : Model {
  using Shape = shape::Polyhedron;
  using Normal = Law;
  using Friction = friction::None;
  using Integrator = integrator::VelocityVerlet;
  using Executor = exec::Serial;
};

/// A cube is pressed flat on another by 10 micrometres, drawn back by 2, and slid over its edges, at rest at each
/// place. Returns the least and the largest force on the way over what the law gives there, k1 d - (k2 - k1)(D - d).
template <class Law>
std::array<double, 2> slide_over_edge() {
  WorldOptions options;
  options.gravity = {0, 0, 0};
  options.time_step = 1e-10;
  World<PressedCubes<Law>> w(options);
  const double k1 = 1e4, k2 = 2e4, half = 1e-3;
  w.set_contact({{k1, k2}, {}});
  NewGrain n;
  n.species = w.add_species(shape::cube(half));
  const GrainId lower = w.add_grain(n);
  n.position = {0, 0, 2 * half};
  n.rotation = Eigen::AngleAxisd(0.3, Vec3::UnitZ()).toRotationMatrix();  // edges cross edges
  const GrainId upper = w.add_grain(n);
  const auto force = [&](double x, double overlap) {
    w.set_position(lower, {0, 0, 0});
    w.set_position(upper, {x, 0.2 * half, 2 * half - overlap});
    for (const GrainId p : {lower, upper}) {
      w.set_velocity(p, {0, 0, 0});
      w.set_angular_velocity(p, {0, 0, 0});
    }
    REQUIRE(w.step());
    return w.force(upper).z();
  };
  for (const double overlap : {4e-6, 1e-5, 8e-6}) force(0.0, overlap);
  const double expected = k1 * 8e-6 - (k2 - k1) * 2e-6;
  double least = 1e300, largest = 0.0;
  for (int k = 0; k <= 60; ++k) {
    const double f = force(k / 40.0 * half, 8e-6) / expected;
    least = std::min(least, f);
    largest = std::max(largest, f);
  }
  return {least, largest};
}

}  // namespace

TEST_CASE("a new point of a patch remembers the mean of the others, a new contact of any other shape nothing") {
  using Catch::Approx;
  const auto patch = slips<shape::Polyhedron>(), single = slips<shape::Sphere>();
  CHECK(patch[0] == Approx(2e-6).epsilon(1e-14));
  CHECK(single[0] == 0.0);
  for (const auto& s : {patch, single}) {
    CHECK(s[1] == Approx(8e-6).epsilon(1e-14));
    CHECK(s[2] == 0.0);
  }
}

TEST_CASE("a cube that slides over another's edge keeps its imprint while the patch renames its points") {
  // A face on a face has the whole stiffness all the way. In 60 steps of 1e-10 s the torque turns the cubes by 6e-13
  // rad: 1e-15 m of 8e-6 m at the corners.
  const auto [least, largest] = slide_over_edge<contact::Hysteretic>();
  CHECK(std::abs(least - 1.0) < 1e-9);
  CHECK(std::abs(largest - 1.0) < 1e-9);
  // A law that does not say how goes back to the loading line, k1 d, with every point that is new.
  CHECK(slide_over_edge<Forgetful>()[1] > 1.1);
}

#include "world/scenes.hpp"

#include <dem/law/friction/none.hpp>
#include <dem/parallel/openmp.hpp>

using Catch::Approx;
using namespace dem;

namespace {

/// A few balls fall on a plate: how far, and that they stay above it.
template <class Model>
void run_a_few(const ContactParameters<Model>& parameters) {
  World<Model> w(options({0, 0, -9.81}, 1e-5));
  w.set_contact(parameters);
  const auto ball = w.add_species(shape::Sphere(1e-3));
  w.add_surface(w.ground(), surface::Plane{});
  add_block(w, ball, {0, 0, 1.2e-3}, 2.1e-3, 3, 3, 2, 0.01);
  REQUIRE(w.run(1000));
  CHECK(w.time() == Approx(0.01));
  // The lower ones fell 0.2 mm; none may be in the ground or each other, none may have jumped.
  for_each_grain(w, [&](GrainId p) {
    CHECK(w.position(p).z() > 0.95e-3);
    CHECK(w.position(p).z() < 3.5e-3);
    CHECK(w.velocity(p).norm() < 0.2);
    CHECK(not_a_rotation(w.rotation(p)) < 1e-12);
  });
  CHECK(w.velocity(GrainId(0)).norm() > 0.0);
}

}  // namespace

// Each integrator with each broad phase and each executor, and each of these with each other: six of the twelve do.
using Pairwise = std::tuple<models::CorrectedBalls,
                            Grains<Sphere, integrator::PredictorCorrector, broadphase::AllPairs, exec::Serial>,
                            Grains<Sphere, integrator::VelocityVerlet, broadphase::UniformGrid, exec::Serial>,
                            Grains<Sphere, integrator::VelocityVerlet, broadphase::AllPairs, exec::OpenMP>,
                            Grains<Sphere, integrator::SymplecticEuler, broadphase::UniformGrid, exec::OpenMP>,
                            Grains<Sphere, integrator::SymplecticEuler, broadphase::AllPairs, exec::Serial>>;

TEMPLATE_LIST_TEST_CASE("every choice of integrator, broad phase and executor runs", "", Pairwise) {
  run_a_few<TestType>(sand<TestType>());
}

TEST_CASE("a model without friction runs") {
  struct Smooth : dem::Model {
    using Friction = friction::None;
  };
  run_a_few<Smooth>({{2000.0, 0.015, 0.05}, {}});
}

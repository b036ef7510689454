#pragma once

// Worlds whose grains are moved by the kernels of GPUs, on this processor. The ordinary step runs on such a world as
// well, so both can start from the same state, to the bit.

#include "world/scenes.hpp"

#include <dem/flat/flat.hpp>
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/law/rolling/elastic_plastic.hpp>

namespace flat_scenes {

using Uniform = dem::broadphase::UniformGrid;

/// One force evaluation a step, after a prediction; friction remembers.
struct Balls : Grains<Sphere, dem::integrator::VelocityVerlet, Uniform, dem::exec::Flat> {
  static Sphere shape(double size) { return Sphere(size); }
  static dem::ContactParameters<Balls> contact() { return sand<Balls>(); }
};
/// Two evaluations a step.
struct Cubes : Grains<Cube8, dem::integrator::PredictorCorrector, Uniform, dem::exec::Flat> {
  static Cube8 shape(double size) { return dem::shape::cube8(size); }
  static dem::ContactParameters<Cubes> contact() { return sand<Cubes>(); }
};
/// Bridges act at a distance and remember, and so does rolling resistance.
struct WetBalls : models::Laws<models::Linear, dem::friction::CundallStrack, dem::rolling::ElasticPlastic,
                               dem::cohesion::LiquidBridge> {
  using Integrator = dem::integrator::SymplecticEuler;
  using Executor = dem::exec::Flat;
  static Sphere shape(double size) { return Sphere(size); }
  static dem::ContactParameters<WetBalls> contact() {
    return {models::Linear::with_restitution(2000.0, 0.4),
            {0.4, 600.0, 0.3},
            {0.1, 600.0, 0.3},
            dem::cohesion::LiquidBridge::of(0.072, 0.0, 2e-12)};
  }
};

/// Under ten times the usual gravity, as it settles sooner: an open box of planes with a roller and a knob on its
/// floor, two kinds of grains that fall in, and a plate that falls on them. `skin` in m, 0: chosen.
template <class Model>
dem::World<Model> scene(double skin = 0.0, int threads = 1) {
  dem::WorldOptions o = options({4, 2, -98}, 8e-6, skin);
  o.threads = threads;
  dem::World<Model> w(o);
  auto softer = Model::contact();
  softer.friction.coefficient = 0.2;
  w.set_contact(Model::contact());
  w.set_contact("grain", "steel", softer);
  add_open_box(w, {0.016, 0.016, 1});
  w.add_surface(w.ground(), dem::surface::Cylinder(2e-3, 8e-3),
                {.material = "steel",
                 .position = {0.008, 0.008, 1e-3},
                 .rotation = dem::rotation_between(Vec3::UnitZ(), Vec3::UnitY())});
  w.add_surface(w.ground(), dem::surface::Sphere(1.5e-3), {.position = {0.003, 0.013, 0}});
  const auto plate =
      w.machine().add_body(dem::mbd::given_body("plate", 5e-3, Vec3(2e-7, 2e-7, 3e-7)).at({0.008, 0.008, 0.0262}));
  w.add_surface(plate, dem::surface::Box({0.012, 0.012, 1e-3}), {.material = "steel"});
  add_block(w, w.add_species(Model::shape(0.8e-3)), {2e-3, 2e-3, 4.6e-3}, 2.75e-3, 5, 5, 4, 0.2);
  add_block(w, w.add_species(Model::shape(1e-3)), {2e-3, 2e-3, 15.6e-3}, 2.75e-3, 5, 5, 4, 0.2, 2);
  add_block(w, SpeciesId(0), {2e-3, 2e-3, 29e-3}, 2.75e-3, 5, 5, 4, 0.2, 3);  // onto the plate: two chunks in all
  return w;
}

}  // namespace flat_scenes

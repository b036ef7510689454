#include "soil.hpp"

#include <dem/dem.hpp>

struct Sand : dem::Model {
  using Integrator = dem::integrator::VelocityVerlet;
};
struct Soil::Hidden {
  dem::World<Sand> world{{.threads = 1}};
  dem::SurfaceId floor = world.add_surface(world.ground(), dem::surface::Plane{});
  dem::SpeciesId ball = world.add_species(dem::shape::Sphere{1e-3});
};
Soil::Soil(double friction) : hidden_(std::make_unique<Hidden>()) {
  hidden_->world.set_contact(
      {.normal = {.stiffness = 2000, .damping = 0.05, .separation_factor = 1},
       .friction = {.coefficient = friction, .stiffness = 2000, .velocity_stiffness = 0.01, .breaking_factor = 0.975}});
}
Soil::~Soil() = default;
void Soil::add_grain(double x, double y, double z) { hidden_->world.add_grain({hidden_->ball, {x, y, z}}); }
std::string Soil::run_for(double seconds) { return hidden_->world.run_for(seconds).text; }
double Soil::weight_on_floor() const { return -hidden_->world.surface_force(hidden_->floor).z(); }

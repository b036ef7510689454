// expect: Integrator: needs .static constexpr int stages., the force evaluations per step
#include <dem/world/model.hpp>

struct Still {};
struct Grain : dem::Model {
  using Integrator = Still;
};

int main() { dem::integrator::check_integrator<Grain::Integrator>(); }

// expect: Integrator: needs static initialise<T>\(Memory<T>&, const Acceleration<T>&\), before_forces<T>
#include <dem/integrator/symplectic_euler.hpp>

struct Still : dem::integrator::SymplecticEuler {
  void after_forces() = delete;
};

int main() { dem::integrator::check_integrator<Still>(); }

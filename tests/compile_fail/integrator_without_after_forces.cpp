// expect: Integrator: needs static initialise<T>\(Memory<T>&, const Acceleration<T>&\), before_forces<T>
#include <dem/integrator/motion.hpp>

struct Still {
  static constexpr int stages = 1;
  static constexpr bool predicts_before_forces = false;
  static constexpr double stability_limit = 2.0;
  template <class T>
  struct Memory {};
};

int main() { dem::integrator::check_integrator<Still>(); }

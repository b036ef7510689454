// expect: CohesionLaw: needs static stiffness\(const Parameters<double>&, const NormalState<double>&\) in N/m and check
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};
  template <class T>
  static dem::cohesion::Attraction<T> force(const Parameters<T>&, const dem::cohesion::NormalState<T>&, History<T>&) {
    return {T(0), T(0)};
  }
  static double stiffness(const Parameters<double>&, const dem::cohesion::NormalState<double>&) { return 0.0; }
};
struct Grain : dem::Model {
  using Cohesion = Law;
};

int main() { dem::check_model<Grain>(); }

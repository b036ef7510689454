// expect: FrictionLaw: needs static stiffness\(const Parameters<double>&\) in N/m, check\(const Parameters<double>&\) and carry
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};
  template <class T>
  static dem::Vector3<T> force(const Parameters<T>&, const dem::friction::TangentialState<T>&, History<T>&) {
    return {T(0), T(0), T(0)};
  }
  static double stiffness(const Parameters<double>&) { return 0.0; }
  static void check(const Parameters<double>&) {}
};
struct Grain : dem::Model {
  using Friction = Law;
};

int main() { dem::check_model<Grain>(); }

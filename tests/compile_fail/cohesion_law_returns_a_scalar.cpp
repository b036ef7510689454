// expect: CohesionLaw: needs .template <class T> static Attraction<T> force.* that returns pull and grip
#include <dem/world/model.hpp>

struct Law : dem::cohesion::None {
  template <class T>
  static T force(const Parameters<T>&, const dem::cohesion::NormalState<T>&, History<T>&) {
    return T(0);
  }
};
struct Grain : dem::Model {
  using Cohesion = Law;
};

int main() { dem::check_model<Grain>(); }

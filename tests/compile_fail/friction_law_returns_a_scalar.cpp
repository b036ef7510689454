// expect: FrictionLaw: needs .template <class T> static Vector3<T> force
#include <dem/law/friction/none.hpp>
#include <dem/world/model.hpp>

struct Law : dem::friction::None {
  template <class T>
  static T force(const Parameters<T>&, const dem::friction::TangentialState<T>&, History<T>&) {
    return T(0);
  }
};
struct Grain : dem::Model {
  using Friction = Law;
};

int main() { dem::check_model<Grain>(); }

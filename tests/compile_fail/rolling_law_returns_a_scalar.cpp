// expect: RollingLaw: needs .template <class T> static Vector3<T> torque
#include <dem/world/model.hpp>

struct Law : dem::rolling::None {
  template <class T>
  static T torque(const Parameters<T>&, const dem::rolling::RollingState<T>&, History<T>&) {
    return T(0);
  }
};
struct Grain : dem::Model {
  using Rolling = Law;
};

int main() { dem::check_model<Grain>(); }

// expect: RollingLaw: needs static stiffness\(const Parameters<double>&, const contact::NormalState<double>&\) in N m
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {};
  template <class T>
  struct History {};
  template <class T>
  static dem::Vector3<T> torque(const Parameters<T>&, const dem::rolling::RollingState<T>&, History<T>&) {
    return {T(0), T(0), T(0)};
  }
  template <class T, class Turn>
  static void carry(History<T>&, Turn&&) {}
  static void check(const Parameters<double>&) {}
};
struct Grain : dem::Model {
  using Rolling = Law;
};

int main() { dem::check_model<Grain>(); }

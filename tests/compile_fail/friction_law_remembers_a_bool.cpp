// expect: FrictionLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {
    T coefficient;
  };
  template <class T>
  struct History {
    T slip;
    bool slides, sticks, rolls;  // as large as one of the sizes by which members are told
  };
  template <class T>
  static dem::Vector3<T> force(const Parameters<T>&, const dem::contact::TangentialState<T>&, History<T>&) {
    return {};
  }
  template <class T, class Turn>
  static void carry(History<T>&, Turn&&) {}
  static double stiffness(const Parameters<double>&) { return 0.0; }
  static void check(const Parameters<double>&) {}
};
struct Grain : dem::Model {
  using Friction = Law;
};

int main() { dem::check_model<Grain>(); }

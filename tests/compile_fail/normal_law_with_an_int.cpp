// expect: NormalLaw: Parameters<T> and History<T> hold nothing but Ts; write T for a bool, an int or a double
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {
    T stiffness;
    int exponent;
  };
  template <class T>
  struct History {};
  template <class T>
  static T force(const Parameters<T>& p, const dem::contact::NormalState<T>& s, History<T>&) {
    return p.stiffness * s.overlap;
  }
  static double stiffness(const Parameters<double>& p, const dem::contact::NormalState<double>&) {
    return p.stiffness;
  }
  static void check(const Parameters<double>&) {}
};
struct Grain : dem::Model {
  using Normal = Law;
};

int main() { dem::check_model<Grain>(); }

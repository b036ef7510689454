// expect: NormalLaw: needs static stiffness\(const Parameters<double>&, const NormalState<double>&\) in N/m
#include <dem/world/model.hpp>

struct Law {
  template <class T>
  struct Parameters {
    T stiffness;
  };
  template <class T>
  struct History {};
  template <class T>
  static T force(const Parameters<T>& p, const dem::contact::NormalState<T>& s, History<T>&) {
    return p.stiffness * s.overlap;
  }
};
struct Grain : dem::Model {
  using Normal = Law;
};

int main() { dem::check_model<Grain>(); }

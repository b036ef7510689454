// expect: NormalLaw: needs .template <class T> static T force\(const Parameters<T>&, const NormalState<T>&, History<T>&\).
#include <dem/dem.hpp>

struct Law : dem::contact::Penalty {
  template <class T>
  static void force(const Parameters<T>&, const dem::contact::NormalState<T>&, History<T>&) {}
};
struct Grain : dem::Model {
  using Normal = Law;
};

int main() { dem::World<Grain> world; }

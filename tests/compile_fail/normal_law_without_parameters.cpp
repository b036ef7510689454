// expect: NormalLaw: needs .template <class T> struct Parameters., the constants of a pair of materials
#include <dem/world/model.hpp>

struct Law {};
struct Grain : dem::Model {
  using Normal = Law;
};

int main() { dem::check_model<Grain>(); }

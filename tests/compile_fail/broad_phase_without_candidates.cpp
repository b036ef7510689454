// expect: BroadPhase: needs finder\(\) const with for_each_candidate\(i, f\), which calls f\(j\) for each j > i
#include <dem/world/model.hpp>

struct Nothing {
  void build(const dem::broadphase::Positions&, double) {}
};
struct Grain : dem::Model {
  using BroadPhase = Nothing;
};

int main() { dem::check_model<Grain>(); }

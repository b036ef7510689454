// expect: BroadPhase: needs finder\(\) const with for_each_candidate\(i, f\), which calls f\(j\) for each j > i
#include <dem/grain/broadphase/all_pairs.hpp>
#include <dem/world/model.hpp>

struct Nothing : dem::broadphase::AllPairs {
  void finder() const = delete;
};
struct Grain : dem::Model {
  using BroadPhase = Nothing;
};

int main() { dem::check_model<Grain>(); }

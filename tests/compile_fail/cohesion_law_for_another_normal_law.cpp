// expect: CohesionLaw: this one is made for one normal law
#include <dem/law/cohesion/jkr.hpp>
#include <dem/world/model.hpp>

struct Grain : dem::Model {  // with the default normal law, Penalty
  using Cohesion = dem::cohesion::JKR;
};

int main() { dem::check_model<Grain>(); }

// expect: friction::Varying: the law that it wraps needs a parameter 'coefficient'
#include <dem/law/friction/none.hpp>
#include <dem/law/friction/varying.hpp>
#include <dem/world/model.hpp>

struct Grain : dem::Model {
  using Friction = dem::friction::Varying<dem::friction::None>;
};

int main() { dem::check_model<Grain>(); }

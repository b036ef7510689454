// expect: one that has exec::Flat <dem/flat/flat.hpp>
#include <dem/parallel/flat.hpp>
#include <dem/world/world.hpp>

struct Sand : dem::Model {
  using Executor = dem::exec::Flat;
};

int main() {
  dem::World<Sand> world;
  (void)world.run(1);
}

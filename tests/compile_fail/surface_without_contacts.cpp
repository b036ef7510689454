// expect: Surface: needs near\(point, radius\), for doubles .bool. and packs .PackMask., and contacts\(point, radius, callback\)
#include <dem/world/model.hpp>

struct Veil {
  dem::surface::Aabb bounds() const { return {}; }
};
struct Grain : dem::Model {
  using Surfaces = std::variant<Veil>;
};

int main() { dem::check_model<Grain>(); }

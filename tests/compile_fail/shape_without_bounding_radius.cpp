// expect: Shape: needs bounding_radius\(\) in m, volume\(\) in m.3 and unit_inertia\(\)
#include <dem/world/model.hpp>

struct Blob : dem::shape::Sphere {
  using Sphere::Sphere;
  void bounding_radius() const = delete;
};
struct Grain : dem::Model {
  using Shape = Blob;
};

int main() { dem::check_model<Grain>(); }

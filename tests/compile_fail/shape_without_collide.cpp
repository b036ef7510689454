// expect: Shape: needs orient\(R, pose\), static collide\(a, pose_a, b, pose_b, separation, sink\)
#include <dem/world/model.hpp>

struct Blob {
  static constexpr int pose_size = 0;
  template <class T>
  using PairTouch = dem::contact::SphereTouch<T>;
  double bounding_radius() const { return 1.0; }
  double volume() const { return 1.0; }
  dem::Vec3 unit_inertia() const { return dem::Vec3::Ones(); }
};
struct Grain : dem::Model {
  using Shape = Blob;
};

int main() { dem::check_model<Grain>(); }

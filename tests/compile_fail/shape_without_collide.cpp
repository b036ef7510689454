// expect: Shape: needs orient\(R, pose\), static collide\(a, pose_a, b, pose_b, separation, callback\)
#include <dem/world/model.hpp>

struct Blob : dem::shape::Sphere {
  using Sphere::Sphere;
  void collide() = delete;
};
struct Grain : dem::Model {
  using Shape = Blob;
};

int main() { dem::check_model<Grain>(); }

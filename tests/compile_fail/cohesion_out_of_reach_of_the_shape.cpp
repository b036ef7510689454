// expect: Shape: the model's cohesion acts at a distance, so collide .* must take a gap
#include <dem/law/cohesion/liquid_bridge.hpp>
#include <dem/world/model.hpp>

struct Short : dem::shape::Sphere {
  using dem::shape::Sphere::Sphere;
  static std::uint64_t contact_bits(const Short& a, const double* pa, const Short& b, const double* pb,
                                    const dem::Vector3<double>& separation) {
    return dem::shape::Sphere::contact_bits(a, pa, b, pb, separation);
  }
};
struct Grain : dem::Model {
  using Shape = Short;
  using Cohesion = dem::cohesion::LiquidBridge;
};

int main() { dem::check_model<Grain>(); }

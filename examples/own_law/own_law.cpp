// A normal law and a friction law of one's own: a spring that stiffens, and friction that weakens with the distance
// slipped, as that of faults does. A stool of four balls on a slope holds up to the static angle; once it slides, less
// than that holds it.

#include <dem/dem.hpp>

#include <array>

struct StiffeningSpring {  // F = K d (1 + (d/depth)^2) + C d', never pulling
  template <class T>
  struct Parameters {
    T stiffness, depth, damping;
  };
  template <class T>
  struct History {};

  template <class T>
  static DEM_HOT T force(const Parameters<T>& p, const dem::contact::NormalState<T>& s, History<T>&) {
    const T x = s.overlap / p.depth;
    return dem::max(T(0), p.stiffness * s.overlap * (T(1) + x * x) + p.damping * s.approach_speed);
  }
  static double stiffness(const Parameters<double>& p, const dem::contact::NormalState<double>& s) {
    const double x = s.overlap / p.depth;
    return p.stiffness * (1 + 3 * x * x);
  }
  static void check(const Parameters<double>& p) { dem::require_positive(p.stiffness, "normal stiffness", "N/m"); }
};

struct SlipWeakening {  // a spring that slips at mu Fn, mu falling from `coefficient` to `residual` over `distance`
  template <class T>
  struct Parameters {
    T coefficient, residual, distance, stiffness, damping;
  };
  template <class T>
  struct History {
    dem::Vector3<T> spring;
    T slipped;
  };

  template <class T>
  static DEM_HOT dem::Vector3<T> force(const Parameters<T>& p, const dem::contact::TangentialState<T>& s,
                                       History<T>& h) {
    const T mu = p.coefficient - (p.coefficient - p.residual) * dem::min(T(1), h.slipped / p.distance);
    dem::Vector3<T> spring = p.stiffness * (h.spring + s.time_step * s.velocity);
    const T trial = norm(spring);
    const dem::Vector3<T> f = dem::friction::slide(spring, p.damping, s.velocity, mu * s.normal_force);
    h.slipped += (trial - norm(spring)) / p.stiffness;
    h.spring = T(1) / p.stiffness * spring;
    return -f;
  }
  template <class T, class Turn>
  static DEM_HOT void carry(History<T>& h, Turn&& turn) {  // vectors turn with the contact
    h.spring = turn(h.spring);
  }
  static double stiffness(const Parameters<double>& p) { return p.stiffness; }
  static void check(const Parameters<double>& p) {
    dem::require_within(p.residual, 0.0, p.coefficient, "residual friction");
  }
};

struct Rock : dem::Model {
  using Shape = dem::shape::SphereCluster<4>;
  using Normal = StiffeningSpring;
  using Friction = SlipWeakening;
  using Integrator = dem::integrator::VelocityVerlet;
};

int main() {
  const double g = 9.81, mu = 0.6, residual = 0.3, r = 1e-3;
  dem::World<Rock> world({.gravity = {0, 0, -g}, .overlap_limit = 0.01, .threads = 1});
  world.set_contact({.normal = {2000, 1e-5, 0.05}, .friction = {mu, residual, 1e-6, 2000, 0.05}});
  const std::array<dem::Ball, 4> feet = {
      {{{3 * r, 3 * r, 0}, r}, {{-3 * r, 3 * r, 0}, r}, {{3 * r, -3 * r, 0}, r}, {{-3 * r, -3 * r, 0}, r}}};
  const auto stool = world.add_species(dem::shape::SphereCluster<4>(feet));
  world.add_surface(world.ground(), dem::surface::Plane{});
  const auto block = world.add_particle({stool, {0, 0, r}});

  const double degree = M_PI / 180, step = 0.1 * degree;
  double angle = 0;
  for (; world.velocity(block).norm() < 1e-4 && angle < 45 * degree; angle += step) {
    world.set_gravity({g * std::sin(angle), 0, -g * std::cos(angle)});
    if (const auto report = world.run(500); !report) return fmt::print("{}\n", report.text), 1;
  }
  angle -= step;
  fmt::print("lets go at {:.1f} deg, atan(mu) = {:.1f} deg\n", angle / degree, std::atan(mu) / degree);

  if (const auto report = world.run_for(0.02); !report) return fmt::print("{}\n", report.text), 1;
  const double before = world.velocity(block).x(), start = world.time();
  if (const auto report = world.run_for(0.05); !report) return fmt::print("{}\n", report.text), 1;
  const double slides = (world.velocity(block).x() - before) / (world.time() - start);
  fmt::print("slides with {:.3f} m/s^2, {:.3f} of g (sin - residual cos)\n", slides,
             slides / (g * (std::sin(angle) - residual * std::cos(angle))));
}

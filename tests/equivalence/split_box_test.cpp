#include "world/scenes.hpp"

using Catch::Approx;

namespace {

/// A box of two halves whose walls are solid boxes, as those of a direct shear rig: the bottom half stands, the top
/// half can slide. Inside it is `width` wide both ways; the floor is z = 0, x = y = 0 its middle.
struct SplitBox {
  static constexpr double half_edge = 1e-3, width = 0.014, thickness = 6e-3, seam = 4e-3, height = 0.024;
  dem::World<Cubes> world;
  dem::BodyId top;
  std::vector<SurfaceId> of_bottom, of_top;

  SplitBox()
      : world([] {
          dem::WorldOptions o = options({0, 0, -g});
          const double half = 0.5 * width + thickness;
          o.domain = {Vec3(-half, -half, -thickness), Vec3(half, half, 2 * height)};
          return o;
        }()) {
    // Walls without friction: the weight goes down to the floor and the ledges, and nowhere else.
    world.set_contact({{500.0, 0.05, 1.0}, {0.4, 500.0, 0.02, 0.975}});
    world.set_contact("grain", "wall", {{500.0, 0.05, 1.0}, {0.0, 0.0, 0.0, 0.0}});
    const double outer = width + 2 * thickness;
    of_bottom = walls(world.ground(), 0.0, seam);
    of_bottom.push_back(world.add_surface(world.ground(), dem::surface::Box({outer, outer, thickness}),
                                          {.position = {0, 0, -0.5 * thickness}}));
    top = world.machine().add_fixed_body("top half");
    of_top = walls(top, seam, height);
    add_block(world, world.add_species(dem::shape::cube8(half_edge)), {-5.5e-3, -5.5e-3, 1.5e-3}, 2.75e-3, 5, 5, 8,
              0.1);
  }
  std::vector<SurfaceId> walls(dem::BodyId body, double low, double high) {
    std::vector<SurfaceId> result;
    const double middle = 0.5 * (width + thickness), outer = width + 2 * thickness;
    for (const double side : {-1.0, 1.0}) {
      result.push_back(world.add_surface(body, dem::surface::Box({thickness, outer, high - low}),
                                         {.position = {side * middle, 0, 0.5 * (low + high)}}));
      result.push_back(world.add_surface(body, dem::surface::Box({width, thickness, high - low}),
                                         {.position = {0, side * middle, 0.5 * (low + high)}}));
    }
    return result;
  }
  double upwards_on(const std::vector<SurfaceId>& surfaces) const {
    double sum = 0.0;
    for (const SurfaceId s : surfaces) sum += world.surface_force(s).z();
    return sum;
  }
};

}  // namespace

TEST_CASE("a box whose halves slide apart holds its grains") {
  // Along the diagonal, so that two walls become ledges, and the corner between them: by 0.9 of their thickness.
  SplitBox box;
  auto& w = box.world;
  const double way = 0.9 * box.thickness, time = 0.1;
  const auto slide = dem::mbd::Signal::function([=](double t) {
    const double x = std::min(t / time, 1.0);
    return way * x * x * (3.0 - 2.0 * x);
  });
  w.machine().add_motion(dem::mbd::prescribed_position("along x", box.top, Vec3::UnitX(), slide));
  w.machine().add_motion(dem::mbd::prescribed_position("along y", box.top, Vec3::UnitY(), slide));
  const auto report = w.run_for(0.3);  // a grain outside the walls would be reported as lost
  INFO(report.text);
  REQUIRE(report);
  CHECK(w.grain_count() == 200);

  const double edge = 0.5 * box.width, weight = total_mass(w) * g;
  int on_x = 0, on_y = 0;
  for_each_grain(w, [&](GrainId p) {
    const Vec3 x = w.position(p);
    const bool above = x.z() > box.seam;
    // Centres stay within the opening of their half, and grains on the ledges lie on them.
    for (int k = 0; k < 2; ++k) {
      CHECK(x[k] > -edge + (above ? way : 0.0));
      CHECK(x[k] < edge + (above ? way : 0.0));
    }
    CHECK(x.z() > 0.5 * box.half_edge);
    on_x += above && x.x() > edge;
    on_y += above && x.y() > edge;
  });
  CHECK(on_x > 10);
  CHECK(on_y > 10);

  // What the parts carry is the weight less the rate of the momentum, to rounding. Smooth walls take nothing of it, so
  // it is all on the floor and the ledges, but for what the grains still shift (less than a hundredth in the mean of 20
  // ms), and what the undersides of the top half push down on the grains that they cover and wedge in.
  const double before = momentum(w).z();
  double on_bottom = 0.0, on_top = 0.0;
  const int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    REQUIRE(w.step());
    on_bottom += box.upwards_on(box.of_bottom) / steps;
    on_top += box.upwards_on(box.of_top) / steps;
  }
  const double rate = (momentum(w).z() - before) / (steps * w.time_step());
  CHECK(on_bottom + on_top + weight == Approx(-rate).margin(1e-9 * weight));
  CHECK(std::abs(rate) < 0.01 * weight);
  CHECK(on_top >= 0.0);
  CHECK(on_top < 0.05 * weight);
}

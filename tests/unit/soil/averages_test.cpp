#include "io/vtk_reader.hpp"
#include "world/scenes.hpp"

#include <dem/soil/averages.hpp>
#include <dem/soil/averages_file.hpp>
#include <dem/world/query.hpp>

#include "core/error_of.hpp"

#include <filesystem>

using Catch::Approx;
using dem::soil::Average;
using dem::soil::average_in;
using dem::soil::average_slices;
using dem::soil::AverageGrid;
using dem::soil::Averages;
using dem::soil::averages;
using dem::soil::Kernel;
using dem::surface::Aabb;

namespace {

constexpr double radius = 1e-3, stiffness = 2000.0;

/// Balls in motion that press each other: a dense block with random velocities.
dem::World<Balls> moving_block(int n, double gravity = 0.0) {
  dem::World<Balls> w(options({0, 0, -gravity}, 1e-6));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(radius));
  w.add_species(Sphere(0.9 * radius), {.density = 4000});
  Random random(3);
  for (int k = 0; k < n * n * n; ++k) {
    const Vec3 cell(k % n, k / n % n, k / (n * n));
    w.add_grain({.species = SpeciesId(static_cast<std::size_t>(k) % 2),
                 .position = 1.9e-3 * cell + random.vector(5e-5),
                 .velocity = Vec3(0.3, -0.1, 0.2) + random.vector(0.2)});
  }
  return w;
}

}  // namespace

TEST_CASE("kernels are whole, and their means along lines are what sums give") {
  for (const Kernel& kernel : {Kernel::lucy(1.0), Kernel::gaussian(0.4)}) {
    // The integral of 4 pi r^2 w(r), by the middle of 20,000 steps.
    double whole = 0.0;
    const double step = kernel.reach() / 20000;
    for (int k = 0; k < 20000; ++k) {
      const double r = (k + 0.5) * step;
      whole += 4 * M_PI * r * r * kernel.at(r * r) * step;
    }
    CHECK(whole == Approx(1.0).epsilon(1e-7));
    CHECK(kernel.at(1.001 * kernel.reach() * kernel.reach()) == 0.0);

    Random random(1);
    for (int n = 0; n < 200; ++n) {
      const Vec3 a = random.vector(1.2), b = random.vector(1.2), x = random.vector(0.5);
      double mean = 0.0;
      for (int k = 0; k < 4000; ++k) mean += kernel.at((a + (k + 0.5) / 4000 * (b - a) - x).squaredNorm()) / 4000;
      // Lucy's kernel has a jump in its third derivative in the middle, and the Gaussian one of 1 % of it at its end,
      // which the sum finds to 1/4000 of the line.
      CHECK(kernel.along(a, b, x) == Approx(mean).margin(2e-5 * kernel.at(0.0)));
    }
  }
}

TEST_CASE("the averages of a compressed lattice are those of its cell") {
  // A lattice with other spacings along x, y and z: stress along x = force of a contact by the area of a cell's side.
  const Vec3 pitch(1.96e-3, 1.98e-3, 1.99e-3);
  const int n = 8;
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(radius));
  for (int k = 0; k < n * n * n; ++k) {
    w.add_grain({SpeciesId(0), pitch.cwiseProduct(Vec3(k % n, k / n % n, k / (n * n)))});
  }
  const double cell = pitch.prod(), mass = w.species(SpeciesId(0)).mass, volume = 4.0 / 3 * M_PI * std::pow(radius, 3);
  const auto check = [&](const Average& a, double error) {
    CHECK(a.density == Approx(mass / cell).epsilon(error));
    CHECK(a.solid_fraction == Approx(volume / cell).epsilon(error));
    CHECK(a.grains == Approx(1 / cell).epsilon(error));
    CHECK(a.coordination == Approx(6.0).epsilon(error));
    CHECK(a.velocity.norm() == 0.0);
    CHECK(a.kinetic_stress.norm() == 0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const double force = stiffness * (2 * radius - pitch[axis]);
      CHECK(a.stress()(axis, axis) == Approx(force * pitch[axis] / cell).epsilon(error));
      for (int other = 0; other < axis; ++other) {
        CHECK(std::abs(a.stress()(axis, other)) + std::abs(a.stress()(other, axis)) < 1e-12 * a.pressure());
      }
    }
  };
  // A box of whole cells, whose borders run midway between grains; and the same cut into cells.
  const Aabb box = {Vec3(1.5 * pitch), Vec3(5.5 * pitch)};
  check(average_in(w, box), 1e-12);
  for (const Average& a : average_slices(w, box, 1, 4)) check(a, 1e-12);
  for (const Average& a : averages(w, {box, {2, 4, 1}}).values) check(a, 1e-12);
  // Inside of the lattice, Lucy's kernel of a reach of three spacings adds up to 1 with an error that falls with the
  // fourth power of the reach: its transform at the first wave of the lattice, 2 pi 3, is some 1e-3.
  check(averages(w, {box, {1, 1, 1}}, Kernel::lucy(3 * 2e-3)).values[0], 0.01);
}

TEST_CASE("mass and momentum of a field are those of the grains") {
  const auto w = moving_block(6);
  const AverageGrid grid = {{Vec3::Constant(-6e-3), Vec3::Constant(16e-3)}, {22, 20, 25}};
  for (const bool smooth : {false, true}) {
    const Averages field = averages(w, grid, smooth ? Kernel::lucy(4e-3) : Kernel::cell());
    double mass = 0.0, grains = 0.0;
    Vec3 sum = Vec3::Zero();
    for (const Average& a : field.values) {
      mass += a.density * grid.volume();
      grains += a.grains * grid.volume();
      sum += grid.volume() * a.momentum();
    }
    // Cells: to rounding. A smooth kernel is summed at points a quarter of its reach apart: to some 1e-3.
    const double error = smooth ? 2e-3 : 1e-12;
    CHECK(mass == Approx(total_mass(w)).epsilon(error));
    CHECK(grains == Approx(216.0).epsilon(error));
    CHECK((sum - momentum(w)).norm() < error * momentum(w).norm());
  }
}

TEST_CASE("the stress of a list of contacts is that of a box around all of them") {
  auto w = moving_block(6);
  w.add_surface(w.ground(), dem::surface::Plane{}, {.position = {0, 0, -0.9e-3}});
  REQUIRE(w.run(3));
  const Aabb box = {Vec3::Constant(-0.05), Vec3::Constant(0.05)};
  const dem::Mat3 stress = average_in(w, box).contact_stress;
  REQUIRE(stress.norm() > 0.0);
  CHECK((dem::stress_of(contacts_of(w), 1e-3) - stress).norm() < 1e-12 * stress.norm());
  CHECK_THAT(message_of([&] { dem::stress_of(contacts_of(w), 0.0); }), Catch::Matchers::ContainsSubstring("volume"));
}

TEST_CASE("momentum is balanced at every point") {
  // d(density V)/dt = density g - div(stress + density V V), by a step of symplectic Euler, which moves the grains by
  // the very forces that the stress is made of, and by differences between points that are 0.1 mm apart.
  auto w = moving_block(6, g);
  const double h = 1e-4, dt = w.state().options.time_step;
  const Kernel kernel = Kernel::lucy(4e-3);
  for (const Vec3& x : {Vec3(5e-3, 4e-3, 4.5e-3), Vec3(2e-3, 7e-3, 6e-3), Vec3(9e-3, 9e-3, 1e-3)}) {
    const AverageGrid grid = {{x - Vec3::Constant(1.5 * h), x + Vec3::Constant(1.5 * h)}, {3, 3, 3}};
    const Averages before = averages(w, grid, kernel);
    REQUIRE(w.step());
    const Averages after = averages(w, grid, kernel);
    const auto flux = [&](const Vec3& side) {
      const Average& a =
          before.at(1 + static_cast<int>(side.x()), 1 + static_cast<int>(side.y()), 1 + static_cast<int>(side.z()));
      return Mat3(a.stress() + Mat3(a.density * a.velocity * a.velocity.transpose()));
    };
    Vec3 gain = before.at(1, 1, 1).density * Vec3(0, 0, -g);
    double size = gain.norm();
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 side = Vec3::Unit(axis);
      const Vec3 part = (flux(side) - flux(-side)).col(axis) / (2 * h);
      gain -= part;
      size += part.norm();
    }
    const Vec3 found = (after.at(1, 1, 1).momentum() - before.at(1, 1, 1).momentum()) / dt;
    // The differences err by h^2/6 of the third derivative, (h/c)^2 of some 10; the step by dt v/c.
    CHECK((found - gain).norm() < 0.02 * size);
    CHECK(found.norm() > 0.2 * size);
  }
}

TEST_CASE("the stress in a settled bed is the weight above") {
  // Walls without friction bear no weight. A slice's vertical stress, times the area, is the mean over the slice of the
  // weight of all centres above.
  dem::World<Balls> w(options({0, 0, -g}, 1e-5));
  w.set_contact({{stiffness, 0.05, 1.0}, {0.4, 2000.0, 0.05, 1.0}});
  w.set_contact("grain", "wall", {{stiffness, 0.05, 1.0}, {0.0, 0.0, 0.0, 1.0}});
  const auto species = w.add_species(Sphere(radius));
  const double edge = 10.3e-3;
  add_open_box(w, {edge, edge, 0});
  add_block(w, species, Vec3::Constant(1.05e-3), 2.05e-3, 5, 5, 12, 0.05);
  REQUIRE(w.run_for(0.4));
  REQUIRE(kinetic_energy(w) < 1e-9);
  const double mass = w.species(species).mass, top = 18e-3;
  const int slices = 9;
  const auto found = average_slices(w, {Vec3(-1e-3, -1e-3, 0), Vec3(edge + 1e-3, edge + 1e-3, top)}, 2, slices);
  const double area = (edge + 2e-3) * (edge + 2e-3);
  for (int k = 0; k < slices; ++k) {
    const double low = top * k / slices, high = top * (k + 1) / slices;
    double above = 0.0;
    for_each_grain(
        w, [&](GrainId p) { above += mass * g * std::clamp((w.position(p).z() - low) / (high - low), 0.0, 1.0); });
    // What is left of motion is 1e-4 of the weight of a grain at the most, and there are up to 300 of them.
    CHECK(found[static_cast<std::size_t>(k)].stress()(2, 2) * area == Approx(above).epsilon(1e-3));
    CHECK(found[static_cast<std::size_t>(k)].coordination > 3.0);
    CHECK(found[static_cast<std::size_t>(k)].temperature() < 1e-6);
  }
}

TEST_CASE("the temperature is the scatter of velocities about their mean") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(radius));
  const Vec3 mean(0.3, 0.0, -0.2);
  for (int k = 0; k < 6; ++k) {
    const double side = k % 2 == 0 ? 0.1 : -0.1;
    w.add_grain({SpeciesId(0), {0.01 * k, 0, 0}, mean + side * Vec3::Unit(k / 2)});
  }
  const Average a = average_in(w, {Vec3(-1, -1, -1), Vec3(1, 1, 1)});
  CHECK((a.velocity - mean).norm() < 1e-15);
  CHECK(a.temperature() == Approx(0.01 / 3).epsilon(1e-12));  // six of (0.1 m/s)^2, over three axes and six grains
  CHECK(a.kinetic_stress.isApprox(a.density * a.temperature() * Mat3::Identity(), 1e-12));
  CHECK(a.contact_stress.norm() == 0.0);
  CHECK(a.coordination == 0.0);
}

TEST_CASE("grids and kernels that are none are refused, and fields go into files") {
  const auto w = moving_block(3);
  check_refused([&] { averages(w, {{Vec3(0, 0, 0), Vec3(1, 0, 1)}, {1, 1, 1}}); }, "edge 0 m along y");
  check_refused([&] { averages(w, {{Vec3(0, 0, 0), Vec3(1, 1, HUGE_VAL)}, {1, 1, 1}}); }, "edge inf m along z");
  check_refused([&] { averages(w, {{Vec3(0, 0, 0), Vec3(1, 1, 1)}, {1, 0, 1}}); }, "0 cells along y");
  check_refused([&] { average_slices(w, {Vec3(0, 0, 0), Vec3(1, 1, 1)}, 3, 2); }, "axis 3");
  check_refused([&] { Kernel::lucy(0.0); }, "reach of Lucy's kernel");
  check_refused([&] { Kernel::gaussian(-1.0); }, "width of a Gaussian");
  const auto file = std::filesystem::temp_directory_path() / "dem_averages_test.vtp";
  dem::soil::write_vtk_averages(file, averages(w, {{Vec3(0, 0, 0), Vec3(4e-3, 4e-3, 4e-3)}, {2, 3, 4}}));
  // The middles of 24 cells, each with a stress of nine numbers.
  const VtkContent content = read_vtk(file);
  CHECK(content.tag("Piece").at("NumberOfPoints") == "24");
  CHECK(content.array("stress").at("NumberOfComponents") == "9");
  CHECK_FALSE(content.bytes.at("stress").empty());
  std::filesystem::remove(file);
  // The cells themselves, with the same numbers.
  const auto cells = std::filesystem::temp_directory_path() / "dem_averages_test.vti";
  dem::soil::write_vtk_averages(cells, averages(w, {{Vec3(1e-3, 0, 0), Vec3(5e-3, 6e-3, 4e-3)}, {2, 3, 4}}));
  const VtkContent image = read_vtk(cells, "ImageData");
  CHECK(image.tag("ImageData").at("WholeExtent") == "0 2 0 3 0 4");
  CHECK(image.tag("ImageData").at("Origin") == "0.001 0 0");
  CHECK(image.tag("ImageData").at("Spacing") == "0.002 0.002 0.001");
  CHECK(image.tag("Piece").at("Extent") == "0 2 0 3 0 4");
  CHECK(image.array("density").parents == "VTKFile/ImageData/Piece/CellData/");
  const auto again = averages(w, {{Vec3(1e-3, 0, 0), Vec3(5e-3, 6e-3, 4e-3)}, {2, 3, 4}});
  const auto density = image.values<double>("density");
  REQUIRE(density.size() == 24);
  for (std::size_t c = 0; c < density.size(); ++c) CHECK(density[c] == again.values[c].density);
  std::filesystem::remove(cells);
}

TEST_CASE("averages over time are means over moments, and velocities those of the mass") {
  dem::World<Balls> w(options({0, 0, 0}, 1e-5));
  w.set_contact(sand<Balls>());
  w.add_species(Sphere(radius));
  // Two balls alone: one is at rest, the other flies out of the box between the moments.
  w.add_grain({SpeciesId(0), {0.05, 0.05, 0.05}});
  w.add_grain({SpeciesId(0), {0.05, 0.09, 0.095}, {0, 0, 1}});
  const AverageGrid grid{{Vec3(0, 0, 0), Vec3(0.1, 0.1, 0.1)}};
  dem::soil::TimeAverages mean(grid);
  check_refused([&] { (void)mean.averages(); }, "no moments", "add(world)");
  for (int k = 0; k < 4; ++k) {
    mean.add(w);
    REQUIRE(w.run_for(4e-3));  // it is inside at 0 and 4 ms, outside at 8 and 12 ms
  }
  CHECK(mean.moments() == 4);
  const Average a = mean.averages().values.at(0);
  const double mass = w.species(SpeciesId(0)).mass, volume = 1e-3;
  CHECK(a.density == Approx((4 + 2) * mass / volume / 4));
  CHECK(a.grains == Approx(6 / volume / 4));
  CHECK((a.velocity - Vec3(0, 0, 2.0 / 6)).norm() < 1e-12);
  CHECK((a.momentum() - Vec3(0, 0, 2 * mass / volume / 4)).norm() < 1e-12);
  // What is left of the flow of momentum, the mean of m v^2 over moments, when that of the mean velocity is taken off.
  CHECK(a.kinetic_stress(2, 2) == Approx((2 * mass / volume - 6 * mass / volume / 9) / 4));

  // One moment is what averages() tells.
  dem::World<Balls> block = moving_block(4);
  const AverageGrid cells{{Vec3(0, 0, 0), Vec3(8e-3, 8e-3, 8e-3)}, {2, 2, 2}};
  dem::soil::TimeAverages once(cells, Kernel::lucy(2e-3));
  once.add(block);
  const Averages now = averages(block, cells, Kernel::lucy(2e-3)), same = once.averages();
  for (std::size_t k = 0; k < now.values.size(); ++k) {
    CHECK(now.values[k].density == same.values[k].density);
    CHECK(now.values[k].contact_stress == same.values[k].contact_stress);
    CHECK(now.values[k].kinetic_stress == same.values[k].kinetic_stress);
  }
}

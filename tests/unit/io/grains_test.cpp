// All that is known of grains, as points for ParaView and as a table.

#include "catch.hpp"
#include "files.hpp"
#include "random.hpp"
#include "sleeping_bed.hpp"
#include "vtk_reader.hpp"

#include <dem/io/csv_table.hpp>
#include <dem/io/grains_csv.hpp>
#include <dem/io/vtk_grain_points.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

using dem::Vec3;

namespace grains_test {

namespace {

/// Cubes and one that turns, of two species; numbers of grains are not those of rows.
struct Bed : SleepingBed {
  Bed() {
    const auto large = world.add_species(dem::shape::cube8(2e-3), {.density = 4000.0});
    world.add_grain({.species = large,
                     .position = {0.1, 0.2, 0.3},
                     .velocity = {1, 2, 3},
                     .rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                     .angular_velocity = {4, 5, 6}});
  }
};

}  // namespace

TEST_CASE("points of grains say which they are, of what mass, and how they move") {
  const TempFolder folder;
  const Bed bed;
  const auto& world = bed.world;
  const std::vector<double> heat(world.grain_count(), 7.0);
  dem::io::write_vtk_grain_points(folder / "points.vtp", world, {}, {{"heat", 1, heat}});
  const VtkContent file = read_vtk(folder / "points.vtp");
  const auto grains = world.grains();
  const auto grain = file.values<std::uint32_t>("grain");
  const auto species = file.values<std::int32_t>("species");
  const auto mass = file.values<double>("mass_kg"), radius = file.values<double>("bounding_radius_m");
  const auto points = file.values<double>("Points"), velocity = file.values<double>("velocity_m_s");
  const auto spin = file.values<double>("angular_velocity_rad_s"), q = file.values<double>("quaternion_wxyz");
  const auto force = file.values<double>("net_contact_force_N");
  const auto vector = [](const std::vector<double>& of, std::size_t i) { return Vec3(of.data() + 3 * i); };
  REQUIRE(grain.size() == grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const auto p = grains[i];
    CHECK(grain[i] == p.value);
    CHECK(species[i] == (i + 1 == grains.size() ? 1 : 0));
    CHECK(mass[i] == world.species(world.species_of(p)).mass);
    CHECK(radius[i] == world.species(world.species_of(p)).shape.bounding_radius());
    CHECK(vector(points, i) == world.position(p));
    CHECK(vector(velocity, i) == world.velocity(p));
    CHECK(vector(spin, i) == world.angular_velocity(p));
    CHECK(vector(force, i) == world.force(p));
    const Eigen::Quaterniond turn(q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]);
    CHECK((turn.toRotationMatrix() - world.rotation(p)).norm() < 1e-14);
  }
  CHECK(file.values<std::uint8_t>("asleep").size() == grains.size());
  CHECK(file.values<double>("heat") == heat);
}

TEST_CASE("turns of points in single precision are off by less than 0.06 degrees") {
  const TempFolder folder;
  dem::World<models::VerletCubes> world;
  world.set_contact({{500.0, 0.06, 1.0}, {0.4, 500.0, 0.05, 0.975}});
  const auto cube = world.add_species(dem::shape::cube8(1e-3));
  Random random(5);
  for (int k = 0; k < 500; ++k) {
    world.add_grain({.species = cube, .position = {0.01 * k, 0, 0}, .rotation = random.rotation()});
  }
  dem::io::write_vtk_grain_points(folder / "points.vtp", world, {.single_precision = true});
  const auto q = read_vtk(folder / "points.vtp").values<float>("quaternion_wxyz");
  const auto grains = world.grains();
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(q[4 * i], q[4 * i + 1], q[4 * i + 2], q[4 * i + 3]).normalized();
    CHECK(turn.angularDistance(Eigen::Quaterniond(world.rotation(grains[i]))) < 0.06 * std::numbers::pi / 180.0);
  }
}

TEST_CASE("a table of grains reads back as the grains") {
  const TempFolder folder;
  const Bed bed;
  const auto& world = bed.world;
  dem::io::write_grains_csv(folder / "grains.csv", world);
  const auto table = dem::io::read_csv(folder / "grains.csv");
  const auto grains = world.grains();
  REQUIRE(table.rows.size() == grains.size());
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const auto p = grains[i];
    const auto cell = [&](const char* name) { return table.rows[i][table.column(name)]; };
    const auto vector = [&](const char* x, const char* y, const char* z) { return Vec3(cell(x), cell(y), cell(z)); };
    CHECK(cell("grain") == p.value);
    CHECK(cell("species") == world.species_of(p).value);
    CHECK(cell("mass_kg") == world.species(world.species_of(p)).mass);
    CHECK(cell("bounding_radius_m") == world.species(world.species_of(p)).shape.bounding_radius());
    CHECK(vector("x_m", "y_m", "z_m") == world.position(p));
    CHECK(vector("velocity_x_m_per_s", "velocity_y_m_per_s", "velocity_z_m_per_s") == world.velocity(p));
    CHECK(vector("angular_velocity_x_rad_per_s", "angular_velocity_y_rad_per_s", "angular_velocity_z_rad_per_s") ==
          world.angular_velocity(p));
  }
}

}  // namespace grains_test

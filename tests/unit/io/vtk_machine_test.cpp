#include "catch.hpp"
#include "core/error_of.hpp"
#include "files.hpp"
#include "io/vtk_reader.hpp"
#include "worlds.hpp"

#include <dem/io/vtk_machine.hpp>
#include <dem/mbd/machine.hpp>
#include <dem/report/columns.hpp>
#include <dem/world/world.hpp>

#include <fstream>
#include <sstream>

using Catch::Approx;
using Catch::Matchers::Contains;
using dem::BodyId;
using dem::Vec3;

namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("bodies of a machine are drawn in their reference frames, with their motion") {
  // A part whose centre of mass and principal axes are not those of its drawing.
  const dem::Mat3 askew = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const dem::Mat3 tensor = askew * Vec3(1.0, 2.0, 2.5).asDiagonal() * askew.transpose();
  dem::mbd::Machine<dem::integrator::PredictorCorrector> m;
  m.ground();
  const BodyId part = m.add_body(
      dem::mbd::given_body("part", 1.0, tensor, {0.1, 0.2, 0.3}).at({1, 2, 3}, askew).moving({4, 5, 6}, {0, 0, 2}));
  const dem::io::SurfaceMesh mesh = dem::io::rectangle_mesh(2, 4);
  const TempFolder folder;
  dem::io::write_vtk_machine(folder / "part.vtp", m, {{.body = part, .mesh = &mesh, .position = {0, 0, 0.5}}});
  const VtkContent file = read_vtk(folder / "part.vtp");
  const auto points = file.values<double>("Points");
  REQUIRE(points.size() == 12);
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 expected = Vec3(1, 2, 3) + askew * (mesh.vertices[k] + Vec3(0, 0, 0.5));
    CHECK((Vec3(points[3 * k], points[3 * k + 1], points[3 * k + 2]) - expected).norm() < 1e-14);
  }
  CHECK(file.values<std::int32_t>("machine_part") == std::vector<std::int32_t>{1});
  CHECK(file.values<double>("angular_velocity_rad_s")[2] == Approx(2.0));
  const Vec3 v = m.body(part).velocity();
  CHECK(file.values<double>("velocity_m_s") == std::vector<double>{v.x(), v.y(), v.z()});
  CHECK(file.values<double>("contact_force_N") == std::vector<double>{0, 0, 0});
  check_refused([&] { dem::io::write_vtk_machine(folder / "no.vtp", m, {{.body = BodyId(7), .mesh = &mesh}}); },
                "body 7 is asked for");
  check_refused([&] { dem::io::write_vtk_machine(folder / "no.vtp", m, {{.body = part}}); }, "has no mesh");
}

TEST_CASE("a frame of a world shows its grains, and its surfaces of every kind with what the grains press") {
  dem::World<models::CorrectedBalls> world({.gravity = {0, 0, -9.81}});
  world.set_contact({{2000.0, 0.5, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  const auto plane = world.add_surface(world.ground(), dem::surface::Plane{});
  const BodyId lift = world.machine().add_fixed_body("lift", {0, 0, 0.1});
  world.machine().add_motion(
      dem::mbd::prescribed_position("up", lift, Vec3::UnitZ(), dem::mbd::Signal::ramp(0.0, 0.01)));
  world.add_surface(lift, dem::surface::Box({0.1, 0.1, 0.01}));
  const auto hidden = world.add_surface(lift, dem::surface::Sphere(0.01));
  world.set_active(hidden, false);
  world.add_grain({.species = species, .position = {0, 0, 1e-3}});
  REQUIRE(world.run_for(0.1));

  const TempFolder folder;
  dem::io::VtkSeries series(folder / "run.pvd");
  dem::io::add_vtk_frame(series, world, {.divisions = 2, .plane_size = 0.2});
  const std::string pvd = text_of(folder / "run.pvd");
  CHECK_THAT(pvd, Contains("run/grains_000000.vtp") && Contains("run/surfaces_000000.vtp"));
  dem::io::write_vtk_surfaces(folder / "s.vtp", world, {}, 0.2);
  const VtkContent file = read_vtk(folder / "s.vtp");
  // The plane's square and the six faces of the box; a surface that touches nothing is not shown.
  const auto part = file.values<std::int32_t>("machine_part");
  CHECK(part == std::vector<std::int32_t>{0, 1, 1, 1, 1, 1, 1});
  CHECK(file.values<std::int32_t>("surface") == std::vector<std::int32_t>{0, 1, 1, 1, 1, 1, 1});
  const auto points = file.values<double>("Points");
  CHECK(points.size() == 3 * (4 + 8));
  CHECK(std::abs(points[0]) == Approx(0.1));
  const auto force = file.values<double>("force_of_grains_N");
  CHECK(force[2] == world.surface_force(plane).z());
  CHECK(force[2] < 0.0);
  CHECK(file.values<double>("velocity_m_s")[5] == Approx(0.01));

  // A body as a mesh of its own, at the same time of the same series.
  const dem::io::SurfaceMesh mesh = dem::io::box_mesh({1, 1, 1});
  dem::io::add_vtk_frame(series, world.time(), world.machine(), {{.body = lift, .mesh = &mesh}}, "lift");
  const std::string both = text_of(folder / "run.pvd");
  CHECK_THAT(both, Contains("run/lift_000000.vtp") && Contains("run/grains_000000.vtp"));
  const auto time_of = [&](const std::string& part) {
    const std::size_t at = both.rfind("timestep=", both.find(part));
    return both.substr(at, both.find('"', at + 10) - at);
  };
  CHECK(time_of("lift_000000") == time_of("grains_000000"));
}

TEST_CASE("files of one number are of one frame, and a surface keeps its number") {
  dem::World<models::CorrectedBalls> world({.gravity = {0, 0, -9.81}});
  world.set_contact({{2000.0, 0.5, 1.0}, {0.4, 2000.0, 0.015, 0.975}});
  const auto species = world.add_species(dem::shape::Sphere(1e-3));
  const auto hidden = world.add_surface(world.ground(), dem::surface::Sphere(0.01));
  world.add_surface(world.ground(), dem::surface::Plane{});
  world.set_active(hidden, false);
  const TempFolder folder;
  dem::io::VtkSeries series(folder / "run.pvd");
  const dem::io::FrameOptions all{.points = true, .contacts = true};
  dem::io::add_vtk_frame(series, world, all);
  world.add_grain({.species = species, .position = {0, 0, 0.9e-3}});
  REQUIRE(world.run_for(1e-4));
  dem::io::add_vtk_frame(series, world, all);
  for (const char* part : {"grains", "points", "surfaces", "contacts"}) {
    INFO(part);
    const auto path_of = [&](int k) { return folder.path() / fmt::format("run/{}_{:06}.vtp", part, k); };
    REQUIRE(std::filesystem::exists(path_of(1)));
    const bool is_surfaces = std::string(part) == "surfaces";
    CHECK((read_vtk(path_of(0)).tag("Piece").at("NumberOfPoints") == "0") != is_surfaces);
    CHECK(read_vtk(path_of(1)).tag("Piece").at("NumberOfPoints") != "0");
  }
  const VtkContent surfaces = read_vtk(folder / "run/surfaces_000001.vtp");
  CHECK(surfaces.values<std::int32_t>("body") == std::vector<std::int32_t>{0});
  CHECK(surfaces.values<std::int32_t>("surface") == std::vector<std::int32_t>{1});
  CHECK(read_vtk(folder / "run/contacts_000001.vtp").values<std::int32_t>("surface") ==
        std::vector<std::int32_t>{1, 1});

  // Parts that are not asked for are not written.
  dem::io::VtkSeries points(folder / "points.pvd");
  dem::io::add_vtk_frame(points, world, {.grains = false, .points = true});
  CHECK(std::filesystem::exists(folder / "points/points_000000.vtp"));
  CHECK(!std::filesystem::exists(folder / "points/grains_000000.vtp"));
  CHECK(!std::filesystem::exists(folder / "points/contacts_000000.vtp"));
}

TEST_CASE("rows under named columns become curves") {
  dem::io::Columns rows({"time_s", "angle_rad"});
  for (int k = 0; k < 3; ++k) rows.row(std::vector<double>{0.1 * k, 2.0 * k});
  CHECK(rows.rows() == 3);
  const dem::io::Series s = rows.series("time_s", "angle_rad", {.style = dem::io::SeriesStyle::Points});
  CHECK(s.name == "angle_rad");
  CHECK(s.x == std::vector<double>{0.0, 0.1, 0.2});
  CHECK(s.y == std::vector<double>{0.0, 2.0, 4.0});
  CHECK(s.style == dem::io::SeriesStyle::Points);
  CHECK(rows.series("angle_rad", "time_s", {.name = "turned round"}).name == "turned round");
  check_refused([&] { (void)rows.column("speed"); }, "no column is named 'speed'", "time_s, angle_rad");
  check_refused([&] { rows.row(std::vector<double>{1.0}); }, "row of 1 numbers", "2 columns");
}

#include "catch.hpp"
#include "files.hpp"
#include "io/vtk_reader.hpp"
#include "random.hpp"

#include <dem/geometry/polyhedron/polyhedra.hpp>
#include <dem/io/polyhedron_mesh.hpp>
#include <dem/io/vtk.hpp>
#include <dem/math/vector.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using namespace dem::io;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::Mat3;
using dem::Vec3;

TEST_CASE("points and their data are read back from a vtp file") {
  const TempFolder folder;
  const std::vector<Vec3> positions{{1, 2, 3}, {4, 5, 6}}, velocities{{0, 0, -1}, {0.1, 0.2, 0.3}};
  const std::vector<double> radii{0.5, 1.0 / 3};
  const std::vector<int> species{7, -8};
  const std::vector<std::int64_t> ids{1LL << 40, 2};
  const std::array<std::uint8_t, 2> flags{0, 255};
  const std::array<float, 2> heat{1.5F, 2.5F};
  const std::vector<std::uint32_t> grains{4'000'000'000U, 1};
  const std::vector<std::size_t> steps{1ULL << 40U, 2};
  const std::vector<dem::Vector3<double>> forces{{1, 2, 3}, {4, 5, 6}};
  const auto path = folder / "new/grains.vtp";
  write_vtk_points(path, flat(positions),
                   {{"radius", 1, radii},
                    {"velocity <\"m/s\">", 3, flat(velocities)},
                    {"species", 1, species},
                    {"id", 1, ids},
                    {"flag", 1, flags},
                    {"heat", 1, heat},
                    {"grain", 1, grains},
                    {"step", 1, steps},
                    {"force_N", 3, flat(forces)}},
                   {.time_s = 0.25});

  const VtkContent file = read_vtk(path);
  CHECK(file.tag("Piece").at("NumberOfPoints") == "2");
  CHECK(file.tag("Piece").at("NumberOfVerts") == "2");
  CHECK(file.values<double>("Points") == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(file.array("Points").parents == "VTKFile/PolyData/Piece/Points/");
  CHECK(file.array("Points").at("NumberOfComponents") == "3");
  CHECK(file.values<double>("radius") == radii);
  CHECK(file.array("radius").parents == "VTKFile/PolyData/Piece/PointData/");
  CHECK(file.array("radius").at("type") == "Float64");
  CHECK(file.values<double>("velocity &lt;&quot;m/s&quot;&gt;") == std::vector<double>{0, 0, -1, 0.1, 0.2, 0.3});
  CHECK(file.values<std::int32_t>("species") == species);
  CHECK(file.array("species").at("type") == "Int32");
  CHECK(file.values<std::int64_t>("id") == ids);
  CHECK(file.array("id").at("type") == "Int64");
  CHECK(file.values<std::uint8_t>("flag") == std::vector<std::uint8_t>{0, 255});
  CHECK(file.array("flag").at("type") == "UInt8");
  CHECK(file.values<float>("heat") == std::vector<float>{1.5F, 2.5F});
  CHECK(file.array("heat").at("type") == "Float32");
  CHECK(file.values<std::uint32_t>("grain") == grains);
  CHECK(file.array("grain").at("type") == "UInt32");
  CHECK(file.values<std::size_t>("step") == steps);
  CHECK(file.array("step").at("type") == "UInt64");
  CHECK(file.values<double>("force_N") == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(file.values<std::int32_t>("connectivity") == std::vector<std::int32_t>{0, 1});
  CHECK(file.values<std::int32_t>("offsets") == std::vector<std::int32_t>{1, 2});
  CHECK(file.array("TimeValue").parents == "VTKFile/PolyData/FieldData/");
  CHECK_THAT(read_file(path), Catch::Matchers::ContainsSubstring("format=\"ascii\">0.25</DataArray>"));
}

TEST_CASE("arrays of several blocks, and of none, are read back") {
  const TempFolder folder;
  std::vector<Vec3> positions;
  std::vector<std::int64_t> numbers;
  for (std::int64_t k = 0; k < 17000; ++k) {  // 136,000 bytes: a block and a part of one
    positions.emplace_back(static_cast<double>(k), std::sin(static_cast<double>(k)), 0.0);
    numbers.push_back(k * k);
  }
  write_vtk_points(folder / "many.vtp", flat(positions), {{"number", 1, numbers}});
  const VtkContent many = read_vtk(folder / "many.vtp");
  CHECK(many.values<std::int64_t>("number") == numbers);
  CHECK(many.values<double>("Points").at(3 * 16999 + 1) == std::sin(16999.0));

  write_vtk_points(folder / "none.vtp", std::vector<double>{}, {{"number", 1, std::vector<std::int64_t>{}}});
  CHECK(read_vtk(folder / "none.vtp").values<std::int64_t>("number").empty());
}

TEST_CASE("numbers in single precision are rounded as far as they are asked to be") {
  const TempFolder folder;
  const std::vector<double> positions = {1.0, 1.0 + 0x1p-12, -3.3, 1e-7, 0.0, 1e6};
  const std::vector<double> speeds = {1.0 / 3.0, -1e-30}, odd = {std::nan(""), std::numeric_limits<double>::infinity()};
  write_vtk_points(folder / "rounded.vtp", positions,
                   {{"speed", 1, speeds, {.bits = 10}}, {"odd", 1, odd, {.bits = 10}}, {"whole", 1, speeds}},
                   {.single_precision = true, .position_rounding = {.step = 0x1p-10}});
  const VtkContent file = read_vtk(folder / "rounded.vtp");
  const auto points = file.values<float>("Points");
  for (std::size_t k = 0; k < positions.size(); ++k) {
    CHECK(std::abs(points[k] - positions[k]) <= std::max(0x1p-11, 1e-7 * positions[k]));
    CHECK(std::fmod(points[k], 0x1p-10F) == 0.0F);
  }
  const auto rounded = file.values<float>("speed");
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    CHECK(std::abs(rounded[k] / speeds[k] - 1.0) <= 0x1p-11);  // half of the last of ten bits
    CHECK((std::bit_cast<std::uint32_t>(rounded[k]) & 0x1fffU) == 0);
  }
  CHECK(std::isnan(file.values<float>("odd")[0]));
  CHECK(std::isinf(file.values<float>("odd")[1]));
  CHECK(file.values<float>("whole")[0] == 1.0F / 3.0F);
}

TEST_CASE("single precision stores doubles as floats and integers as they are") {
  const TempFolder folder;
  const std::vector<double> positions{0.1, 0.2, 0.3};
  const std::vector<int> species{3};
  write_vtk_points(folder / "a.vtp", positions, {{"species", 1, species}}, {.single_precision = true});
  const VtkContent file = read_vtk(folder / "a.vtp");
  CHECK(file.array("Points").at("type") == "Float32");
  CHECK(file.values<float>("Points") == std::vector<float>{0.1F, 0.2F, 0.3F});
  CHECK(file.values<std::int32_t>("species") == species);
}

TEST_CASE("columns are interleaved") {
  CHECK(interleave(std::vector{1.0, 2.0}, std::vector{3.0, 4.0}, std::vector{5.0, 6.0}) ==
        std::vector<double>{1, 3, 5, 2, 4, 6});
  CHECK(error_of([] { (void)interleave(std::vector{1.0}, {}, std::vector{1.0}); }) ==
        "interleave: 1 x, 0 y and 1 z values; give as many of each");
}

TEST_CASE("vectors of nothing are no numbers") {
  CHECK(flat(std::vector<Vec3>{}).empty());
  CHECK(flat(std::vector<Eigen::Vector2f>(3)).size() == 6);
}

TEST_CASE("a file without points is still a file") {
  const TempFolder folder;
  write_vtk_points(folder / "a.vtp", {}, {{"radius", 1, std::span<const double>{}}});
  const VtkContent file = read_vtk(folder / "a.vtp");
  CHECK(file.tag("Piece").at("NumberOfPoints") == "0");
  CHECK(file.values<double>("radius").empty());
}

TEST_CASE("polyhedral grains are written with a polygon for each face") {
  const TempFolder folder;
  const SurfaceMesh mesh = polyhedron_mesh(dem::shape::prism(6, 1.0, 2.0));
  const Mat3 turn = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const std::vector<double> speed{1.5, 2.5};
  write_vtk_bodies(folder / "p.vtp", {{&mesh, Vec3(1, 2, 3), turn}, {&mesh}}, {{"speed_m_s", 1, speed}});
  const VtkContent file = read_vtk(folder / "p.vtp");
  CHECK(file.tag("Piece").at("NumberOfPoints") == "24");
  CHECK(file.tag("Piece").at("NumberOfPolys") == "16");
  const auto points = file.values<double>("Points");
  const auto corner = [&](std::int32_t k) { return Vec3(points.data() + 3 * k); };
  const auto connectivity = file.values<std::int32_t>("connectivity"), offsets = file.values<std::int32_t>("offsets");
  REQUIRE(connectivity.size() == 2 * 36);
  // Outward polygons around the first prism's middle close its volume, 3 sqrt(3)/2 R^2 h.
  double volume = 0.0;
  int from = 0, hexagons = 0;
  for (std::size_t f = 0; f < 8; ++f) {
    hexagons += offsets[f] - from == 6;
    const auto at = [&](int k) -> Vec3 { return corner(connectivity[static_cast<std::size_t>(k)]) - Vec3(1, 2, 3); };
    for (int k = from + 2; k < offsets[f]; ++k) volume += at(from).dot(at(k - 1).cross(at(k))) / 6.0;
    from = offsets[f];
  }
  CHECK(hexagons == 2);
  CHECK(volume == Approx(3.0 * std::sqrt(3.0)));
  CHECK(file.values<double>("speed_m_s")[7] == 1.5);
  CHECK(file.values<double>("speed_m_s")[8] == 2.5);
}

TEST_CASE("bodies are written at their poses with the values of their body") {
  const TempFolder folder;
  const SurfaceMesh plate = rectangle_mesh(2, 4);
  const SurfaceMesh wedge{.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, .triangles = {{0, 1, 2}}};
  Mat3 quarter_turn;
  quarter_turn = Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const std::vector<double> load{10, 20, 30}, velocity{1, 2, 3, 4, 5, 6, 7, 8, 9};
  write_vtk_bodies(folder / "b.vtp",
                   {{&wedge}, {&plate, Vec3(10, 0, 5), quarter_turn}, {&wedge, Vec3(0, 0, 1), Mat3::Identity()}},
                   {{"load_N", 1, load}, {"velocity_m_s", 3, velocity}});

  const VtkContent file = read_vtk(folder / "b.vtp");
  CHECK(file.tag("Piece").at("NumberOfPoints") == "10");
  CHECK(file.tag("Piece").at("NumberOfPolys") == "3");
  CHECK(file.values<std::int32_t>("connectivity") == std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(file.values<std::int32_t>("offsets") == std::vector<std::int32_t>{3, 7, 10});
  CHECK(file.array("offsets").parents == "VTKFile/PolyData/Piece/Polys/");
  CHECK(file.values<std::int32_t>("body") == std::vector<std::int32_t>{0, 1, 2});
  CHECK(file.array("load_N").parents == "VTKFile/PolyData/Piece/CellData/");
  CHECK(file.values<double>("load_N") == load);
  CHECK(file.values<double>("velocity_m_s") == velocity);
  const auto points = file.values<double>("Points");
  // The plate's first corner (-1, -2, 0) is turned to (2, -1, 0) and moved.
  CHECK(points[9] == Approx(12));
  CHECK(points[10] == Approx(-1));
  CHECK(points[11] == Approx(5));
  CHECK(points[23] == Approx(1));
}

TEST_CASE("the ready-made meshes are closed and face outwards") {
  for (const SurfaceMesh& mesh : {box_mesh({2, 3, 4}), cylinder_mesh(0.5, 2, 96)}) {
    std::set<std::pair<int, int>> edges;
    double volume = 0;
    const auto add = [&](const auto& face) {
      for (std::size_t k = 0; k < face.size(); ++k) {
        CHECK(edges.emplace(face[k], face[(k + 1) % face.size()]).second);
      }
      const auto vertex = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(face[k])]; };
      for (std::size_t k = 2; k < face.size(); ++k) volume += vertex(0).dot(vertex(k - 1).cross(vertex(k))) / 6;
    };
    for (const auto& face : mesh.triangles) add(face);
    for (const auto& face : mesh.quads) add(face);
    for (const auto& [a, b] : edges) CHECK(edges.count({b, a}) == 1);
    CHECK(volume == Approx(mesh.triangles.empty() ? 24.0 : std::acos(-1.0) * 0.5).epsilon(2e-3));
  }
}

TEST_CASE("a collection is complete after each file") {
  const TempFolder folder;
  const auto pvd = folder / "run 1/shear & more.pvd";
  VtkSeries series(pvd);
  const auto entries = [&] {
    auto tags = XmlReader::tags(read_file(pvd));
    REQUIRE(tags.size() >= 2);
    CHECK(tags[0].name == "VTKFile");
    CHECK(tags[0].at("type") == "Collection");
    CHECK(tags[1].name == "Collection");
    tags.erase(tags.begin(), tags.begin() + 2);
    return tags;
  };
  CHECK(entries().empty());

  for (std::size_t i = 0; i < 3; ++i) {
    const double time = 0.5 * static_cast<double>(i);
    const auto grains = series.next_path("grains");
    CHECK(grains == folder / ("run 1/shear & more/grains_00000" + std::to_string(i) + ".vtp").c_str());
    write_vtk_points(grains, std::vector<double>{0, 0, 0});
    series.add(time, grains, "grains");
    REQUIRE(entries().size() == 2 * i + 1);
    series.add(time, folder / "elsewhere.vtp", "blade \"A\"");
    const auto all = entries();
    REQUIRE(all.size() == 2 * i + 2);
    CHECK(all[2 * i].at("timestep") == fmt::format("{}", time));
    CHECK(all[2 * i].at("part") == "0");
    CHECK(all[2 * i].at("name") == "grains");
    CHECK(all[2 * i].at("file") == fmt::format("shear &amp; more/grains_{:06}.vtp", i));
    CHECK(all[2 * i + 1].at("part") == "1");
    CHECK(all[2 * i + 1].at("name") == "blade &quot;A&quot;");
    CHECK(all[2 * i + 1].at("file") == "../elsewhere.vtp");
    CHECK(!std::filesystem::exists(folder / "run 1/shear & more.pvd.tmp"));
  }
}

TEST_CASE("names that are no UTF-8 leave files that ParaView reads") {
  const TempFolder folder;
  VtkSeries series(folder / "run.pvd");
  series.add(0.0, folder / "caf\xE9.vtp", "part \xFF");
  const std::vector<double> one = {0, 0, 0};
  write_vtk_points(folder / "a.vtp", one, {{"v\xFF", 3, one}});
  CHECK(read_file(folder / "run.pvd") == to_utf8(read_file(folder / "run.pvd")));
  const std::string points = read_file(folder / "a.vtp");
  const std::string xml = points.substr(0, points.find("<AppendedData"));
  CHECK(xml == to_utf8(xml));
}

TEST_CASE("a collection in the current folder has relative names, too") {
  const TempFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  VtkSeries series("run.pvd");
  CHECK(series.next_path("grains") == "run/grains_000000.vtp");
  series.add(0, series.next_path("grains"), "grains");
  CHECK_THAT(read_file("run.pvd"), Catch::Matchers::ContainsSubstring("file=\"run/grains_000000.vtp\""));
  std::filesystem::current_path(before);
}

TEST_CASE("vtk mistakes are told") {
  const TempFolder folder;
  const std::string path = (folder / "a.vtp").string(), start = "vtk file '" + path + "': ";
  const std::vector<double> one{0, 0, 0}, two{0, 0};
  CHECK(error_of([&] { write_vtk_points(path, two); }) ==
        start + "positions has 2 values, which is no multiple of 3; give x y z of each point");
  CHECK(error_of([&] {
          write_vtk_points(path, one, {{"v", 3, two}});
        }) == start + "array 'v' has 2 values, but 1 points with 3 components need 3");
  CHECK(error_of([&] { write_vtk_points(path, one, {{"", 3, one}}); }) == start + "array 0 has no name; give it one");
  CHECK(error_of([&] {
          write_vtk_points(path, one, {{"v", 3, one}, {"v", 3, one}});
        }) == start + "two arrays are named 'v'; rename one");
  CHECK(error_of([&] {
          write_vtk_points(path, one, {{"v", 0, one}});
        }) == start + "array 'v' has 0 components; give 1 (scalar), 3 (vector) or more");
  CHECK(error_of([&] { write_vtk_bodies(path, {BodyMesh{}}); }) == start + "body 0 has no mesh; set BodyMesh::mesh");
  const SurfaceMesh broken{.vertices = {Vec3(0, 0, 0)}, .triangles = {{0, 0, 1}}};
  CHECK(error_of([&] { write_vtk_bodies(path, {{&broken}}); }) ==
        start + "body 0: a face uses vertex 1, but the mesh has 1 vertices (0 to 0)");
  CHECK(error_of([&] {
          write_vtk_bodies(path, {}, {{"body", 1, std::span<const double>{}}});
        }) == start + "the array name 'body' is taken; rename yours");
  CHECK(!std::filesystem::exists(path));

  const std::string pvd = (folder / "a.pvd").string();
  CHECK(error_of([&] { VtkSeries(folder / "a.vtp"); }) ==
        "vtk series '" + path + "': ParaView knows a collection by its ending; name it 'a.pvd'");
  VtkSeries series(pvd);
  CHECK(error_of([&] { (void)series.next_path("../x"); }) ==
        "vtk series '" + pvd + "': '../x' cannot name files; use letters, digits, _ and -");
  CHECK(error_of([&] { series.add(0.0 / 0.0, "f.vtp"); }).find("the time of 'f.vtp' is") != std::string::npos);
  CHECK_THAT(error_of([] { (void)box_mesh({1, 0, 2}); }), ContainsSubstring("edge of a box_mesh is 0 m"));
  CHECK_THAT(error_of([] { (void)rectangle_mesh(1, -1); }),
             ContainsSubstring("edge of a rectangle_mesh along y is -1 m"));
  CHECK_THAT(error_of([] { (void)cylinder_mesh(1, 1, 2); }), ContainsSubstring("has 2 segments, but needs at least 3"));
  for (const double wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (int k = 0; k < 3; ++k) {
      Vec3 size(1, 1, 1);
      size[k] = wrong;
      CHECK_THAT(error_of([&] { (void)box_mesh(size); }), ContainsSubstring("must be finite"));
    }
    CHECK_THAT(error_of([&] { (void)rectangle_mesh(wrong, 1); }), ContainsSubstring("must be finite"));
    CHECK_THAT(error_of([&] { (void)cylinder_mesh(1, wrong); }), ContainsSubstring("must be finite"));
  }
}

#if defined(DEM_WITH_ZLIB)
TEST_CASE("a frame of grains as rigs write it takes less than 50 bytes a grain: 300,000 are less than 15 MB") {
  const TempFolder folder;
  constexpr std::size_t n = 20000;  // in the order of a lattice, as grains have who were rained; all move and turn
  Random random(1);
  std::vector<Vec3> position, velocity, spin, force;
  std::vector<double> quaternion, radius(n, 1.4e-3), mass(n, 2.3e-5);
  std::vector<std::uint32_t> number(n);
  std::vector<std::int32_t> contacts, neighbours, species(n);
  std::iota(number.begin(), number.end(), 0U);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 cell(static_cast<double>(k % 27), static_cast<double>(k / 27 % 27), static_cast<double>(k / 729));
    position.push_back(2.2e-3 * (cell + random.vector(0.3)));
    for (auto* v : {&velocity, &spin, &force})
      v->push_back(std::exp(3.0 * random.between(-1.0, 1.0)) * random.vector(1.0));
    const dem::Quaternion q(random.rotation());
    quaternion.insert(quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
    contacts.push_back(static_cast<std::int32_t>(random.between(2.0, 14.0)));
    neighbours.push_back(static_cast<std::int32_t>(random.between(2.0, 8.0)));
  }
  const Rounding digits = {.bits = 10}, turn = {.step = 0x1p-11};
  write_vtk_points(folder / "grains.vtp", flat(position),
                   {{"grain", 1, number},
                    {"species", 1, species},
                    {"mass_kg", 1, mass},
                    {"bounding_radius_m", 1, radius},
                    {"velocity_m_s", 3, flat(velocity), digits},
                    {"angular_velocity_rad_s", 3, flat(spin), digits},
                    {"quaternion_wxyz", 4, quaternion, turn},
                    {"net_contact_force_N", 3, flat(force), digits},
                    {"contact_points", 1, contacts},
                    {"coordination", 1, neighbours}},
                   {.single_precision = true, .position_rounding = {.step = 0x1p-21}});
  CHECK(std::filesystem::file_size(folder / "grains.vtp") < 50 * n);
}
#endif

#include "files.hpp"

#include <dem/geometry/mesh/mesh_mass_properties.hpp>
#include <dem/geometry/mesh/mesh_repair.hpp>
#include <dem/io/drawn_surface.hpp>
#include <dem/io/obj.hpp>
#include <dem/io/stl.hpp>
#include <dem/io/vtk_bodies.hpp>

#include <fmt/format.h>

#include <random>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::IndexedMesh;
using dem::Vec3;
using dem::io::parse_obj;
using dem::io::parse_stl;
namespace mesh = dem::mesh;

namespace {

std::string ascii_stl(const IndexedMesh& m) {
  std::string s = "solid part of a machine\n";
  for (std::size_t t = 0; t < m.triangles.size(); ++t) {
    s += "  facet normal 0 0 0\n    outer loop\n";
    for (int k = 0; k < 3; ++k) {
      s += fmt::format("      vertex {} {:e} {}\n", m.corner(t, k).x(), m.corner(t, k).y(), m.corner(t, k).z());
    }
    s += "    endloop\n  endfacet\n";
  }
  return s + "endsolid part of a machine\n";
}
std::string binary_stl(const IndexedMesh& m) {
  const TempFolder folder;
  dem::io::write_stl(folder / "m.stl", m);
  return dem::io::read_file(folder / "m.stl");
}
std::string obj(const IndexedMesh& m) {
  std::string s = "# a mesh\no part\n";
  for (const Vec3& v : m.vertices) s += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  s += "vn 0 0 1\nvt 0 0\ns off\n";
  for (const auto& t : m.triangles) s += fmt::format("f {}//1 {}/1 {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return s;
}
double volume(const IndexedMesh& m) { return dem::repaired(m).report.enclosed_volume; }

}  // namespace

TEST_CASE("a mesh survives STL files, binary and ascii, and OBJ files") {
  const IndexedMesh wheel = mesh::wheel({0.3, 0.2, 8, 0.02, 0.01, 64});
  const double exact = volume(wheel);
  CHECK(volume(parse_stl(ascii_stl(wheel), "a.stl")) == Approx(exact).epsilon(1e-5));   // y has 6 digits
  CHECK(volume(parse_stl(binary_stl(wheel), "b.stl")) == Approx(exact).epsilon(1e-6));  // floats
  CHECK(volume(parse_obj(obj(wheel), "c.obj")) == Approx(exact).epsilon(1e-14));
  CHECK(parse_obj(obj(wheel), "c.obj").triangles == wheel.triangles);
  const TempFolder folder;
  dem::io::write_file(folder / "wheel.obj", obj(wheel));
  CHECK(dem::io::read_obj(folder / "wheel.obj").triangles == wheel.triangles);
  CHECK(dem::repaired(parse_stl(binary_stl(wheel), "b.stl")).report.closed());
}

TEST_CASE("the solids of an STL file are told apart by their names") {
  const IndexedMesh box = mesh::box({1, 2, 3});
  std::string text = ascii_stl(box) + "solid \n endsolid\n" + ascii_stl(box.moved({5, 0, 0}).scaled(2));
  text.replace(text.rfind("solid part of"), 13, "solid lid of");  // behind "end"
  text.replace(text.rfind("\nsolid part of") + 1, 13, "solid lid of");
  const TempFolder folder;
  dem::io::write_file(folder / "two.stl", text);
  const auto solids = dem::io::read_stl_solids(folder / "two.stl");
  REQUIRE(solids.size() == 2);  // one has no facets
  CHECK(solids[0].name == "part of a machine");
  CHECK(solids[1].name == "lid of a machine");
  CHECK(volume(solids[0].mesh) == Approx(6.0));
  CHECK(volume(solids[1].mesh) == Approx(48.0));
  const auto binary = dem::io::parse_stl_solids(binary_stl(box), "b.stl");
  REQUIRE(binary.size() == 1);
  CHECK(binary[0].name.empty());
  CHECK(volume(binary[0].mesh) == Approx(6.0));
}

TEST_CASE("files of other programs: their line ends, their headers, their polygons") {
  const IndexedMesh box = mesh::box({1, 2, 3});
  std::string windows = ascii_stl(box), old_mac = ascii_stl(box);
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.replace(at, 1, "\r\n");
  for (char& c : old_mac) c = c == '\n' ? '\r' : c;
  CHECK(volume(parse_stl(windows, "w.stl")) == Approx(6.0));
  CHECK(volume(parse_stl(old_mac, "m.stl")) == Approx(6.0));
  CHECK(volume(parse_stl(ascii_stl(box) + ascii_stl(box.moved({5, 0, 0})), "two.stl")) == Approx(12.0));
  std::string solid = binary_stl(box);
  solid.replace(0, 11, "solid model");  // many programs write this into a binary file
  CHECK(volume(parse_stl(solid, "s.stl")) == Approx(6.0));
  CHECK(volume(parse_stl(binary_stl(box) + "trailing bytes", "t.stl")) == Approx(6.0));
  const std::string quads =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv +1 1e0 1 0.5\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8 # top\nf 1 2 6 5\nf 2 3 7 \\\n 6\nf 3 4 8 7\nf -5 -8 -4 -1\n";
  CHECK(volume(parse_obj(quads, "q.obj")) == Approx(1.0));
  // An arrow head (its third corner points inwards) is refused, a corner in the middle of a side is not.
  const std::string arrow = "v 0 0 0\nv 1 -1 0\nv 1.5 0 0\nv 1 1 0\nv 2 0 0\nv 1 0 0\n";
  CHECK_THAT(error_of([&] { (void)parse_obj(arrow + "f 2 5 4 3\n", "a.obj"); }),
             ContainsSubstring("'a.obj', line 7") && ContainsSubstring("4 corners is not convex"));
  CHECK(parse_obj(arrow + "f 1 6 5 4\n", "a.obj").triangles.size() == 2);
}

TEST_CASE("an ascii STL file may be in capitals and begin with a byte order mark") {
  std::string text = ascii_stl(mesh::box({1, 1, 1}));
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  CHECK(parse_stl(text, "LOUD.STL").triangles.size() == 12);
  CHECK(parse_stl("\xEF\xBB\xBF" + ascii_stl(mesh::box({1, 1, 1})), "marked.stl").triangles.size() == 12);
  IndexedMesh huge = mesh::box({1, 1, 1}).scaled(1e39);
  CHECK_THAT(error_of([&] { dem::io::write_stl("huge.stl", huge); }), ContainsSubstring("3.4e38"));
}

TEST_CASE("what is wrong with a file is said with its place and what to change") {
  const IndexedMesh box = mesh::box({1, 1, 1});
  const auto stl = [](const std::string& text) { return error_of([&] { (void)parse_stl(text, "part.stl"); }); };
  const auto wavefront = [](const std::string& text) { return error_of([&] { (void)parse_obj(text, "part.obj"); }); };
  std::string text = ascii_stl(box);
  text.replace(text.find("vertex"), 6, "vortex");
  CHECK_THAT(stl(text), ContainsSubstring("'part.stl', line 4") && ContainsSubstring("'vortex'"));
  text = ascii_stl(box);
  text.replace(text.find("vertex -0.5"), 11, "vertex nan ");
  CHECK_THAT(stl(text), ContainsSubstring("line 4") && ContainsSubstring("finite number"));
  CHECK_THAT(stl(ascii_stl(box).substr(0, 300)), ContainsSubstring("'part.stl', line "));
  CHECK_THAT(stl(binary_stl(box).substr(0, 500)), ContainsSubstring("12 triangles") && ContainsSubstring("byte 500"));
  std::string infinite = binary_stl(box);
  infinite.replace(84 + 12, 4, std::string("\x00\x00\x80\x7f", 4));
  CHECK_THAT(stl(infinite), ContainsSubstring("byte 96") && ContainsSubstring("triangle 0"));
  CHECK_THAT(stl(""), ContainsSubstring("0 bytes"));
  CHECK_THAT(stl("solid empty\nendsolid empty\n"), ContainsSubstring("no facets"));
  CHECK_THAT(wavefront("v 0 0\nf 1 1 1\n"), ContainsSubstring("line 1") && ContainsSubstring("coordinate"));
  CHECK_THAT(wavefront("v 0 0 0\nv 1 0 0\n\nf 1 2 3\n"),
             ContainsSubstring("line 4") && ContainsSubstring("vertex '3'"));
  CHECK_THAT(wavefront("v 0 0 0\nf 1 0 1\n"), ContainsSubstring("line 2"));
  CHECK_THAT(wavefront("v 0 0 0\nf 1 \\\n 1 \\\r\n 1\nf 1 0 1\n"), ContainsSubstring("line 5"));
  CHECK_THAT(wavefront("v 0 0 0\nf 1 1\n"), ContainsSubstring("2 corners"));
  CHECK_THAT(wavefront("v 0 0 0\n"), ContainsSubstring("no faces"));
  CHECK_THAT(error_of([] { (void)dem::io::read_stl("/nowhere/part.stl"); }), ContainsSubstring("/nowhere/part.stl"));
}

TEST_CASE("no file, however broken, does more than be read or be refused") {
  const IndexedMesh box = mesh::box({1, 2, 3});
  const std::vector<std::string> seeds = {ascii_stl(box), binary_stl(box), obj(box)};
  std::mt19937 engine(3);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(engine()) % n; };
  int read = 0, refused = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    std::string text = seeds[below(seeds.size())];
    for (std::size_t k = below(6) + 1; k > 0; --k) {
      switch (below(5)) {
        case 0: text[below(text.size())] = static_cast<char>(engine()); break;
        case 1: text.resize(below(text.size()) + 1); break;
        case 2: text.erase(below(text.size()), below(20)); break;
        case 3: text.insert(below(text.size()), text.substr(below(text.size()), below(60))); break;
        default: text[below(text.size())] = "0123456789 -+.e\n\\/"[below(18)]; break;
      }
      if (text.empty()) text = "x";
    }
    for (const bool as_obj : {false, true}) {
      try {
        const IndexedMesh m = as_obj ? parse_obj(text, "fuzz") : parse_stl(text, "fuzz");
        check_indices(m);  // what was read makes sense
        ++read;
        // And a surface can be made of it and touched.
        const dem::surface::TriangleMesh sheet(m, {.side = dem::surface::MeshSide::two_sided, .point_spacing = 0.7});
        sheet.contacts({0.5, 0.4, 0.3}, 0.6, [](std::uint32_t, const dem::Vector3<double>& normal, double) {
          CHECK(std::abs(norm(normal) - 1.0) < 1e-9);
        });
      } catch (const dem::Error& error) {
        CHECK_THAT(error.what(), ContainsSubstring("fuzz") || ContainsSubstring("mesh"));
        ++refused;
      }
    }
  }
  CHECK(read > 300);
  CHECK(refused > 3000);
}

TEST_CASE("surfaces of all kinds are drawn where grains touch them") {
  using namespace dem::surface;
  // Every vertex that is drawn lies on the surface: its distance, as contacts() finds it, is 0.
  const auto check = [](const auto& surface, const dem::io::SurfaceMesh& drawn, double tolerance) {
    CHECK(drawn.triangles.size() + drawn.quads.size() > 5);
    for (const Vec3& v : drawn.vertices) {
      double nearest = 1e300;
      surface.contacts(dem::from_eigen(v), 0.05,
                       [&](std::uint32_t, const auto&, double gap) { nearest = std::min(nearest, std::abs(gap)); });
      if (nearest > tolerance) nearest = v.head(2).norm() < 1e-12 ? 0.0 : nearest;  // middles of ends are on no rim
      CHECK(nearest <= tolerance);
    }
  };
  check(Box({1, 2, 3}), dem::io::drawn(Box({1, 2, 3})), 1e-14);
  check(Sphere(0.7), dem::io::drawn(Sphere(0.7)), 1e-14);
  check(Sphere(0.7, Side::inside), dem::io::drawn(Sphere(0.7, Side::inside)), 1e-14);
  check(Cylinder(0.7, 2), dem::io::drawn(Cylinder(0.7, 2)), 1e-14);
  check(Cylinder::tube(0.5, 0.7, 2), dem::io::drawn(Cylinder::tube(0.5, 0.7, 2)), 1e-14);
  const Superquadric egg({1, 1.5, 2}, {4, 6, 2});
  check(egg, dem::io::drawn(egg), 1e-9);
  const TriangleMesh tyre(mesh::tyre(0.97, 0.254, 600));
  check(tyre, dem::io::drawn(tyre), 1e-14);

  const std::variant<Plane, Box, TriangleMesh> any = tyre;
  const dem::io::SurfaceMesh picture = dem::io::drawn(any);
  const TempFolder folder;
  dem::io::write_vtk_bodies(folder / "tyre.vtp", {{&picture}});
  CHECK_THAT(dem::io::read_file(folder / "tyre.vtp").substr(0, 400),
             ContainsSubstring(fmt::format("NumberOfPolys=\"{}\"", tyre.mesh().triangles.size())));
}

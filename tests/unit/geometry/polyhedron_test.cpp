#include "catch.hpp"
#include "core/error_of.hpp"
#include "random.hpp"

#include <dem/geometry/mesh/mesh_repair.hpp>
#include <dem/geometry/polyhedron/polyhedra.hpp>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::Mat3;
using dem::Vec3;
using namespace dem::shape;

namespace {

struct Counts {
  std::size_t corners, faces, edges;
  bool operator==(const Counts&) const = default;
};
Counts counts(const Polyhedron& p) { return {p.mesh().corners.size(), p.mesh().faces.size(), p.mesh().edges.size()}; }

const std::vector<Vec3> cube_corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
const std::vector<std::vector<int>> cube_faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

/// By how much the faces of a hull differ from its triangles and from flat convex polygons.
struct Flaws {
  double volume = 0.0;  ///< m^3, gained or lost
  double above = 0.0;   ///< m, of any corner above the plane of a face
  double beyond = 0.0;  ///< m, of a corner of a face beyond the line of one of its sides
  double bent = 0.0;    ///< m, of a corner of a face from its plane
};
Flaws flaws(const std::vector<Vec3>& points, const ConvexMesh& mesh) {
  std::vector<std::vector<int>> triangles;
  for (const auto& t : dem::convex_hull(points)) triangles.emplace_back(t.begin(), t.end());
  Flaws found = {std::abs(mesh.mass_properties().volume - dem::polyhedron_mass_properties(points, triangles).volume)};
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& face = mesh.faces[f];
    const Vec3& normal = mesh.normals[f];
    for (const Vec3& p : mesh.corners) found.above = std::max(found.above, normal.dot(p) - mesh.offsets[f]);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3 &tail = mesh.corners[std::size_t(face[k])],
                 &head = mesh.corners[std::size_t(face[(k + 1) % face.size()])];
      found.bent = std::max(found.bent, std::abs(normal.dot(tail) - mesh.offsets[f]));
      const Vec3 outward = (head - tail).cross(normal).normalized();
      for (const int other : face) {
        found.beyond = std::max(found.beyond, outward.dot(mesh.corners[std::size_t(other)] - tail));
      }
    }
  }
  return found;
}

}  // namespace

TEST_CASE("regular polyhedra have the known corners, faces, edges, volumes and inertias") {
  // Edge a on the circumscribed radius R, volume over a^3, and inertia over m a^2.
  struct Known {
    Polyhedron body;
    Counts counts;
    double edge, volume, inertia;
  };
  const double r = 1.7e-3, phi = std::numbers::phi;
  const Known known[] = {
      {cube(r), {8, 6, 12}, 2.0 * r, 1.0, 1.0 / 6.0},
      {tetrahedron(r), {4, 4, 6}, r * std::sqrt(8.0 / 3.0), 1.0 / (6.0 * std::sqrt(2.0)), 1.0 / 20.0},
      {octahedron(r), {6, 8, 12}, r * std::sqrt(2.0), std::sqrt(2.0) / 3.0, 1.0 / 10.0},
      {icosahedron(r),
       {12, 20, 30},
       r / std::sin(0.4 * std::numbers::pi),
       5.0 * (3.0 + std::sqrt(5.0)) / 12.0,
       phi * phi / 10.0},
      {dodecahedron(r),
       {20, 12, 30},
       2.0 * r / (std::sqrt(3.0) * phi),
       (15.0 + 7.0 * std::sqrt(5.0)) / 4.0,
       (39.0 * phi + 28.0) / 150.0}};
  for (const Known& k : known) {
    CHECK(counts(k.body) == k.counts);
    const double volume = k.volume * std::pow(k.edge, 3);
    CHECK(k.body.volume() == Approx(volume).epsilon(1e-12));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(k.body.unit_inertia()[axis] == Approx(k.inertia * volume * k.edge * k.edge).epsilon(1e-12));
    }
    CHECK(k.body.radius() == Approx(std::cbrt(0.75 * volume / std::numbers::pi)).epsilon(1e-12));
  }
  CHECK(tetrahedron(r).bounding_radius() == Approx(r).epsilon(1e-12));
  CHECK(cube(r).bounding_radius() == Approx(std::sqrt(3.0) * r).epsilon(1e-12));

  // A hexagonal prism: V = 3 sqrt(3)/2 R^2 h, about the axis 5 m R^2/12, across it half of that and m h^2/12.
  const Polyhedron p = prism(6, 2.0, 3.0);
  CHECK(counts(p) == Counts{12, 8, 18});
  CHECK(p.volume() == Approx(18.0 * std::sqrt(3.0)).epsilon(1e-12));
  CHECK(p.unit_inertia().maxCoeff() == Approx(p.volume() * 5.0 / 12.0 * 4.0).epsilon(1e-12));
  CHECK(p.unit_inertia().minCoeff() == Approx(p.volume() * (5.0 / 24.0 * 4.0 + 9.0 / 12.0)).epsilon(1e-12));
}

TEST_CASE("a polyhedron's frame sits in the centre of mass along the principal axes") {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(5, -6, 7);
  std::vector<Vec3> corners;
  for (const Vec3& p : cube_corners) corners.push_back(turn * p.cwiseProduct(Vec3(1, 2, 4)) + shift);
  const Polyhedron body(corners, cube_faces);
  CHECK((body.frame_centre() - (turn * Vec3(0.5, 1, 2) + shift)).norm() < 1e-12);
  Vec3 moments = body.unit_inertia();
  std::sort(moments.data(), moments.data() + 3);
  CHECK((moments - 8.0 / 12.0 * Vec3(5, 17, 20)).norm() < 1e-11);
  // Back in the frame they were given in, the corners are where they were.
  for (const Vec3& p : body.mesh().corners) {
    const Vec3 given = body.frame_rotation() * p + body.frame_centre();
    const bool known =
        std::any_of(corners.begin(), corners.end(), [&](const Vec3& q) { return (q - given).norm() < 1e-12; });
    CHECK(known);
  }
  CHECK(body.frame_rotation().determinant() == Approx(1.0));
  const auto again = body.mesh().mass_properties();
  CHECK(again.centre.norm() < 1e-12);
  CHECK((again.inertia - Mat3(body.unit_inertia().asDiagonal())).norm() < 1e-11);
}

TEST_CASE("rocks have the shape that was asked for, and seeds make them") {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Polyhedron r = rock({.length = 2e-3, .elongation = 0.7, .flatness = 0.5, .points = 20, .seed = seed});
    CHECK(r.mesh().corners.size() > 10);
    CHECK(r.mesh().corners.size() - r.mesh().edges.size() + r.mesh().faces.size() == 2);
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Vec3& p : r.mesh().corners) {
      const Vec3 given = r.frame_rotation() * p;
      low = low.cwiseMin(given);
      high = high.cwiseMax(given);
    }
    CHECK((high - low - 2e-3 * Vec3(1.0, 0.7, 0.35)).norm() < 1e-15);
  }
  CHECK(rock({.seed = 5}).volume() == rock({.seed = 5}).volume());
  CHECK(rock({.seed = 5}).volume() != rock({.seed = 6}).volume());
}

TEST_CASE("faces in one plane become one, and inward ones are turned round") {
  std::vector<std::vector<int>> triangles, inward = cube_faces;
  for (const auto& f : cube_faces) {
    triangles.push_back({f[0], f[1], f[2]});
    triangles.push_back({f[0], f[2], f[3]});
  }
  CHECK(counts(Polyhedron(cube_corners, triangles)) == Counts{8, 6, 12});
  for (auto& f : inward) std::reverse(f.begin(), f.end());
  CHECK(Polyhedron(cube_corners, inward).volume() == Approx(1.0).epsilon(1e-14));
}

TEST_CASE("corners that lie in a plane but for rounding make one face") {
  // A pyramid upside down on a pentagon of which a corner hangs a little low: it is near the planes of some triangles
  // of the pentagon, and not of others. Pentagon of 2.55 by the shoelace, height 1.
  const std::vector<Vec3> points = {{1, 0, 0},     {0.9, 0.25, 0},       {-1, 0.8, 0},
                                    {-1, -0.8, 0}, {0.6, -0.9, -4.2e-8}, {0, 0, -1}};
  const std::vector<std::vector<int>> faces = {{0, 1, 2, 3, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {4, 3, 5}, {0, 4, 5}};
  for (const Polyhedron& p : {Polyhedron(points), Polyhedron(points, faces)}) {
    CHECK(counts(p) == Counts{6, 6, 10});
    CHECK(p.volume() == Approx(0.85).epsilon(1e-7));
    std::vector<std::size_t> sizes;
    for (const auto& face : p.mesh().faces) sizes.push_back(face.size());
    std::sort(sizes.begin(), sizes.end());
    CHECK(sizes == std::vector<std::size_t>{3, 3, 3, 3, 3, 5});
  }
  // However low it hangs, the faces close: what is cut off or added is a sheet of the tolerance at the most.
  for (double depth = 1e-8; depth < 1e-3; depth *= 1.7) {
    auto lower = points;
    lower[4].z() = -depth;
    CAPTURE(depth);
    const ConvexMesh mesh = hull_mesh(lower);
    const double size = detail::size_of(lower);
    CHECK(mesh.corners.size() + mesh.faces.size() == mesh.edges.size() + 2);
    CHECK(mesh.faces.size() == (depth < 1e-6 * size ? 6 : 7));
    const Flaws found = flaws(lower, mesh);
    CHECK(found.volume < 1e-6 * size * 2.55);
    CHECK(std::max({found.above, found.bent, found.beyond}) < 1e-6 * size);
  }
}

TEST_CASE("cubes whose corners were rounded to single precision keep their six faces") {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    CAPTURE(trial);
    const Mat3 turn = random.rotation();
    const Vec3 shift = random.vector(trial % 2 == 0 ? 0.0 : 3.0);
    std::vector<Vec3> corners;
    for (const Vec3& p : cube_corners) corners.push_back((turn * p + shift).cast<float>().cast<double>());
    // Three vertices for each triangle, as an STL file has them.
    dem::IndexedMesh file;
    for (const auto& f : cube_faces) {
      for (const std::size_t k : {0, 1, 2, 0, 2, 3}) file.vertices.push_back(corners[std::size_t(f[k])]);
    }
    for (std::uint32_t k = 0; k < file.vertices.size(); k += 3) file.triangles.push_back({k, k + 1, k + 2});
    const dem::IndexedMesh shared = dem::repaired(file).mesh;
    std::vector<std::vector<int>> triangles;
    for (const auto& t : shared.triangles) triangles.emplace_back(t.begin(), t.end());
    for (const Polyhedron& p :
         {Polyhedron(corners), Polyhedron(file.vertices), Polyhedron(shared.vertices, triangles)}) {
      CHECK(counts(p) == Counts{8, 6, 12});
      CHECK(p.volume() == Approx(1.0).epsilon(3e-6));
      for (const auto& face : p.mesh().faces) CHECK(face.size() == 4);
      for (const double share : p.tables().corner_share) CHECK(share == 0.25);  // lies flat with all of its stiffness
    }
  }
}

TEST_CASE("cubes of a finer mesh, rounded or shaken by less than the tolerance, keep eight corners") {
  Random random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const int n = 2 + trial % 5;  // parts of an edge
    CAPTURE(trial, n);
    const Mat3 turn = random.rotation();
    std::vector<Vec3> points;
    for (int k = 0; k < (n + 1) * (n + 1) * (n + 1); ++k) {
      const Vec3 cell(k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1) / (n + 1));
      const bool inside = cell.minCoeff() > 0 && cell.maxCoeff() < n;
      if (inside) continue;
      const Vec3 p = turn * cell / n;
      points.push_back(trial % 2 == 0 ? Vec3(p.cast<float>().cast<double>()) : Vec3(p + random.vector(1e-8)));
    }
    const ConvexMesh mesh = hull_mesh(points);
    CHECK(mesh.corners.size() == 8);
    CHECK(mesh.faces.size() == 6);
    CHECK(mesh.mass_properties().volume == Approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("the faces of a body with a gently domed top close, whether they count as flat or not") {
  // Rings of corners on a paraboloid: slopes below, about and above what the tolerance takes for flat.
  Random random(7);
  std::vector<std::size_t> faces;
  for (double rise = 2e-7; rise < 1e-3; rise *= 1.4) {
    CAPTURE(rise);
    const Mat3 turn = random.rotation();
    std::vector<Vec3> points;
    for (const int ring : {1, 2, 3}) {
      for (int k = 0; k < 6; ++k) {
        const double angle = std::numbers::pi / 3.0 * k + 0.3 * ring;
        points.push_back(turn * Vec3(ring * std::cos(angle), ring * std::sin(angle), -rise * ring * ring));
      }
    }
    points.push_back(turn * Vec3(0, 0, -1));
    const ConvexMesh mesh = hull_mesh(points);
    const double size = detail::size_of(points);
    CHECK(mesh.corners.size() + mesh.faces.size() == mesh.edges.size() + 2);
    const Flaws found = flaws(points, mesh);
    CHECK(found.volume < 1e-6 * size * 9.0 * std::numbers::pi);
    // The plane of a face is the mean of its corners, which are within the tolerance of the first triangle's.
    CHECK(std::max(found.above, found.bent) < 2e-6 * size);
    CHECK(found.beyond < 1e-6 * size);
    faces.push_back(mesh.faces.size());
  }
  CHECK(faces.front() == 7);      // a pyramid on a hexagon
  CHECK(faces.back() == 6 + 25);  // a hexagon, and two belts of twelve triangles
}

TEST_CASE("what is no convex body is refused in words") {
  const auto refusal = [](std::vector<Vec3> corners, std::vector<std::vector<int>> faces) {
    return message_of([&] { Polyhedron(corners, faces); });
  };
  auto faces = cube_faces;
  faces.pop_back();
  CHECK_THAT(refusal(cube_corners, faces), ContainsSubstring("is open: the edge from corner"));
  faces = cube_faces;
  std::reverse(faces[2].begin(), faces[2].end());
  CHECK_THAT(refusal(cube_corners, faces), ContainsSubstring("turn one of them round"));
  faces = cube_faces;
  faces[2][1] = 8;
  CHECK_THAT(refusal(cube_corners, faces), ContainsSubstring("names corner 8, but there are 8"));

  // A tent pushed in by 0.2 on top: its roof's corner stands above the planes of the other roof faces.
  auto corners = cube_corners;
  corners.push_back({0.5, 0.5, 0.8});
  faces = cube_faces;
  faces[1] = {4, 5, 8};
  faces.insert(faces.end(), {{5, 7, 8}, {7, 6, 8}, {6, 4, 8}});
  CHECK_THAT(refusal(corners, faces), ContainsSubstring("not convex") && ContainsSubstring("0.371 m above"));
  corners[8].z() = 1.2;  // a tent that stands is convex
  CHECK(counts(Polyhedron(corners, faces)) == Counts{9, 9, 16});

  corners = cube_corners;
  corners.push_back(corners[3] + Vec3::Constant(1e-12));
  CHECK_THAT(refusal(corners, cube_faces), ContainsSubstring("corners 3 and 8"));
  corners = cube_corners;
  for (Vec3& p : corners) p.z() *= 1e-12;
  CHECK_THAT(refusal(corners, cube_faces), ContainsSubstring("m apart") || ContainsSubstring("flat"));
  for (std::size_t k = 0; k < 8; ++k) corners[k].z() = cube_corners[k].z() * 1e-8;
  corners[7] += Vec3(1e-7, 0, 0);
  CHECK_THAT(refusal(corners, cube_faces), ContainsSubstring("flat") || ContainsSubstring("one plane"));

  CHECK_THAT(message_of([] { prism(40, 1.0, 1.0); }), ContainsSubstring("sides of a prism is 40"));
  CHECK_THAT(message_of([] { box({1.0, -1.0, 1.0}); }), ContainsSubstring("edge length of a box is -1"));
  CHECK_THAT(message_of([] { rock({.flatness = 2.0}); }), ContainsSubstring("flatness"));
  CHECK_THAT(message_of([] {
               std::vector<Vec3> many;
               for (int k = 0; k < 100; ++k) many.emplace_back(std::cos(0.0628 * k), std::sin(0.0628 * k), k % 2);
               Polyhedron p(many);
             }),
             ContainsSubstring("100 corners"));
}

TEST_CASE("what a polyhedron shows to surfaces are its corners, with shares that make one for each face") {
  const Mat3 turn = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 1, 3).normalized()).toRotationMatrix();
  for (const Polyhedron& body : {cube(1.0), tetrahedron(1.0), octahedron(1.0), icosahedron(1.0), dodecahedron(1.0)}) {
    double pose[Polyhedron::pose_size];
    body.orient(dem::from_eigen(turn), pose);
    std::vector<double> share;
    body.sample_points(pose, [&](std::uint32_t index, const dem::contact::SamplePoint& sample) {
      CHECK(index == share.size());
      CHECK(sample.radius == 0.0);
      CHECK((to_eigen(sample.centre) - turn * body.mesh().corners[index]).norm() < 1e-14);
      share.push_back(sample.weight);
    });
    REQUIRE(share.size() == body.mesh().corners.size());
    for (const auto& face : body.mesh().faces) {
      double sum = 0.0;
      for (const int k : face) sum += share[static_cast<std::size_t>(k)];
      CHECK(sum == Approx(1.0).epsilon(1e-12));
    }
  }
}

TEST_CASE("penetration tells how deep a point is, and which way is out") {
  const Polyhedron body = box({2.0, 4.0, 6.0});
  const Mat3 turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(3, 1, -1).normalized()).toRotationMatrix();
  double pose[Polyhedron::pose_size];
  body.orient(dem::from_eigen(turn), pose);
  double depth = -1.0;
  dem::Vector3<double> out;
  const auto ask = [&](const Vec3& p) { return body.penetration(pose, dem::from_eigen(Vec3(turn * p)), depth, out); };
  REQUIRE(ask({0.9, 0, 0}));
  CHECK(depth == Approx(0.1));
  CHECK((to_eigen(out) - turn * Vec3(1, 0, 0)).norm() < 1e-14);
  REQUIRE(ask({0.2, -1.7, 2.0}));
  CHECK(depth == Approx(0.3));
  CHECK((to_eigen(out) - turn * Vec3(0, -1, 0)).norm() < 1e-14);
  CHECK_FALSE(ask({0.9, 0, 3.001}));
  CHECK_FALSE(ask({-1.1, 0, 0}));
}

#include "catch.hpp"

#include <dem/soil/bulk_density.hpp>
#include <dem/soil/lattice.hpp>
#include <dem/soil/packing_file.hpp>
#include <dem/soil/relative_density.hpp>
#include <dem/soil/rest.hpp>

#include <filesystem>

#include <unistd.h>

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using namespace dem::soil;
using dem::Mat3;
using dem::Vec3;

namespace {

/// A file that is gone at the end of the test.
struct Scratch {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("dem_packing_test_" + std::to_string(::getpid()) + ".txt");
  ~Scratch() { std::filesystem::remove(path); }
};

/// Smallest distance between two centres.
double closest(const std::vector<Placement>& grains) {
  double least = 1e300;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) least = std::min(least, (grains[i].position - grains[j].position).norm());
  }
  return least;
}

bool inside(const std::vector<Placement>& grains, double lx, double ly, double reach) {
  for (const auto& g : grains) {
    if (std::abs(g.position.x()) > 0.5 * lx - reach || std::abs(g.position.y()) > 0.5 * ly - reach) return false;
    if (g.position.z() < reach) return false;
  }
  return true;
}

bool is_rotation(const Mat3& r) {
  return (r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff() < 1e-12 && r.determinant() > 0.0;
}

}  // namespace

TEST_CASE("a random lattice touches neither itself nor the walls, and follows its seed") {
  const double h = 1e-3, radius = cube_bounding_radius(h);
  const auto grains = random_lattice(300, h, 0.03, 0.02, 7);
  REQUIRE(grains.size() == 300);
  CHECK(closest(grains) > 2.0 * radius);
  CHECK(inside(grains, 0.03, 0.02, radius));
  for (const auto& g : grains) CHECK(is_rotation(g.rotation));
  const auto again = random_lattice(300, h, 0.03, 0.02, 7), other = random_lattice(300, h, 0.03, 0.02, 8);
  CHECK(again[123].position == grains[123].position);
  CHECK(again[123].rotation == grains[123].rotation);
  CHECK(other[123].rotation != grains[123].rotation);
  CHECK_THROWS_WITH(random_lattice(3, 0.02, 0.03, 0.02, 1), ContainsSubstring("lower the half-edge"));
}

TEST_CASE("random rotations are even: no direction is preferred") {
  std::mt19937_64 random(1);
  Mat3 mean = Mat3::Zero(), square = Mat3::Zero();
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Mat3 r = random_rotation(random);
    mean += r / n;
    square += r.cwiseProduct(r) / n;
  }
  CHECK(mean.cwiseAbs().maxCoeff() < 0.02);
  CHECK((square - Mat3::Constant(1.0 / 3.0)).cwiseAbs().maxCoeff() < 0.01);
}

TEST_CASE("a tilted block is regular, tilted, and fits") {
  const double h = 1e-3, tilt = 0.2;
  const auto grains = tilted_block(1000, h, 0.04, 0.04, tilt);
  REQUIRE(grains.size() == 1000);
  CHECK(closest(grains) == Approx(2.04 * h));
  CHECK(inside(grains, 0.04, 0.04, h));
  CHECK(is_rotation(grains[0].rotation));
  CHECK(grains[0].rotation == grains[999].rotation);
  CHECK(std::acos(grains[0].rotation(2, 2)) > tilt);
  CHECK_THROWS_WITH(tilted_block(100000, h, 0.01, 0.01, tilt), ContainsSubstring("fits nowhere"));
}

TEST_CASE("the solid fraction of cubes that fill space is one, turned or cut as they may be") {
  std::vector<Placement> grains;
  const Mat3 turn = Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      for (int k = -8; k <= 8; ++k) grains.push_back({turn * Vec3(2.0 * i, 2.0 * j, 2.0 * k), turn});
    }
  }
  CHECK(solid_fraction(grains, 1.0, {Vec3(-5.3, -4.1, -6.0), Vec3(4.4, 5.7, 3.3)}) == Approx(1.0).margin(0.005));
  // Half of the space: cubes of half-edge 2^(-1/3).
  CHECK(solid_fraction(grains, std::cbrt(0.5), {Vec3(-6, -6, -6), Vec3(6, 6, 6)}) == Approx(0.5).margin(0.01));
  CHECK_THROWS_WITH(solid_fraction(grains, 1.0, {Vec3(0, 0, 0), Vec3(1, 1, -1)}), ContainsSubstring("too small"));
}

TEST_CASE("a single cube counts with what lies inside") {
  const std::vector<Placement> one(1);
  CHECK(solid_fraction(one, 0.5, {Vec3(-2, -2, -2), Vec3(2, 2, 2)}) == Approx(1.0 / 64.0));
  CHECK(solid_fraction(one, 0.5, {Vec3(0, -2, -2), Vec3(2, 2, 2)}) == Approx(0.5 / 32.0));
  CHECK(solid_fraction(one, 0.5, {Vec3(3, 3, 3), Vec3(4, 4, 4)}) == 0.0);
}

TEST_CASE("percentiles and the inner region") {
  std::vector<Placement> grains(11);
  for (int i = 0; i <= 10; ++i) grains[static_cast<std::size_t>(i)].position.z() = 10.0 - i;
  CHECK(height_percentile(grains, 0.9) == 9.0);
  CHECK(height_percentile(grains, 0.0) == 0.0);
  CHECK_THROWS_WITH(height_percentile({}, 0.5), ContainsSubstring("no grains"));
  const Region free = inner_region(grains, 20.0, 10.0, 1.0), under_lid = inner_region(grains, 20.0, 10.0, 1.0, 12.0);
  CHECK(free.low == Vec3(-9, -4, 1));
  CHECK(free.high == Vec3(9, 4, 8));
  CHECK(under_lid.high.z() == 11.0);
  CHECK_FALSE(free.is_empty());
  CHECK(inner_region(grains, 20.0, 10.0, 4.5).is_empty());        // 9 high
  CHECK(inner_region(grains, 20.0, 10.0, 5.0, 99.0).is_empty());  // 10 wide
  CHECK(inner_region(grains, 2.0, 2.0, 3.0, 99.0).is_empty());    // though the product of its edges is positive
  for (int k = 0; k < 3; ++k) {
    Region r = {Vec3(0, 0, 0), Vec3(1, 1, 1)};
    r.high[k] = std::nan("");
    CHECK(r.is_empty());
    r.high[k] = HUGE_VAL;
    CHECK_THROWS_WITH(solid_fraction(grains, 0.1, r), ContainsSubstring("volume of the region to measure in is inf"));
  }
  grains[4].position.z() = std::nan("");
  CHECK_THROWS_WITH(height_percentile(grains, 0.5), ContainsSubstring("grain 4 of a packing is at the height nan m"));
  CHECK_THROWS_WITH(strike_off(grains, 0.5), ContainsSubstring("grain 4 of a packing is at the height nan m"));
}

TEST_CASE("a straight edge takes the highest grains off, and leaves the others as they are") {
  std::vector<Placement> grains;
  for (const double z : {3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0, 5.0, 3.0}) grains.push_back({{0.1 * z, 0, z}});
  const auto heights = [&](double share) {
    auto left = grains;
    strike_off(left, share);
    std::vector<double> z;
    for (const auto& g : left) z.push_back(g.position.z());
    return z;
  };
  CHECK(heights(0.0).size() == 10);
  CHECK(heights(0.099).size() == 10);  // less than one grain
  CHECK(heights(0.2) == std::vector<double>{3, 1, 4, 1, 5, 2, 5, 3});
  CHECK(heights(0.3) == std::vector<double>{3, 1, 4, 1, 5, 2, 3});  // of equal ones the later
  CHECK(heights(1.0).empty());
  CHECK_THROWS_WITH(heights(-0.1), ContainsSubstring("strike off"));
}

TEST_CASE("boxes as large as one likes are filled, and absurd numbers refused") {
  for (const double length : {1e3, 1e9, 1e15, 1e300}) {
    const auto cloud = random_lattice(100, 1e-3, length, length, 1);
    REQUIRE(cloud.size() == 100);
    CHECK(closest(cloud) > 2.0 * cube_bounding_radius(1e-3) - 1e-15 * length);  // as far as the doubles there go
    const auto block = tilted_block(100, 1e-3, length, length, 0.1);
    REQUIRE(block.size() == 100);
    CHECK(closest(block) == Approx(2.04e-3).epsilon(1e-9));
    // One layer of ten by ten, about the middle of the box: 11 mm from its middle to an edge, with the tilt.
    for (const Placement& g : block) CHECK(g.position.norm() < 0.02);
  }
  CHECK(tilted_block(30, 1e-15, 1.0, 1.0, 0.1).size() == 30);
  CHECK(random_lattice(30, 1e-15, 1.0, 1.0, 1).size() == 30);
  for (const double wrong : {std::nan(""), HUGE_VAL, -1.0, 0.0}) {
    CHECK_THROWS_WITH(random_lattice(9, 1e-3, wrong, 1.0, 1), ContainsSubstring("length of a box along x"));
    CHECK_THROWS_WITH(tilted_block(9, 1e-3, 1.0, wrong, 0.1), ContainsSubstring("length of a box along y"));
  }
  CHECK_THROWS_WITH(random_lattice(9, 1e-3, 1.0, 1.0, 1, 0.05, std::nan("")), ContainsSubstring("bounding radius"));
  for (const std::size_t count : {std::size_t{100'000'001}, ~std::size_t{0}}) {
    CHECK_THROWS_WITH(random_lattice(count, 1e-3, 1.0, 1.0, 1), ContainsSubstring("at most 100000000"));
    CHECK_THROWS_WITH(tilted_block(count, 1e-3, 1.0, 1.0, 0.1), ContainsSubstring("at most 100000000"));
  }
}

TEST_CASE("relative density goes by void ratios") {
  const DensityLimits limits = {0.5, 0.8};  // e = 1 and 0.25
  CHECK(relative_density(0.5, limits) == Approx(0.0).margin(1e-15));
  CHECK(relative_density(0.8, limits) == Approx(1.0));
  CHECK(relative_density(1.0 / 1.625, limits) == Approx(0.5));
  CHECK(relative_density(0.4, limits) < 0.0);
  for (const double d : {0.0, 0.3, 1.0})
    CHECK(relative_density(solid_fraction_at(d, limits), limits) == Approx(d).margin(1e-14));
}

TEST_CASE("a packing file reads back as the same packing") {
  const Scratch file;
  Packing p{0.9e-3, 0.06, 0.05, "poured,\nfriction 0.4", random_lattice(50, 0.9e-3, 0.06, 0.05, 3)};
  p.shape = "polyhedron";
  save_packing(p, file.path);
  const Packing back = load_packing(file.path);
  CHECK(back.half_edge == p.half_edge);
  CHECK(back.shape == "polyhedron");
  CHECK(back.length_x == 0.06);
  CHECK(back.length_y == 0.05);
  CHECK(back.note == "poured, friction 0.4");
  REQUIRE(back.grains.size() == 50);
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK(back.grains[i].position == p.grains[i].position);
    CHECK((back.grains[i].rotation - p.grains[i].rotation).cwiseAbs().maxCoeff() < 1e-15);
  }
}

TEST_CASE("the note of a packing may be empty, and lines may end as on other systems") {
  const Scratch file;
  save_packing({0.9e-3, 0.06, 0.05, "", random_lattice(3, 0.9e-3, 0.06, 0.05, 3)}, file.path);
  CHECK(load_packing(file.path).note.empty());
  CHECK(load_packing(file.path).grains.size() == 3);
  dem::io::write_file(file.path, "dem-packing 1\r\nhalf_edge 1\r\nbox 9 9\r\nnote a b\r\ngrains 0\r\n");
  CHECK(load_packing(file.path).note == "a b");
}

TEST_CASE("what is no packing is refused in words") {
  const Scratch file;
  const auto reading = [&](const std::string& text) {
    dem::io::write_file(file.path, text);
    return load_packing(file.path);
  };
  CHECK(reading("dem-packing 1\nhalf_edge 1\nbox 9 9\nnote n\ngrains 0\n").shape == "cube8");  // older files
  CHECK_THROWS_WITH(reading("dem-packing 1\nshape egg\nbox 9 9\n"), ContainsSubstring("'half_edge' is missing"));
  const std::string head = "dem-packing 1\nhalf_edge 1\nbox 9 9\nnote n\n";
  CHECK_THROWS_WITH(reading("solid sand\n"), ContainsSubstring("'dem-packing' is missing"));
  CHECK_THROWS_WITH(reading("dem-packing 2\n"), ContainsSubstring("version is 2"));
  CHECK_THROWS_WITH(reading("dem-packing 1\nhalf_edge -1\nbox 9 9\nnote n\ngrains 0\n"),
                    ContainsSubstring("not positive"));
  CHECK_THROWS_WITH(reading(head + "grains 2\n0 0 0 1 0 0 0\n"), ContainsSubstring("ends at grain 1 of 2"));
  CHECK_THROWS_WITH(reading(head + "grains 1\n0 0 0 1 1 0 0\n"), ContainsSubstring("no unit quaternion"));
  CHECK_THROWS_WITH(reading(head + "grains 1\n0 0 0,5 1 0 0 0\n"),
                    ContainsSubstring("line 6: a number of a grain is '0,5', but must be a finite number"));
  CHECK_THROWS_WITH(reading(head + "grains 1\n0 0 nan 1 0 0 0\n"), ContainsSubstring("line 6"));
  CHECK_THROWS_WITH(reading(head + "grains 100000000\n"), ContainsSubstring("ends at grain 0 of 100000000"));
  CHECK_THROWS_WITH(reading(head + "grains -1\n"), ContainsSubstring("number of grains is missing"));
  CHECK_THROWS_WITH(load_packing(file.path.string() + ".none"), ContainsSubstring("cannot read"));
}

TEST_CASE("staying below a limit takes the whole time") {
  StaysBelow at_rest(1.0, 0.5);
  CHECK(!at_rest(0.0, 0.1));
  CHECK(!at_rest(0.4, 0.1));
  CHECK(!at_rest(0.45, 1.0));
  CHECK(!at_rest(0.5, 0.1));
  CHECK(!at_rest(0.9, 0.1));
  CHECK(at_rest(1.0, 0.1));
}

// What is not the state of this program is refused in words.

#include "io/comma_locale.hpp"
#include "scenes_to_save.hpp"

#include <dem/geometry/mesh/mesh_shapes.hpp>
#include <dem/geometry/shapes.hpp>

#include <chrono>
#include <fstream>
#include <thread>

namespace refused_test {

namespace {

using models::Balls;
using models::Cubes;

template <class Model>
Scene<Model> scene(const SceneOptions& o = {}, double mu = 0.4) {
  if constexpr (std::is_same_v<Model, Balls>) return Scene<Model>(o, sand<Model>(mu), {Sphere(1.2e-3), Sphere(1e-3)});
  else return Scene<Model>(o, sand<Model>(mu), {dem::shape::cube8(1e-3)});
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}
void write(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}
bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// What a program with grains of one shape is told of a state with grains of another.
template <class Shape>
std::string refusal_of(const Shape& saved, const Shape& ours) {
  const auto species_of = [](const Shape& shape) { return std::vector{dem::make_species(shape, 2650.0, false)}; };
  auto theirs = species_of(saved), mine = species_of(ours);
  dem::io::StateColumns columns;
  dem::io::Fields collect(dem::io::Fields::Task::collect, columns);
  collect.list("species", theirs, "species");
  dem::io::Fields compare(dem::io::Fields::Task::compare, columns);
  return error_of([&] { compare.list("species", mine, "species"); });
}

/// A shape of a user's own that tells nothing but what it must.
struct Pair : Sphere {
  double apart;
  Pair(double radius, double apart) : Sphere(radius), apart(apart) {}
  std::uint64_t fingerprint() const = delete;
  template <class Callback>
  void sample_points(const double*, Callback&& callback) const {
    for (const std::uint32_t k : {0u, 1u}) {
      callback(k, dem::contact::SamplePoint{{k * apart, 0, 0}, radius(), radius()});
    }
  }
};

}  // namespace

TEST_CASE("another shape with the same mass, moments and radius is named") {
  const std::string differs = "species 0: its shape in this program differs from that in the saved state";
  const auto check = [&](const auto& saved, const auto& ours) {
    CHECK(refusal_of(saved, saved) == "no error");
    CHECK(holds(refusal_of(saved, ours), differs));
  };
  using dem::shape::PointArea;
  using Points = dem::shape::SuperquadricPoints;
  const Vec3 radii(1e-3, 0.9e-3, 1.1e-3), exponents(8, 4, 3);
  check(Points(radii, exponents, 4), Points(radii, exponents, 6));
  check(Points(radii, exponents, 4), Points(radii, exponents, 4, PointArea::relative));
  check(dem::shape::Superquadric(radii, exponents, 4), dem::shape::Superquadric(radii, exponents, 5));

  // The same corners and faces under other numbers, which contacts are known by.
  const auto cube = dem::shape::cube(1e-3);
  auto renumbered = cube.mesh();
  std::reverse(renumbered.faces.begin(), renumbered.faces.end());
  CHECK(refusal_of(cube, dem::shape::cube(1e-3)) == "no error");
  CHECK(cube.fingerprint() != dem::shape::Polyhedron(renumbered.corners, renumbered.faces).fingerprint());

  // A ball less in the middle of a cluster, whose mass is given.
  std::vector<dem::Ball> balls;
  for (const double x : {-1e-3, 1e-3, 0.0}) balls.push_back({{x, 0, 0}, 1e-3});
  const dem::MassProperties mass = dem::box_mass_properties({4e-3, 2e-3, 2e-3});
  using Cluster = dem::shape::SphereCluster<3>;
  check(Cluster(balls, mass), Cluster(std::span(balls).first(2), mass));

  using Mixture = dem::shape::Mixed<Sphere, Points>;
  check(Mixture(Points(radii, exponents, 4)), Mixture(Points(radii, exponents, 6)));
  check(Pair(1e-3, 1e-4), Pair(1e-3, 2e-4));
}

TEST_CASE("a difference of the set-up is named") {
  const Folder folder;
  auto saved = scene<Balls>();
  saved.run(20);
  dem::save(saved.world, folder / "state.h5");
  const auto load_into = [&](auto other) {
    const auto before = dem::io::hash_of(dem::io::columns_of(other.world));
    const std::string text = error_of([&] { dem::load(other.world, folder / "state.h5"); });
    CHECK(dem::io::hash_of(dem::io::columns_of(other.world)) == before);  // it is left as it is
    INFO(text);
    CHECK(holds(text, "cannot load '"));
    return text;
  };
  CHECK(error_of([&] {
          auto same = scene<Balls>();
          dem::load(same.world, folder / "state.h5");
        }) == "no error");

  std::string text = load_into(scene<Balls>({}, 0.5));
  CHECK(holds(
      text, "contact of all other materials: friction.coefficient is 0.4 in the saved state, but 0.5 in this program"));
  text = load_into(scene<Balls>({.hinge_name = "knee"}));
  CHECK(holds(text, "name is 'hinge' in the saved state, but 'knee' in this program"));
  text = load_into(scene<Balls>({.hinge_stiffness = 1e4}));
  CHECK(holds(text, "joint 'hinge': stiffness"));
  text = load_into(scene<Balls>({.flap_density = 2000.0}));
  CHECK(holds(text, "body 'flap': mass is "));
  text = load_into(scene<Balls>({.spring_stiffness = 30.0}));
  CHECK(holds(text, "spring 'spring': "));
  text = load_into(scene<Balls>({.hinge_friction = 0.4}));
  CHECK(holds(text, "joint 'hinge': friction coefficient is 0.3 in the saved state, but 0.4 in this program"));
  text = load_into(scene<Balls>({.rubber = 90.0}));
  CHECK(holds(text, "joint 'rubber': "));
  text = load_into(scene<Balls>({.left_axle = Vec3(1e-4, 0, 0)}));
  CHECK(holds(text, "joint 'left axle': point on a is (0, -0.03, 0.03) m in the saved state, but (0.0001,"));
  text = load_into(scene<Balls>({.end_of_arm = Vec3(0, 0, 1e-4)}));
  CHECK(holds(text, "actuator 'arm': point on b is "));
  text = load_into(scene<Balls>({.end_of_spring = Vec3(0, 0, 1e-4)}));
  CHECK(holds(text, "spring 'spring': point on b is "));
  text = load_into(scene<Balls>({.has_block = false}));
  CHECK(holds(text, "('ground', "));
  CHECK(holds(text, "'plate', 'block'), but this program has 5"));

  auto skinned = scene<Balls>();
  skinned.world.add_surface(skinned.world.ground(), dem::surface::Plane{}, {.material = "steel"});
  text = load_into(std::move(skinned));
  CHECK(holds(text, "material: the saved state has 2 ('grain', 'wall'), but this program has 3"));
  auto grown = scene<Balls>();
  grown.world.add_species(Sphere(2e-3));
  text = load_into(std::move(grown));
  CHECK(holds(text, "species: the saved state has 2, but this program has 3"));
  text = load_into(scene<Cubes>());
  INFO(text);
  CHECK(holds(text, "shape is 'shape::Sphere' in the saved state, but 'shape::SphereCluster<8>' in this program"));
}

TEST_CASE("a motion that would jump after loading is refused, and one that goes on from the file's is not") {
  using namespace dem::mbd;
  const auto press = [](double ahead, bool by_pose) {  // a lid above a ball of 1 mm, which comes down at 0.1 m/s
    dem::World<Balls> w({.gravity = {0, 0, 0}, .time_step = 1e-5});
    w.set_contact(sand<Balls>());
    w.add_grain({w.add_species(Sphere(1e-3)), Vec3(0, 0, 0)});
    auto& m = w.machine();
    const dem::BodyId lid = m.add_fixed_body("lid", {0, 0, 0.01});
    w.add_surface(lid, dem::surface::Box({0.01, 0.01, 0.002}));
    if (by_pose) {
      m.add_motion(prescribed_pose("go", lid, [=](double t) {
        return Pose{.position = {0, 0, 0.01 - ahead - 0.1 * t}};
      }));
    } else {
      m.add_motion(prescribed_position("go", lid, Vec3::UnitZ(), Signal::ramp(-ahead, -0.1)));
    }
    return w;
  };
  const Folder folder;
  for (const bool by_pose : {false, true}) {
    auto saved = press(0.0, by_pose);
    REQUIRE(saved.run(100));
    dem::save(saved, folder / "state.h5");
    REQUIRE(saved.run(100));

    auto same = press(0.0, by_pose);
    dem::load(same, folder / "state.h5");
    REQUIRE(same.run(100));
    CHECK(dem::io::hash_of(dem::io::columns_of(same)) == dem::io::hash_of(dem::io::columns_of(saved)));

    auto near = press(5e-5, by_pose);  // within a tenth of the ball's radius
    dem::load(near, folder / "state.h5");
    CHECK(near.run(100));

    auto far = press(2e-4, by_pose);
    dem::load(far, folder / "state.h5");
    const std::string text = error_of([&] { (void)far.run(1); });
    CHECK(holds(text, "prescribed motion 'go' is 0.0002 m or rad off at t = 0.001 s"));
    CHECK(holds(text, "allowed is 0.0001"));
  }
}

TEST_CASE("a motion whose value was set for the next step goes on from a file, however far that is") {
  // A slide at 3 m/s goes 0.3 mm in a step, where a tenth of the grain's radius, 0.1 mm, is allowed for a jump.
  using namespace dem::mbd;
  const double dt = 1e-4, v = 3.0;
  const auto slide = [&] {
    dem::World<Balls> w({.gravity = {0, 0, 0}, .time_step = dt});
    w.set_contact({{100.0, 0.0, 1.0}, {0.0, 100.0, 0.0, 1.0}});
    w.add_grain({w.add_species(Sphere(1e-3)), Vec3(0, 0.1, 0)});
    auto& m = w.machine();
    const dem::BodyId cart = m.add_body(box_body("cart", {0.01, 0.01, 0.002}, 1000.0));
    w.add_surface(cart, dem::surface::Box({0.01, 0.01, 0.002}));
    m.add_motion(
        prescribed_joint("drive", m.add_joint(prismatic("rail", m.ground(), cart, {0, 0, 0}, {1, 0, 0})), 0.0));
    return w;
  };
  const auto set_next = [&](auto& w) { w.machine().set_motion(dem::MotionId{0}, v * w.time(), v); };
  const Folder folder;
  auto saved = slide();
  REQUIRE(saved.run(1));  // at rest, from where it takes hold
  for (int k = 0; k < 10; ++k) {
    set_next(saved);
    if (k == 5) dem::save(saved, folder / "state.h5");
    REQUIRE(saved.run(1));
  }
  auto same = slide();
  dem::load(same, folder / "state.h5");
  REQUIRE(same.run(1));
  for (int k = 6; k < 10; ++k) {
    set_next(same);
    REQUIRE(same.run(1));
  }
  CHECK(dem::io::hash_of(dem::io::columns_of(same)) == dem::io::hash_of(dem::io::columns_of(saved)));
}

TEST_CASE("another surface in the same bounding box is named") {
  namespace surface = dem::surface;
  const auto scene_with = [](const auto& geometry) {
    auto s = scene<Balls>();
    s.world.add_surface(s.world.ground(), geometry, {.name = "extra", .position = {1, 1, 1}});
    return s;
  };
  const auto check = [&](const auto& saved, const auto& ours) {
    auto first = scene_with(saved);
    first.run(20);
    auto columns = dem::io::columns_of(first.world);
    auto same = scene_with(saved), other = scene_with(ours);
    // A mesh that the first run makes deeper for points is still the same one.
    CHECK(error_of([&] { dem::io::restore(same.world, columns); }) == "no error");
    CHECK(difference(first.world, same.world) == "");
    CHECK(holds(error_of([&] { dem::io::restore(other.world, columns); }),
                "surface 'extra': its shape in this program differs from that in the saved state"));
  };
  check(surface::Cylinder::tube(5e-3, 1e-2, 2e-2), surface::Cylinder::tube(6e-3, 1e-2, 2e-2));
  check(surface::Box({1e-2, 1e-2, 1e-2}), surface::Box({1e-2, 1e-2, 1e-2}, 2));
  const auto drum = [](int pieces) {
    return surface::TriangleMesh(dem::mesh::box({4e-3, 4e-3, 4e-3}, pieces), {.facing = dem::MeshFacing::inward});
  };
  check(drum(4), drum(5));
  const auto sheet = [](int pieces) {
    return surface::TriangleMesh(dem::mesh::rectangle(4e-3, 4e-3, pieces, pieces),
                                 {.side = surface::MeshSide::one_sided});
  };
  check(sheet(20), sheet(21));
}

TEST_CASE("a file that is cut short, damaged, of another schema or none at all is refused in words") {
  const Folder folder;
  auto saved = scene<Balls>();
  saved.run(20);
  const auto path = folder / "state.h5", other = folder / "other.h5";
  dem::save(saved.world, path);
  const std::string good = bytes_of(path);
  REQUIRE(good.size() > 20000);
  const auto refusal = [&](const std::string& bytes) {
    write(other, bytes);
    return error_of([&] { (void)dem::io::read_columns(other); });
  };
  CHECK(refusal(good) == "no error");
  for (const double share : {0.99999, 0.9, 0.5, 0.1}) {
    CHECK(holds(refusal(good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size())))),
                "cut short"));
  }
  CHECK(holds(refusal(good.substr(0, 300)), "no saved state"));
  CHECK(holds(refusal(""), "no saved state"));
  CHECK(holds(refusal(std::string(10000, 'x')), "no saved state"));
  CHECK(holds(refusal(good + "x"), "damaged"));
  CHECK(holds(error_of([&] { (void)dem::io::read_columns(folder / "none.h5"); }), "there is no such file"));

  // One bit, anywhere.
  Random random(1);
  for (int k = 0; k < 400; ++k) {
    std::string bad = good;
    const auto at = static_cast<std::size_t>(random.between(0.0, 1.0) * static_cast<double>(good.size() - 1));
    bad[at] = static_cast<char>(bad[at] ^ (1 << k % 8));
    CAPTURE(at);
    CHECK(holds(refusal(bad), "cannot load '"));
  }

  // An older schema, and one to come.
  const std::string now = std::to_string(dem::io::checkpoint_schema);
  const auto schema = good.find("schema " + now);
  REQUIRE(schema != std::string::npos);
  for (const auto& then : {std::to_string(dem::io::checkpoint_schema - 1), std::string(now.size(), '9')}) {
    std::string another = good;
    another.replace(schema + 7, now.size(), then);
    CHECK(holds(refusal(another), "it is of schema " + then + ", but this version of dem reads schema " + now +
                                      "; use the version that saved it"));
  }
}

TEST_CASE("a file that cannot be written leaves the last one as it is") {
  const Folder folder;
  auto world = scene<Balls>();
  const auto path = folder / "state.h5";
  dem::save(world.world, path);
  const std::string good = bytes_of(path);
  std::filesystem::create_directory(folder / "state.h5.tmp");  // where the next one would be written first
  CHECK(holds(error_of([&] { dem::save(world.world, path); }), "cannot save '"));
  CHECK((bytes_of(path) == good));
  std::filesystem::remove(folder / "state.h5.tmp");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  dem::save(world.world, path);
  CHECK((bytes_of(path) == good));  // the same state is the same file, at whatever time
  CHECK(!std::filesystem::exists(folder / "state.h5.tmp"));
}

TEST_CASE("a state is saved and loaded alike under a locale with commas") {
  const Folder folder;
  auto world = scene<Balls>();
  dem::save(world.world, folder / "plain.h5");
  const CommaLocale commas;
  dem::save(world.world, folder / "commas.h5");
  CHECK((bytes_of(folder / "commas.h5") == bytes_of(folder / "plain.h5")));
  auto other = scene<Balls>();
  CHECK_NOTHROW(dem::load(other.world, folder / "plain.h5"));
}

}  // namespace refused_test

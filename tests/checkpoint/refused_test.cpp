// What is not the state of this program is refused in words.

#include "io/comma_locale.hpp"
#include "scenes_to_save.hpp"

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

}  // namespace

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
  CHECK(holds(text,
              "contact of all other materials: friction is (0.4, 2000, 0.015, 0.975) in the saved state, but (0.5,"));
  text = load_into(scene<Balls>({.hinge_name = "knee"}));
  CHECK(holds(text, "name is 'hinge' in the saved state, but 'knee' in this program"));
  text = load_into(scene<Balls>({.hinge_stiffness = 1e4}));
  CHECK(holds(text, "joint 'hinge': stiffness"));
  text = load_into(scene<Balls>({.flap_density = 2000.0}));
  CHECK(holds(text, "body 'flap': mass is "));
  text = load_into(scene<Balls>({.spring_stiffness = 30.0}));
  CHECK(holds(text, "spring 'spring': "));
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

  std::string older = good;
  const std::string now = std::to_string(dem::io::checkpoint_schema);
  const auto schema = older.find("schema " + now);
  REQUIRE(schema != std::string::npos);
  older[schema + 7] = '1';
  CHECK(holds(refusal(older), "it is of schema 1, but this version of dem reads schema " + now));
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

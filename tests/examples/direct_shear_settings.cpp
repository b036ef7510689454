#include "catch.hpp"

#include <dem/core/error.hpp>
#include <dem/io/file.hpp>
#include <direct_shear/settings.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

using Catch::Matchers::ContainsSubstring;
using direct_shear::Settings;

namespace {

/// A --config file that is gone at the end of the test.
struct ConfigFile {
  explicit ConfigFile(const std::string& text) { dem::io::write_file(path, text); }
  ~ConfigFile() { std::filesystem::remove(path); }
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("dem_settings_test_" + std::to_string(::getpid()) + ".toml");
};

struct Parsed {
  Settings settings;
  std::string config;
};

Parsed read(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "direct_shear");
  std::vector<char*> argv;
  for (auto& a : arguments) argv.push_back(a.data());
  Parsed p;
  // Not within REQUIRE, which would take the exceptions that tests expect.
  const bool run = direct_shear::read_settings(static_cast<int>(argv.size()), argv.data(), p.settings, p.config);
  REQUIRE(run);
  return p;
}

Parsed read_file(const std::string& text) {
  const ConfigFile file(text);
  return read({"--config", file.path.string()});
}

}  // namespace

TEST_CASE("settings.toml repeats the run") {
  const auto first =
      read({"--size", "smoke", "--no-vtk", "--loads", "6.2,16.2", "--stiffness", "2000", "--area-correction", "true",
            "--packing", "poured", "--seed", "7", "--output", "some where"});
  const auto again = read_file(first.config);
  CHECK(again.config == first.config);
  CHECK(again.settings.size == "smoke");
  CHECK_FALSE(again.settings.vtk);
  CHECK(again.settings.loads == std::vector<double>{6.2, 16.2});
  CHECK(again.settings.stiffness == 2000.0);
  CHECK(again.settings.area_correction);
  CHECK(again.settings.packing == "poured");
  CHECK(again.settings.seed == 7);
  CHECK(again.settings.output == "some where");
}

TEST_CASE("files for ParaView are written unless switched off, in whichever way") {
  CHECK(read({}).settings.vtk);
  CHECK(read({"--vtk"}).settings.vtk);
  CHECK(read_file(read({}).config).settings.vtk);
  CHECK_FALSE(read({"--no-vtk"}).settings.vtk);
  CHECK_FALSE(read({"--vtk=false"}).settings.vtk);
  CHECK_FALSE(read_file("vtk = false\n").settings.vtk);
  CHECK_FALSE(read_file("no-vtk = true\n").settings.vtk);
}

TEST_CASE("a --config file is understood as a whole or refused") {
  CHECK(read_file("# a comment\nfriction = 0.3\n").settings.friction == 0.3);
  CHECK_THROWS_WITH(read_file("frction = 0.3\n"), ContainsSubstring("'frction', but there is no such option"));
  CHECK_THROWS_WITH(read_file("[contacts]\nfriction = 0.3\n"), ContainsSubstring("a table [contacts]"));
  CHECK_THROWS_WITH(read_file("contacts.friction = 0.3\n"), ContainsSubstring("a table [contacts]"));
  CHECK_THROWS_WITH(read_file("friction = 0.3\nseed = 2\nfriction = 0.4\n"), ContainsSubstring("'friction' twice"));
  CHECK_THROWS_AS(read_file("friction = high\n"), dem::Error);
  CHECK_THROWS_AS(read({"--config", "/no/such/file.toml"}), dem::Error);
}

TEST_CASE("the command line outdoes the --config file") {
  const ConfigFile file("friction = 0.3\nseed = 2\n");
  const auto s = read({"--config", file.path.string(), "--friction", "0.5"}).settings;
  CHECK(s.friction == 0.5);
  CHECK(s.seed == 2);
}

TEST_CASE("what is left open follows the size") {
  const Settings s = read({"--size", "full"}).settings;
  CHECK(s.half_edge == 0.9e-3);
  CHECK(s.grains == 14256);
  CHECK(s.stable_share == 0.4);
  CHECK(read({"--size", "quick"}).settings.stable_share == 0.8);
  CHECK(read({"--size", "full", "--stable-share", "0.5"}).settings.stable_share == 0.5);
  CHECK_THROWS_WITH(read({"--stable-share", "1.5"}), ContainsSubstring("--stable-share"));
  CHECK(s.wall_thickness == 0.015);
  CHECK(s.wall_friction == s.friction);
  CHECK(s.loads == std::vector<double>{6.2, 16.2, 26.2});
  CHECK(direct_shear::contact_scale(s) == 1.0);
}

TEST_CASE("every option is checked by its own name") {
  const auto refused = [](const std::string& option, const std::string& value) {
    INFO(option << " " << value);
    CHECK_THROWS_WITH(read({option + "=" + value}), ContainsSubstring(option));
  };
  for (const char* positive :
       {"--half-edge", "--box-length", "--box-width", "--box-height", "--densify-time", "--settle-limit", "--stiffness",
        "--density", "--constants-for", "--lid-speed", "--rest-speed", "--consolidation-limit", "--shear-speed",
        "--overlap-limit", "--vtk-interval", "--wall-thickness", "--travel", "--shake-frequency", "--loads"}) {
    for (const char* value : {"-1", "nan", "inf"}) refused(positive, value);
  }
  for (const char* zero_is_no_default :
       {"--box-length", "--box-width", "--box-height", "--densify-time", "--settle-limit", "--stiffness", "--density",
        "--constants-for", "--lid-speed", "--rest-speed", "--consolidation-limit", "--overlap-limit",
        "--shake-frequency", "--loads"}) {
    refused(zero_is_no_default, "0");
  }
  for (const char* not_negative :
       {"--seam-height", "--lid-clearance", "--relative-density", "--tilt", "--shake-amplitude", "--shake-time",
        "--damping", "--separation-factor", "--friction", "--velocity-stiffness", "--breaking-factor", "--ramp-time",
        "--smoothing", "--residual-share", "--time-step"}) {
    for (const char* value : {"-1", "nan", "inf"}) refused(not_negative, value);
  }
  for (const char* automatic_if_negative : {"--wall-friction", "--friction-stiffness"}) {
    CHECK_NOTHROW(read({std::string(automatic_if_negative) + "=-1"}));
    for (const char* value : {"nan", "inf"}) refused(automatic_if_negative, value);
  }
  refused("--threads", "-1");
  refused("--grains", "-1");
}

TEST_CASE("options are checked against each other") {
  // The travel of --size quick is 6 mm, its box 50 mm high.
  CHECK_THROWS_WITH(read({"--smoothing=0.0031"}), ContainsSubstring("at most half the travel"));
  CHECK_THROWS_WITH(read({"--wall-thickness=0.0059"}), ContainsSubstring("from the travel up"));
  CHECK_THROWS_WITH(read({"--seam-height=0.05"}), ContainsSubstring("box height, 0.05 m"));
  CHECK_THROWS_WITH(read({"--ramp-time=0.31"}), ContainsSubstring("at most what the travel takes"));
  CHECK_THROWS_WITH(read({"--shape=superquadric", "--integrator=euler"}), ContainsSubstring("verlet only"));
}

TEST_CASE("loads must have names, and so files, of their own") {
  // 0.01 kg is 0.027 kPa, and both are 16.9 kPa.
  CHECK_THROWS_WITH(read({"--loads", "6.20,6.21"}), ContainsSubstring("both would be called load_16.9kPa"));
  CHECK_THROWS_WITH(read({"--loads", "16.2,16.2"}), ContainsSubstring("leave one out"));
  const Settings s = read({"--loads", "6.20,6.25"}).settings;
  CHECK(direct_shear::load_name(s, s.loads[0]) == "load_16.9kPa");
  CHECK(direct_shear::load_name(s, s.loads[1]) == "load_17.0kPa");
}

TEST_CASE("the area of the stresses shrinks with the displacement only when asked to") {
  Settings s = read({}).settings;
  CHECK(s.area(0.006) == s.area());
  s.area_correction = true;
  CHECK(s.area() == 0.06 * 0.06);
  CHECK(s.area(0.006) == Catch::Approx(0.9 * 0.06 * 0.06));
  CHECK(s.normal_stress(16.2, 0.006) == Catch::Approx(44145.0 / 0.9));
}

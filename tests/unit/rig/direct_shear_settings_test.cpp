#include "catch.hpp"

#include <dem/core/error.hpp>
#include <dem/io/file.hpp>
#include <dem/rig/command_line.hpp>
#include <dem/rig/direct_shear/list_settings.hpp>
#include <dem/rig/direct_shear/options.hpp>
#include <dem/rig/direct_shear/resolve.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

namespace direct_shear_settings_test {

using Catch::Approx;
using Catch::Matchers::ContainsSubstring;
using dem::rig::direct_shear::Settings;
namespace direct_shear = dem::rig::direct_shear;

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
  dem::rig::Options options;
  declare(options, p.settings);
  // Not within REQUIRE, which would take the exceptions that tests expect.
  const bool run = dem::rig::read_command_line({}, static_cast<int>(argv.size()), argv.data(), options);
  REQUIRE(run);
  dem::rig::IdleOptions idle;
  find_idle(idle, p.settings);
  refuse_idle(options, idle);
  p.config = settings_text(options, idle);
  resolve(p.settings);
  return p;
}

Parsed read_file(const std::string& text) {
  const ConfigFile file(text);
  return read({"--config", file.path.string()});
}

}  // namespace

TEST_CASE("settings.toml repeats the run") {
  const auto first = read({"--size", "smoke", "--no-vtk", "--loads", "6.2,16.2", "--stiffness", "2000",
                           "--area-correction", "true", "--seed", "7", "--output", "some where"});
  CHECK(first.settings.output == "some where");
  const auto again = read_file(first.config);
  CHECK(again.config == first.config);
  CHECK(again.settings.size == "smoke");
  CHECK_FALSE(again.settings.vtk);
  CHECK(again.settings.loads == std::vector<double>{6.2, 16.2});
  CHECK(again.settings.stiffness == 2000.0);
  CHECK(again.settings.area_correction);
  CHECK(again.settings.packing == "random");
  CHECK(again.settings.relative_density == 0.18);
  CHECK(again.settings.seed == 7);
  CHECK(again.settings.output == "some where");
}

TEST_CASE("settings.toml repeats a run in any folder, on any packing") {
  for (const char* path : {"a#b", "a\"b", "\"a", "it's", "'a'", "a\\b", "two\nlines", "a\tb", "x\x01y", "1e5", "true",
                           "[a,b]", "a, b", " a ", "ä", "o", "#", "a = b", "\r"}) {
    INFO(path);
    const auto first = read({std::string("--output=") + path, std::string("--packing-file=") + path + "/p.txt"});
    const auto again = read_file(first.config);
    CHECK(again.settings.output == path);
    CHECK(again.settings.packing_file == std::string(path) + "/p.txt");
    CHECK(again.config == first.config);
  }
}

TEST_CASE("settings.toml names every option that counts, and no other") {
  const auto holds = [](const Parsed& p, const std::string& name) {
    return ("\n" + p.config).find("\n" + name + "=") != std::string::npos;
  };
  const Parsed random = read({}), poured = read({"--packing", "poured"}), from_file = read({"--packing-file", "p.txt"});
  for (const char* name : {"stiffness", "breaking-factor", "travel", "stable-share", "vtk", "area-correction"}) {
    INFO(name);
    CHECK(holds(random, name));
    CHECK(holds(from_file, name));
  }
  CHECK(holds(random, "seed"));
  CHECK(holds(random, "relative-density"));
  CHECK_FALSE(holds(random, "shake-time"));
  CHECK_FALSE(holds(poured, "seed"));
  CHECK(holds(poured, "shake-time"));
  CHECK_FALSE(holds(from_file, "seed"));
  CHECK_FALSE(holds(from_file, "relative-density"));
  CHECK_FALSE(holds(read({"--time-step", "1e-6"}), "stable-share"));
  CHECK(read_file(poured.config).config == poured.config);
  CHECK(read_file(from_file.config).config == from_file.config);
}

TEST_CASE("an option that would do nothing is refused, on the command line and in a file") {
  using Words = std::vector<std::string>;
  const auto refused = [](const Words& others, const Words& options, const std::string& value) {
    for (const std::string& option : options) {
      INFO(option << " " << value);
      const auto words = ContainsSubstring(option + " is " + value + ", but counts only with");
      Words all = others;
      all.push_back(option + "=" + value);
      CHECK_THROWS_WITH(read(all), words);
      const ConfigFile file(option.substr(2) + " = " + value + "\n");
      all.back() = "--config=" + file.path.string();
      CHECK_THROWS_WITH(read(all), words);
    }
  };
  refused({"--packing-file=p.txt"},
          {"--grains", "--relative-density", "--tilt", "--shake-amplitude", "--shake-frequency", "--shake-time",
           "--densify-time", "--settle-limit", "--seed", "--save-packing"},
          "5");
  refused({"--packing-file=p.txt"}, {"--packing"}, "poured");
  refused({"--packing=poured"}, {"--relative-density", "--densify-time", "--seed"}, "5");
  refused({}, {"--tilt", "--shake-time"}, "5");
  refused({"--relative-density=0"}, {"--densify-time", "--shake-amplitude", "--shake-frequency"}, "5");
  refused({"--packing-only"}, {"--loads", "--lid-speed", "--shear-speed", "--travel", "--smoothing", "--vtk-interval"},
          "5");
  refused({"--packing-only"}, {"--replay-forces"}, "5");
  refused({"--no-replay"}, {"--replay-forces"}, "5");
  refused({"--packing-only"}, {"--area-correction", "--vtk-spheres"}, "true");
  refused({"--packing-only"}, {"--replay"}, "false");  // in a file, its default is no request
  refused({"--packing-only"}, {"--stable-share", "--strike-off"}, "0.5");
  refused({"--time-step=1e-6"}, {"--stable-share"}, "0.5");
  refused({}, {"--allow-unstable-time-step"}, "true");
  refused({"--scale-contacts=false"}, {"--constants-for"}, "0.001");
  refused({"--no-vtk"}, {"--vtk-spheres"}, "true");
  refused({"--no-vtk"}, {"--vtk-interval"}, "0.001");
  refused({"--shape=polyhedron"}, {"--vtk-spheres"}, "true");
  // What is given on the command line is meant, also if it is the default.
  CHECK_THROWS_WITH(read({"--packing=poured", "--seed=1"}), ContainsSubstring("--packing random"));
  CHECK_THROWS_WITH(read({"--packing-file=p.txt", "--relative-density=0.17"}), ContainsSubstring("--packing-file"));
}

TEST_CASE("options that work together are accepted together") {
  for (const char* option : {"--relative-density=0.5", "--densify-time=1", "--seed=2", "--shake-amplitude=1e-4"}) {
    CHECK_NOTHROW(read({option}));
  }
  for (const char* option : {"--tilt=5", "--shake-time=1", "--shake-frequency=30", "--shake-amplitude=1e-4"}) {
    CHECK_NOTHROW(read({"--packing=poured", option}));
  }
  CHECK_NOTHROW(read({"--packing-file=p.txt", "--loads=6.2", "--packing-only=false", "--vtk-spheres"}));
  CHECK_NOTHROW(read({"--packing-file=p.txt", "--packing-only", "--no-vtk"}));
  CHECK(read({"--time-step=1", "--allow-unstable-time-step"}).settings.allow_unstable_time_step);
}

TEST_CASE("defaults that a settings.toml lists are nobody's wish") {
  const ConfigFile file(read({"--size", "smoke"}).config);
  const auto with = [&](const char* option) { return read({"--config", file.path.string(), option}); };
  CHECK(with("--packing-file=p.txt").settings.packing_file == "p.txt");
  CHECK(with("--packing=poured").settings.packing == "poured");
  CHECK(with("--packing-only").settings.loads.empty());
  CHECK(with("--time-step=1e-6").settings.time_step == 1e-6);
  CHECK_FALSE(with("--no-vtk").settings.vtk);
}

TEST_CASE("the report lists a seed only of a packing that has one") {
  const auto packing = [](std::vector<std::string> arguments) {
    const Settings s = read(std::move(arguments)).settings;
    for (const auto& [name, value] : direct_shear::list_settings(s)) {
      CHECK(name != "seed");
      if (name == "packing") return value;
    }
    return std::string();
  };
  CHECK(packing({"--seed=7"}) == "random, seed 7, relative density 0.18 asked for");
  CHECK_THAT(packing({"--packing=poured"}), !ContainsSubstring("seed"));
  CHECK(packing({"--packing-file=a/p.txt"}) == "from p.txt");
}

TEST_CASE("what the library complains of is called by its option") {
  const auto in_options = [](const char* text) { return dem::rig::in_own_words(text, direct_shear::own_words); };
  CHECK(in_options("more than overlap_limit 1; raise the normal stiffness, lower time_step (now 1e-5 s)") ==
        "more than --overlap-limit 1; raise --stiffness, lower --time-step (now 1e-5 s)");
  CHECK(in_options("lower time_step or set allow_unstable_time_step, or time_step_safety") ==
        "lower --time-step or set --allow-unstable-time-step, or --stable-share");
  CHECK(in_options("make one with save_packing") == "make one with --save-packing");
  CHECK(in_options("close the walls, lower time_step, or enlarge domain") == "lower --time-step");
  CHECK(in_options("no option in here") == "no option in here");
  CHECK(in_options("cannot open 'time_step/save_packing.txt' (lower time_step)") ==
        "cannot open 'time_step/save_packing.txt' (lower --time-step)");
  CHECK(in_options("my_time_step, /tmp/time_step.txt and a-time_step") ==
        "my_time_step, /tmp/time_step.txt and a-time_step");
  CHECK(in_options("raise time_step.") == "raise --time-step.");
  CHECK(in_options("the grain's time_step, 'unfinished time_step") ==
        "the grain's --time-step, 'unfinished --time-step");
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
  CHECK(s.stable_share == 0.8);
  CHECK(read({"--size", "full", "--stable-share", "0.5"}).settings.stable_share == 0.5);
  CHECK_THROWS_WITH(read({"--stable-share", "1.5"}), ContainsSubstring("--stable-share"));
  CHECK(s.wall_thickness == 0.015);
  CHECK(s.wall_friction == s.friction);
  CHECK(s.loads == std::vector<double>{6.2, 16.2, 26.2});
  CHECK(direct_shear::contact_scale(s) == 1.0);
}

TEST_CASE("shapes whose faces touch once get the constants of the four spheres that touch on a face of cube8") {
  const Settings cube8 = read({}).settings, sharp = read({"--shape=polyhedron"}).settings,
                 given =
                     read({"--shape=superquadric", "--stiffness=3", "--damping=0", "--velocity-stiffness=5"}).settings;
  CHECK(cube8.stiffness == 20000.0);
  CHECK(cube8.damping == 0.015);
  CHECK(cube8.velocity_stiffness == 0.015);
  CHECK(sharp.stiffness == 4.0 * cube8.stiffness);
  CHECK(sharp.friction_stiffness == sharp.stiffness);
  CHECK(sharp.damping == Approx(4.0 * cube8.damping));
  CHECK(sharp.velocity_stiffness == Approx(4.0 * cube8.velocity_stiffness));
  CHECK(given.stiffness == 3.0);
  CHECK(given.damping == 0.0);
  CHECK(given.velocity_stiffness == 5.0);
  CHECK(read({"--shape=polyhedron", "--damping=0.2"}).settings.velocity_stiffness == 0.2);
}

TEST_CASE("a packing is as dense as its shape needs, unless it is told") {
  CHECK(read({}).settings.relative_density == 0.18);
  CHECK(read({"--shape=polyhedron"}).settings.relative_density == 0.5);
  CHECK(read({"--shape=superquadric"}).settings.relative_density == 0.5);
  CHECK(read({"--shape=polyhedron", "--relative-density=0"}).settings.relative_density == 0.0);
  CHECK_THROWS_WITH(read({"--relative-density=1.01"}), ContainsSubstring("--relative-density"));
  CHECK(read({}).settings.strike_off == 0.0);
  CHECK(read({"--shape=polyhedron"}).settings.strike_off == 0.18);
  CHECK(read({"--shape=superquadric"}).settings.strike_off == 0.0);
  CHECK_THROWS_WITH(read({"--strike-off=0.91"}), ContainsSubstring("--strike-off"));
}

TEST_CASE("every option is checked by its own name") {
  const auto refused = [](const std::string& option, const std::string& value) {
    INFO(option << " " << value);
    const bool of_block = option == "--tilt" || option == "--shake-time";
    CHECK_THROWS_WITH(read({of_block ? "--packing=poured" : "--packing=random", option + "=" + value}),
                      ContainsSubstring(option) && !ContainsSubstring("counts only"));
  };
  for (const char* positive :
       {"--half-edge", "--box-length", "--box-width", "--box-height", "--densify-time", "--settle-limit", "--stiffness",
        "--density", "--constants-for", "--lid-speed", "--rest-speed", "--consolidation-limit", "--shear-speed",
        "--overlap-limit", "--vtk-interval", "--wall-thickness", "--travel", "--shake-frequency", "--loads"}) {
    for (const char* value : {"-1", "nan", "inf"}) refused(positive, value);
  }
  for (const char* zero_is_no_default :
       {"--box-length", "--box-width", "--box-height", "--densify-time", "--settle-limit", "--density",
        "--constants-for", "--lid-speed", "--rest-speed", "--consolidation-limit", "--overlap-limit",
        "--shake-frequency", "--loads"}) {
    refused(zero_is_no_default, "0");
  }
  for (const char* not_negative :
       {"--seam-height", "--lid-clearance", "--tilt", "--shake-amplitude", "--shake-time", "--separation-factor",
        "--friction", "--breaking-factor", "--ramp-time", "--smoothing", "--residual-share", "--time-step"}) {
    for (const char* value : {"-1", "nan", "inf"}) refused(not_negative, value);
  }
  for (const char* automatic_if_negative : {"--wall-friction", "--friction-stiffness", "--damping",
                                            "--velocity-stiffness", "--relative-density", "--strike-off"}) {
    CHECK_NOTHROW(read({std::string(automatic_if_negative) + "=-1"}));
    for (const char* value : {"nan", "inf"}) refused(automatic_if_negative, value);
  }
  refused("--threads", "-1");
  for (const char* whole : {"--grains", "--seed"}) {
    for (const char* value : {"-1", "1.5", "1e300", "184467440737095516160", "five"}) refused(whole, value);
  }
  CHECK_THROWS_WITH(read({"--seed=-1"}), ContainsSubstring("--seed is -1, but must be a whole number from 0"));
  CHECK(read({"--seed=18446744073709551615"}).settings.seed == 18446744073709551615ULL);
  CHECK(read({"--grains=1e3"}).settings.grains == 1000);
}

TEST_CASE("options are checked against each other") {
  // The travel of --size quick is 4 mm, its box 50 mm high.
  CHECK_THROWS_WITH(read({"--smoothing=0.0021"}), ContainsSubstring("at most half the travel"));
  CHECK_THROWS_WITH(read({"--wall-thickness=0.0039"}), ContainsSubstring("from the travel up"));
  CHECK_THROWS_WITH(read({"--seam-height=0.05"}), ContainsSubstring("box height, 0.05 m"));
  CHECK_THROWS_WITH(read({"--ramp-time=0.21"}), ContainsSubstring("at most what the travel takes"));
  CHECK_THROWS_WITH(read({"--shape=superquadric", "--integrator=euler"}), ContainsSubstring("verlet only"));
}

TEST_CASE("grains that nothing could hold are refused, however they are asked for") {
  CHECK_THROWS_WITH(read({"--half-edge=1e-15"}), ContainsSubstring("change --half-edge, or give --grains"));
  CHECK_THROWS_WITH(read({"--half-edge=1e-5"}), ContainsSubstring("change --half-edge, or give --grains"));
  CHECK_THROWS_WITH(read({"--grains=100000001"}), ContainsSubstring("--grains"));
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

}  // namespace direct_shear_settings_test

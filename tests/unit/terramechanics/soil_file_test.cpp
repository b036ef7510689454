#include <dem/terramechanics/chrono_scm.hpp>
#include <dem/terramechanics/soil_reader.hpp>

#include <clocale>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "catch.hpp"

using namespace dem::terramechanics;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

const Soil clay = {.pressure = Reece{.k_c = 30.1, .k_phi = 60.2, .n = 0.813, .cohesion = 2000.0, .unit_weight = 16e3},
                   .shear = {.cohesion = 2000.0, .friction_angle = radians(21.3), .displacement = 1.7e-3},
                   .a0 = 0.18,
                   .a1 = 0.3,
                   .exit_angle = radians(-4.1),
                   .exit_share = 0.0,
                   .unloading_stiffness = 3e7,
                   .unloading_growth = 1e9};

void check_same(const Soil& a, const Soil& b) {
  CHECK(a.pressure.index() == b.pressure.index());
  for (const double width : {0.03, 0.16}) {
    CHECK(under(a.pressure, width).modulus == under(b.pressure, width).modulus);
    CHECK(under(a.pressure, width).exponent == under(b.pressure, width).exponent);
  }
  CHECK(a.shear.cohesion == b.shear.cohesion);
  CHECK(a.shear.displacement == b.shear.displacement);
  CHECK(a.shear.friction_angle == Approx(b.shear.friction_angle).epsilon(1e-15));  // through degrees
  CHECK(a.a0 == b.a0);
  CHECK(a.a1 == b.a1);
  CHECK(a.exit_angle == Approx(b.exit_angle).epsilon(1e-15));
  CHECK(a.exit_share == b.exit_share);
  CHECK(a.unloading_stiffness == b.unloading_stiffness);
  CHECK(a.unloading_growth == b.unloading_growth);
}

std::string text_with(const std::string& line) {
  return "pressure = \"bekker\"\nn = 1\nk_c = 0\nk_phi = 1e6\ncohesion = 0\nfriction_angle = 30\n" + line;
}

}  // namespace

TEST_CASE("a soil is read back as it was written") {
  for (const Soil& soil : {melanz_sand, mojave_martian_simulant, clay}) {
    const NamedSoil named = {"a \"fine\" soil", "table 1, p. 3\\4", soil};
    const NamedSoil back = read_soil(to_text(named));
    check_same(soil, back.soil);
    CHECK(back.name == named.name);
    CHECK(back.source == named.source);
  }
}

TEST_CASE("soil files mean the same in a country of decimal commas") {
  // Where the machine knows no such locale this shows nothing more than the test above.
  const std::string before = to_text({"sand", "", melanz_sand});
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE"}) std::setlocale(LC_ALL, locale);
  CHECK(to_text({"sand", "", melanz_sand}) == before);
  CHECK(read_soil(before).soil.shear.displacement == 0.515e-3);
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("soil files may be kept on disk") {
  const std::string path = "soil_file_test.toml";
  save_soil(path, {"sand", "D. Melanz", melanz_sand});
  check_same(load_soil(path).soil, melanz_sand);
  std::remove(path.c_str());
  CHECK_THROWS_WITH(load_soil(path), ContainsSubstring("cannot read the file 'soil_file_test.toml'"));
  // The folder is made, and a file that another writer has begun is none of ours.
  const std::filesystem::path folder = "soil_file_test", file = folder / "new" / "soil.toml";
  save_soil(file.string(), {"sand", "", melanz_sand});
  const std::filesystem::path other = file.string() + ".part";
  dem::io::write_file(other, "half a soi");
  save_soil(file.string(), {"clay", "", clay});
  check_same(load_soil(file.string()).soil, clay);
  check_same(find_soil(file.string()).soil, clay);
  check_same(find_soil("p1").soil, melanz_sand);  // by its name
  CHECK_THROWS_WITH(find_soil("dry-snad"), ContainsSubstring("'dry-snad' is neither a soil that is known by name nor a "
                                                             "file; known are dry-sand, sandy-loam"));
  CHECK(dem::io::read_file(other) == "half a soi");
  CHECK_THROWS_WITH(save_soil((file / "soil.toml").string(), {"", "", melanz_sand}),
                    ContainsSubstring("cannot make the folder"));
  std::filesystem::remove_all(folder);
}

TEST_CASE("comments, blank lines, other ends of lines and what has a default are no matter") {
  const NamedSoil named = read_soil(
      "\r\n# a comment\r\n  n=1 # one\n\tpressure = \"bekker\"  # form\r\nk_c = 0\nk_phi = 2e6\r\n"
      "cohesion = 0\nfriction_angle = 30\nshear_displacement = 1e-3");
  CHECK(std::get<Bekker>(named.soil.pressure).k_phi == 2e6);
  CHECK(named.soil.shear.friction_angle == Approx(radians(30.0)));
  CHECK(named.soil.a0 == Soil{}.a0);
  CHECK(named.name.empty());
}

TEST_CASE("numbers and texts may be written as TOML has them") {
  const NamedSoil named =
      read_soil(text_with("name = 'C:\\sand \"fine\"'\nshear_displacement = +1e-3\na0 = 0.4\nsource = \"a \\\\ b\""));
  CHECK(named.name == "C:\\sand \"fine\"");
  CHECK(named.source == "a \\ b");
  CHECK(named.soil.shear.displacement == 1e-3);
  CHECK(std::get<Bekker>(read_soil("pressure = 'bekker'\nn = 1\nk_c = 0\nk_phi = 1_528_430\ncohesion = 0\n"
                                   "friction_angle = 30\nshear_displacement = 1e-3")
                             .soil.pressure)
            .k_phi == 1528430.0);
}

TEST_CASE("soil files with mistakes are refused with the line") {
  const auto refused = [](const std::string& line) { return [=] { return read_soil(text_with(line), "s.toml"); }; };
  CHECK_NOTHROW(refused("shear_displacement = 1e-3")());
  CHECK_THROWS_WITH(refused("")(), ContainsSubstring("'s.toml': shear_displacement is missing"));
  CHECK_THROWS_WITH(refused("shear_displacement = 1,5")(), ContainsSubstring("line 7: shear_displacement is '1,5'"));
  for (const char* wrong : {"+-1e-3", "_1e-3", "1__0", "1_", "++1"}) {
    CHECK_THROWS_WITH(refused("shear_displacement = " + std::string(wrong))(),
                      ContainsSubstring("'" + std::string(wrong) + "'"));
  }
  CHECK_THROWS_WITH(refused("shear_displacement = nan")(), ContainsSubstring("finite number"));
  CHECK_THROWS_WITH(refused("shear_displacement")(), ContainsSubstring("line 7: no '='"));
  CHECK_THROWS_WITH(refused("k = 3")(), ContainsSubstring("has no k; it has n, k_c, k_phi, cohesion"));
  CHECK_THROWS_WITH(refused("n = 3")(), ContainsSubstring("line 7: n was already given in line 2"));
  CHECK_THROWS_WITH(refused("name = 3")(), ContainsSubstring("name takes a text in quotes"));
  CHECK_THROWS_WITH(refused("a0 = \"3\"")(), ContainsSubstring("a0 takes a number"));
  CHECK_THROWS_WITH(refused("name = \"sand")(), ContainsSubstring("does not end in a quote"));
  CHECK_THROWS_WITH(refused("name = 'sand\"")(), ContainsSubstring("does not end in a quote"));
  CHECK_THROWS_WITH(refused("name = \"a\\tb\"")(), ContainsSubstring("line 7: name has \\t, but only"));
  CHECK_THROWS_WITH(refused("exit_angle = 5")(), ContainsSubstring("line 7: exit_angle is 5 degrees"));
  CHECK_THROWS_WITH(refused("shear_displacement = -1")(), ContainsSubstring("K of the soil is -1 m"));
  CHECK_THROWS_WITH(read_soil("pressure = \"sand\""), ContainsSubstring("\"bekker\", \"reece\" or \"wong-reece\""));
  CHECK_THROWS_WITH(read_soil(""), ContainsSubstring("pressure is \"\""));
}

TEST_CASE("the soil for Chrono's SCM terrain is in its order and units") {
  Soil soil = mojave_martian_simulant;
  soil.unloading_stiffness = 2e8;
  CHECK(to_text(to_chrono(soil, 0.0, 3e4)) ==
        "terrain.SetSoilParameters(\n"
        "    6708000,  // Bekker_Kphi, Pa/m^n\n"
        "    846000,  // Bekker_Kc, Pa/m^(n-1)\n"
        "    1.4,  // Bekker_n\n"
        "    600,  // Mohr_cohesion, Pa\n"
        "    35,  // Mohr_friction, degrees\n"
        "    6e-04,  // Janosi_shear, m\n"
        "    2e+08,  // elastic_K, Pa/m\n"
        "    30000);  // damping_R, Pa s/m\n");
  CHECK_THROWS_WITH(to_chrono(mojave_martian_simulant), ContainsSubstring("give the soil an unloading_stiffness"));
}

TEST_CASE("other pressure laws become Bekker's where SCM takes no other") {
  for (const double width : {0.05, 0.2}) {
    const ChronoScm scm = to_chrono(clay, width);
    const Bekker bekker = {scm.bekker_k_c, scm.bekker_k_phi, scm.bekker_n};
    CHECK(bekker.under(width).pressure(0.01) == Approx(under(clay.pressure, width).pressure(0.01)).epsilon(1e-13));
  }
  CHECK_THROWS_WITH(to_chrono(clay), ContainsSubstring("width that Reece's pressure is taken for"));
  Soil sand = melanz_sand;
  sand.unloading_stiffness = 1e8;
  CHECK(to_chrono(sand).bekker_k_phi == Approx(2.54e5 / std::pow(0.03, 1.387)));
}

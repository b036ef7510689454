#include "catch.hpp"

#include <dem/io/file.hpp>
#include <dem/rig/direct_shear/result_names.hpp>
#include <dem/rig/old_results.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

namespace old_results_test {

using namespace dem::rig;

TEST_CASE("a file that a run starts from is none that it removes") {
  const dem::rig::ResultNames names{.files = {"telemetry.csv"}, .plots = {}, .frames = {}};
  CHECK_NOTHROW(dem::rig::require_not_own("", "--inputs", "out", names));
  CHECK_NOTHROW(dem::rig::require_not_own("other/telemetry.csv", "--inputs", "out", names));
  CHECK_NOTHROW(dem::rig::require_not_own("out/inputs.csv", "--inputs", "out", names));
  CHECK_THROWS_WITH(dem::rig::require_not_own("./out/telemetry.csv", "--inputs", "out", names),
                    Catch::Matchers::ContainsSubstring("--inputs is './out/telemetry.csv', which the run replaces"));
}

TEST_CASE("patterns of names") {
  CHECK(matches("report.html", "report.html"));
  CHECK_FALSE(matches("report.html.bak", "report.html"));
  CHECK_FALSE(matches("my_report.html", "report.html"));
  CHECK(matches("load_16.9kPa.csv", "load_#+.#kPa.csv"));
  CHECK(matches("load_1234.0kPa.csv", "load_#+.#kPa.csv"));
  CHECK_FALSE(matches("load_16.90kPa.csv", "load_#+.#kPa.csv"));
  CHECK_FALSE(matches("load_.9kPa.csv", "load_#+.#kPa.csv"));
  CHECK_FALSE(matches("load_16.9kPa.cs", "load_#+.#kPa.csv"));
  CHECK_FALSE(matches("", "#"));
  CHECK(matches("", ""));
}

TEST_CASE("what an earlier run left is removed, and nothing else") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("dem_old_results_test_" + std::to_string(::getpid()));
  const ResultNames names = dem::rig::direct_shear::result_names();
  fs::remove_all(folder);
  CHECK_NOTHROW(remove_old_results(folder, names));  // there is none yet
  CHECK(find_old_results(folder, names).empty());
  const std::vector<std::string> old = {"results.csv",
                                        "report.html",
                                        "report.html.tmp",
                                        "load_16.9kPa/boxes_000003.vtp.tmp",
                                        "shear_stress.gp",
                                        "dilation.svg",
                                        "mohr_coulomb.png",
                                        "load_16.9kPa.csv",
                                        "load_16.9kPa.pvd",
                                        "load_16.9kPa/grains_000000.vtp",
                                        "load_16.9kPa/polyhedra_1000000.vtp",
                                        "load_44.1kPa/boxes_000001.vtp"};
  const std::vector<std::string> others = {"settings.toml",
                                           "packing.txt",
                                           "load_16.9kPa.csv.bak",
                                           "load_44.1kPa/grains_1.vtp",
                                           "load_44.1kPa/other_000001.vtp",
                                           "load_cell.csv",
                                           "my_results.csv",
                                           "load_44.1kPa/notes.txt",
                                           "load_a/grains.txt",
                                           "sub/load_1.0kPa.csv",
                                           "shear_stress.txt"};
  for (const auto& name : old) dem::io::write_file(folder / name, "old");
  for (const auto& name : others) dem::io::write_file(folder / name, "mine");
  std::vector<std::string> found;
  for (const auto& path : find_old_results(folder, names)) found.push_back(path.filename().string());
  CHECK(found == std::vector<std::string>{"dilation.svg", "load_16.9kPa.csv", "load_16.9kPa.pvd", "mohr_coulomb.png",
                                          "report.html", "report.html.tmp", "results.csv", "shear_stress.gp"});
  remove_old_results(folder, names);
  CHECK(find_old_results(folder, names).empty());
  for (const auto& name : old) {
    INFO(name);
    CHECK_FALSE(fs::exists(folder / name));
  }
  CHECK_FALSE(fs::exists(folder / "load_16.9kPa"));
  for (const auto& name : others) {
    INFO(name);
    CHECK(fs::exists(folder / name));
  }
  fs::remove_all(folder);
}

TEST_CASE("a file of the run's own is known, however its path is written") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("dem_own_file_test_" + std::to_string(::getpid()));
  fs::create_directories(folder / "sub");
  const ResultNames names = dem::rig::direct_shear::result_names();
  const auto is_own = [&](const fs::path& path) { return is_own_file(path, folder, names); };
  for (const char* own :
       {"results.csv", "report.html", "settings.toml", "load_44.1kPa.csv", "shear_stress.png", "run.lock",
        "sub/../results.csv", "./results.csv", "results.csv.tmp", "load_44.1kPa/grains_000000.vtp"}) {
    INFO(own);
    CHECK(is_own(folder / own));
  }
  for (const char* other : {"packing.txt", "sub/results.csv", "../results.csv", "load_44.1kPa/packing.txt"}) {
    INFO(other);
    CHECK_FALSE(is_own(folder / other));
  }
  fs::create_directory_symlink(folder, folder / "sub" / "link");
  CHECK(is_own(folder / "sub" / "link" / "results.csv"));
  CHECK_FALSE(is_own_file("results.csv", folder, names));
  CHECK(is_own_file("results.csv", "", names));
  CHECK(is_own_file("./results.csv", ".", names));
  fs::remove_all(folder);
}

}  // namespace old_results_test

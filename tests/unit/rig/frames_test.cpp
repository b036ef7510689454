#include "catch.hpp"
#include "io/files.hpp"
#include "io/sleeping_bed.hpp"
#include "io/vtk_reader.hpp"

#include <dem/rig/frames.hpp>

#include <cstdint>

namespace frames_test {

TEST_CASE("the points of a frame say which grains sleep") {
  const TempFolder folder;
  const SleepingBed bed;
  dem::rig::write_grain_points(folder / "grains.vtp", bed.world, {.single_precision = true});
  const auto asleep = read_vtk(folder / "grains.vtp").values<std::uint8_t>("asleep");
  const auto grains = bed.world.grains();
  REQUIRE(asleep.size() == grains.size());
  for (std::size_t k = 0; k < grains.size(); ++k) CHECK(asleep[k] == (grains[k] == bed.flier ? 0 : 1));
  const SleepingBed awake(false);
  dem::rig::write_grain_points(folder / "awake.vtp", awake.world, {.single_precision = true});
  CHECK(read_vtk(folder / "awake.vtp").bytes.count("asleep") == 0);
}

TEST_CASE("the points of a frame say how many others they touch") {
  const TempFolder folder;
  const SleepingBed bed;
  dem::rig::write_grain_points(folder / "grains.vtp", bed.world, {});
  const VtkContent file = read_vtk(folder / "grains.vtp");
  const auto grain = file.values<std::uint32_t>("grain");
  const auto neighbours = file.values<std::int32_t>("coordination");
  const auto contacts = file.values<std::int32_t>("contact_points");
  REQUIRE(grain.size() == bed.world.grain_count());
  for (std::size_t k = 0; k < grain.size(); ++k) {
    CHECK(neighbours[k] == (grain[k] == bed.flier.value ? 0 : 1));  // towers of two
    CHECK((contacts[k] > 0) == (neighbours[k] > 0));
  }
}

}  // namespace frames_test
